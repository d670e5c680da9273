#pragma once
// Marks on display images: a scale bar, and where the patient's right, front and head are.

#include "image/Image.h"

#include <string>
#include <vector>

namespace fenestra::core {

/// Marks to draw.
struct Annotations {
  bool scale = false;       ///< scale bar; only for an orthographic projection
  bool orientation = false; ///< letters at the middle of each edge
};

/// Letters for a direction in RAS, the largest component first: R or L, A or P, S or I; "RA"
/// halfway between right and anterior. They name the nearest of the 26 directions to the faces,
/// edges and corners of a cube.
std::string toPatientLetters(const Vec3& direction);

/// Length of the scale bar, mm: 1, 2 or 5 times a power of ten, and nearest to a fifth of the
/// image's width.
double chooseScaleLength(double imageWidth);

/// Draws the marks over an image of interleaved RGBA, encoded for display, with straight alpha.
/// They are opaque, white with a black outline. One em of their text is 0.036 of the image's
/// shorter side, but at least 10 pixels.
void drawAnnotations(const Annotations& annotations, const ImagePlane& plane, int width, int height,
                     std::vector<float>& rgba);

} // namespace fenestra::core
