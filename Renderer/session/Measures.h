#pragma once
// What a picture's clip is worth, as the stats report it.

#include "session/Scene.h"

namespace fenestra {

struct FocusReport {
  double kept = 0.0;        ///< share of the focus's pixels whose focus point clipping leaves
  double coverage = 0.0;    ///< share of them that is shown unoccluded
  double withoutClip = 0.0; ///< the same if nothing were clipped
  std::optional<double> light = {};          ///< relative to the focus alone
  std::optional<double> contextRemoved = {}; ///< share of the matter that is not focus
};

/// Of a scene that has measured its focus's depth; nothing of others, and where it is stopped.
std::optional<FocusReport> measureFocus(const Scene& scene, std::uint64_t seed,
                                        const StopFlag& stop);

} // namespace fenestra
