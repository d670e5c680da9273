#!/usr/bin/env python3
"""Cost and quality of the images of `fenestra serve --mapped-image` after moves of the camera.

usage: preview.py FENESTRA INPUT [--focus NAME] [OPTIONS...]
       (an 800x600 preview of 20 views; OPTIONS: further ones of `fenestra serve`)

Prints CSV. For each resolution: median CPU seconds of the server from the move to the image, and
the error of the image, enlarged to full resolution, against an image of 64 samples per pixel:
relMSE as in `fenestra compare`, and the outline of the focus, as the 95th percentile of its
distance in pixels. Then the delay from a change to the end of the work before.
Requires numpy and scipy.
"""

import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
import time

import numpy
from scipy import ndimage

SIZE = (800, 600)
MOVES = 20


class Server:
    def __init__(self, program, arguments, folder):
        self.frame = os.path.join(folder, "view.frame")
        self.process = subprocess.Popen(
            [program, "serve", "--mapped-image", self.frame, "--size", "%dx%d" % SIZE] + arguments,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.next_id = 0

    def cpu_seconds(self):
        with open("/proc/%d/stat" % self.process.pid) as file:
            fields = file.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def send(self, **change):
        self.next_id += 1
        self.process.stdin.write(json.dumps(dict(change, id=self.next_id)) + "\n")
        self.process.stdin.flush()

    def events(self):
        """Events of the last change, up to its last image."""
        for line in self.process.stdout:
            event = json.loads(line)
            if event["event"] == "error":
                raise RuntimeError(event["message"])
            if event["id"] == (self.next_id or None):
                yield event
                if event["done"]:
                    return

    def image(self):
        """R, G, B, A of the latest image, float, rows from the top."""
        data = numpy.fromfile(self.frame, dtype=numpy.uint8)
        words = data[:512].view(numpy.uint64)
        width, height = int(words[5]), int(words[6])
        for entry in range(14, 14 + 4 * int(words[13]), 4):
            if bytes(data[8 * entry:8 * entry + 8]).rstrip(b"\0") == b"color":
                start = int(words[entry + 1])
                values = data[start:start + 16 * width * height].view(numpy.float32)
                return values.reshape(height, width, 4).astype(float)
        raise RuntimeError("the frame has no color")

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def camera(number):
    angle = 0.2 + 0.07 * number
    return {"position": [400 * math.sin(angle), 400 * math.cos(angle), 60], "target": [0, 0, 0],
            "up": [0, 0, 1]}


def enlarge(image):
    """To full resolution, as the 3D view does: linear interpolation between pixel centers."""
    columns = (numpy.arange(SIZE[0]) + 0.5) * image.shape[1] / SIZE[0] - 0.5
    rows = (numpy.arange(SIZE[1]) + 0.5) * image.shape[0] / SIZE[1] - 0.5
    at = numpy.meshgrid(rows, columns, indexing="ij")
    return numpy.stack([ndimage.map_coordinates(image[..., c], at, order=1, mode="nearest")
                        for c in range(4)], axis=-1)


def relative_error(image, reference):
    difference = (image - reference)[..., :3]
    return float(numpy.mean(difference ** 2 / (reference[..., :3] ** 2 + 0.01)))


def outline_distance(image, reference):
    """95th percentile of the distances of the outlines of alpha 1/2, in both directions."""
    masks = [enlarged[..., 3] > 0.5 for enlarged in (image, reference)]
    outlines = [mask & ~ndimage.binary_erosion(mask, border_value=1) for mask in masks]
    distances = [ndimage.distance_transform_edt(~outline) for outline in outlines]
    return float(numpy.percentile(
        numpy.concatenate([distances[1][outlines[0]], distances[0][outlines[1]]]), 95))


def measure_moves(server):
    """CPU seconds from each move to the first image of each scale."""
    for _ in server.events():
        pass
    seconds = {}
    for move in range(MOVES):
        start = server.cpu_seconds()
        first = {}
        server.send(**camera(move))
        for event in server.events():
            first.setdefault(event["scale"], server.cpu_seconds() - start)
        for scale, used in first.items():
            seconds.setdefault(scale, []).append(used)
    return seconds


def collect_images(server, view, samples):
    """The images of one view at each resolution."""
    images = {}
    server.send(samples=samples, **view)
    for event in server.events():
        images[event["scale"]] = enlarge(server.image())
    return images


def measure_quality(program, arguments, folder, reference_samples, measure):
    """Results of measure(image, reference) for two views, by scale."""
    results = {}
    server = Server(program, arguments, folder)
    for _ in server.events():
        pass
    for move in (3, 10):
        rungs = collect_images(server, camera(move), 1)
        reference = collect_images(server, camera(move), reference_samples)[1]
        for scale, image in rungs.items():
            results.setdefault(scale, []).append(measure(image, reference))
    server.close()
    return results


def measure_delays(server, count=100):
    """Seconds from a change to the end of the work on the one before."""
    delays = []
    for move in range(count):
        server.send(samples=64, **camera(move % MOVES))
        time.sleep(0.02 + 0.017 * (move * 7 % 40))
        server.send(samples=1, **camera((move + 1) % MOVES))
        for event in server.events():
            delays.append(event["startSeconds"])
            break
    return sorted(delays)


def main():
    program, arguments = sys.argv[1], sys.argv[2:]
    focus = "--focus" in arguments
    with tempfile.TemporaryDirectory() as folder:
        server = Server(program, arguments + ["--samples", "1"], folder)
        seconds = measure_moves(server)
        delays = measure_delays(server)
        server.close()
        sparse = arguments + ["--samples", "1"]
        errors = measure_quality(program, sparse, folder, 64, relative_error)
        alone = sparse + ["--context-density", "0", "--background", "transparent"]
        distances = measure_quality(program, alone, folder, 4, outline_distance) if focus else {}
    print("scale,cpu_seconds,relmse,outline_pixels")
    for scale in sorted(seconds, reverse=True):
        print("%d,%.3f,%.4f,%s" % (scale, statistics.median(seconds[scale]),
                                   max(errors[scale]),
                                   "%.2f" % max(distances[scale]) if focus else ""))
    print("delay of a change: median %.1f ms, 99 of 100 at most %.1f ms"
          % (1e3 * statistics.median(delays), 1e3 * delays[-2]))


if __name__ == "__main__":
    main()
