#pragma once
// Clip metrics: visibility and illumination of the focus, and how much context is removed.

#include "integrator/render/Render.h"

namespace fenestra::core {

/// Point where the camera ray through a pixel's center hits the focus.
struct FocusPoint {
  Ray ray;          ///< camera ray
  double distance;  ///< mm along `ray`
  bool isUnclipped; ///< not removed by the clip, to the precision of the focus depth in a pixel
  std::size_t pixel;
};
using FocusPoints = std::vector<FocusPoint>;

/// `depth`: mm in view space, row by row from the top; infinity if the ray misses the focus.
FocusPoints findFocusPoints(const SceneView& scene, const std::vector<double>& depth);

/// Fraction of the focus's pixels shown unoccluded: mean transmittance from the start of the camera
/// ray to the focus points, 0 for points that the clip removes. Here and below, results are
/// meaningless once `stop` is set.
double measureCoverage(const SceneView& scene, const FocusPoints& focus, std::uint64_t seed,
                       const StopFlag& stop = neverStopped);

/// Direct light at the unclipped points, relative to direct light in `focusOnly`, the same scene
/// without anything but the focus. Uses at most 4096 points and four light samples per point, the
/// same in both scenes. Empty if no light arrives in `focusOnly`.
std::optional<double> measureLight(const SceneView& scene, const SceneView& focusOnly,
                                   const FocusPoints& focus, std::uint64_t seed,
                                   const StopFlag& stop = neverStopped);

/// Fraction of the context's medium (extinction > 0) that the clip removes, from 2^18 points,
/// accurate to about 0.001. Empty if no point lies in the context's medium.
std::optional<double> measureContextRemoved(const SceneView& scene, const Mask& focus,
                                            std::uint64_t seed);

/// Metrics of an image's clip, for the stats file.
struct FocusReport {
  double unclipped = 0.0;   ///< fraction of the focus's pixels whose focus point is unclipped
  double coverage = 0.0;    ///< fraction of the focus's pixels shown unoccluded
  double withoutClip = 0.0; ///< coverage without a clip
  std::optional<double> light = {};          ///< relative to the focus alone
  std::optional<double> contextRemoved = {}; ///< removed fraction of the context's medium
};

/// Computes all metrics above. `ranges`: those of the scene's majorants. `depth`: as for
/// findFocusPoints. Empty if stopped.
std::optional<FocusReport> measureFocus(const SceneView& scene, const MinMaxGrid& ranges,
                                        const Mask& focus, const std::vector<double>& depth,
                                        std::uint64_t seed, const StopFlag& stop);

} // namespace fenestra::core
