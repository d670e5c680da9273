#pragma once
// Images of a running server: their sizes, and their way to a frame file.

#include "files/images/DisplayTransform.h"
#include "files/images/FrameFile.h"
#include "scene/FinishedImage.h"

#include <optional>
#include <vector>

namespace fenestra::core {

/// One size at which the server renders. Coarse sizes get one sample per pixel, so that the first
/// image appears early.
struct Rung {
  int scale; ///< pixels at full resolution per pixel, in both directions

  bool isFull() const { return scale == 1; }
  int reduce(int pixels) const { return (pixels + scale - 1) / scale; }
};

/// Sizes in the order of rendering; the last one is full. Coarse ones have at least 100 pixels in
/// both directions.
std::vector<Rung> chooseRungs(int width, int height);

/// Writes an image to the file, with the layers "color" (R, G, B and A as in an .exr, denoised
/// unless denoising is off), "display" (as in a .png), "depth" (view space, mm; the mean of the
/// first collisions; infinity: none) and, if denoised, "depth50" (where half of the light is
/// stopped; infinity: nowhere).
void publishFrame(FrameFile& file, FrameInfo info, const PreparedScene& scene,
                  const RenderResult& result, const std::optional<FilteredImage>& filtered,
                  const Display& display);

} // namespace fenestra::core
