"""Draws a transfer function as a PPM image: intensities from left to right; the height of a column is the opacity
of a layer of half a millimeter. usage: python3 transfer_icon.py FILE.json SIZE >FILE.ppm"""

import json
import math
import sys

BACKGROUND = (24, 24, 26)
LAYER = 0.5  # mm
MARGIN = 0.04  # of the edge of the image, on all sides
SAMPLES = 4  # per pixel and axis


def interpolate(points, x):
    """Value of a piecewise linear function, constant beyond its ends; its values are tuples."""
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        if x < x1:
            t = max(0.0, (x - x0) / (x1 - x0))
            return tuple(a + t * (b - a) for a, b in zip(y0, y1))
    return points[-1][1]


def parse_color(text):
    return tuple(int(text[i : i + 2], 16) for i in (1, 3, 5))


def main(path, size):
    with open(path, encoding="utf-8") as file:
        function = json.load(file)
    extinction = [(x, (y,)) for x, y in function["extinction"]]
    colors = [(x, parse_color(text)) for x, text in function["color"]]
    first, last = extinction[0][0], extinction[-1][0]

    def find_color(u, v):
        """Color at a point of the image; u and v are 0 to 1, v upward."""
        u, v = ((w - MARGIN) / (1 - 2 * MARGIN) for w in (u, v))
        if not (0 <= u <= 1 and v >= 0):
            return BACKGROUND
        x = first + u * (last - first)
        opacity = 1 - math.exp(-LAYER * interpolate(extinction, x)[0])
        return interpolate(colors, x) if v < opacity else BACKGROUND

    print(f"P3 {size} {size} 255")
    n = size * SAMPLES
    for row in range(size):
        for column in range(size):
            samples = [
                find_color((column * SAMPLES + i + 0.5) / n, 1 - (row * SAMPLES + j + 0.5) / n)
                for j in range(SAMPLES)
                for i in range(SAMPLES)
            ]
            print(*(round(sum(channel) / len(samples)) for channel in zip(*samples)))


main(sys.argv[1], int(sys.argv[2]))
