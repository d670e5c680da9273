#pragma once
// Virtual holes: channels of simple shape from the camera to the focus, like the boxes and spheres
// of Wimmer et al. (reference [6] of the paper in CITATION.cff).

#include "clip/focus/FocusDepth.h"

namespace fenestra::core {

enum class HoleShape {
  box,      ///< axis-aligned in the image; flat bottom at the farthest visible focus point
  cylinder, ///< circular, otherwise like the box
  sphere,   ///< far side of a sphere around the visible focus
};

struct HoleOptions {
  HoleShape shape = HoleShape::cylinder;
  double margin = 5.0; ///< mm on the plane through the target, beyond the focus's extent

  bool operator==(const HoleOptions&) const = default;
};

/// Fills the samples of `buffer` outside the focus with the depth of the hole's bottom, mm, or with
/// -infinity beside the hole. At least one sample must be focus.
void fillHole(DepthBuffer& buffer, const FocusDepth& focus, const Camera& camera,
              const HoleOptions& options);

} // namespace fenestra::core
