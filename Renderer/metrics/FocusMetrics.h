#pragma once
// Measures of a clip: visibility and light of the focus, loss of the context.

#include "integrator/render/Render.h"

namespace fenestra {

/// Point in which the eye ray through a pixel's centre meets the focus.
struct FocusPoint {
  Ray ray;          ///< eye ray
  double distance;  ///< mm along `ray`
  bool isUnclipped; ///< clipping leaves the point, to the precision of the focus's depth in a pixel
  std::size_t pixel;
};
using FocusPoints = std::vector<FocusPoint>;

/// `depth`: mm in view space, row by row from the top; infinity: the ray misses the focus.
FocusPoints findFocusPoints(const SceneView& scene, const std::vector<double>& depth);

/// Share of the focus's pixels shown unoccluded: mean transmittance from the start of the eye ray
/// to the focus's points, 0 for points that clipping removes. Once `stop` is true walks are
/// abandoned and results are meaningless, here and below.
double measureCoverage(const SceneView& scene, const FocusPoints& focus, std::uint64_t seed,
                       const StopFlag& stop = neverStopped);

/// Direct light at the points that clipping leaves, relative to direct light in `alone`, the same
/// scene of nothing but the focus. At most 4096 points, four light samples each, the same for
/// both scenes. Empty if no light arrives in `alone`.
std::optional<double> measureLight(const SceneView& scene, const SceneView& focusOnly,
                                   const FocusPoints& focus, std::uint64_t seed,
                                   const StopFlag& stop = neverStopped);

/// Share of the context's matter (extinction > 0) that clipping removes, from 2^18 points: to about
/// 0.001. Empty if no point meets such matter.
std::optional<double> measureContextRemoved(const SceneView& scene, const Mask& focus,
                                            std::uint64_t seed);

/// Quality of a picture's clip, for the stats.
struct FocusReport {
  double unclipped = 0.0;   ///< share of the focus's pixels whose focus point clipping leaves
  double coverage = 0.0;    ///< share of the focus's pixels shown unoccluded
  double withoutClip = 0.0; ///< coverage without a clip
  std::optional<double> light = {};          ///< relative to the focus alone
  std::optional<double> contextRemoved = {}; ///< removed share of the context's matter
};

/// All measures above of a scene. `ranges`: those of its majorants. `depth`: as for
/// findFocusPoints. Nothing: stopped.
std::optional<FocusReport> measureFocus(const SceneView& scene, const MinMaxGrid& ranges,
                                        const Mask& focus, const std::vector<double>& depth,
                                        std::uint64_t seed, const StopFlag& stop);

} // namespace fenestra
