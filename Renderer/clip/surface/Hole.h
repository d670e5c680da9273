#pragma once
// Virtual holes: channels of simple shape from the eye to the focus, as the paper's reference [6]
// (Wimmer et al.) cuts by boxes and balls.

#include "clip/focus/FocusDepth.h"

namespace fenestra {

enum class HoleShape {
  box,      ///< upright, flat at the depth of the focus's farthest visible point
  cylinder, ///< round, else like a box
  sphere,   ///< far side of a ball around the visible focus
};

struct HoleOptions {
  HoleShape shape = HoleShape::cylinder;
  double margin = 5.0; ///< mm on the plane through the target, beyond the focus's extent

  bool operator==(const HoleOptions&) const = default;
};

/// Fills the samples of `buffer` that are not focus: depth of the hole's bottom, mm; -infinity:
/// beside the hole. At least one sample has to be focus.
void fillHole(DepthBuffer& buffer, const FocusDepth& focus, const Camera& camera,
              const HoleOptions& options);

} // namespace fenestra
