#pragma once
// Quality of a picture's clip, for the stats.

#include "session/Scene.h"

namespace fenestra {

struct FocusReport {
  double kept = 0.0;        ///< share of the focus's pixels whose focus point clipping leaves
  double coverage = 0.0;    ///< share of the focus's pixels shown unoccluded
  double withoutClip = 0.0; ///< coverage without a clip
  std::optional<double> light = {};          ///< relative to the focus alone
  std::optional<double> contextRemoved = {}; ///< removed share of the context's matter
};

/// Report for a scene with focusDepth(); nothing: none, or stopped.
std::optional<FocusReport> measureFocus(const Scene& scene, std::uint64_t seed,
                                        const StopFlag& stop);

} // namespace fenestra
