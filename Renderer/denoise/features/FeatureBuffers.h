#pragma once
// Feature buffers of the denoiser: expected first collisions of camera rays, by ray marching. They
// are free of noise and independent of the samples, which the denoiser's error estimate requires.
//
// The ray marcher has a step size. Its bias is harmless: any function of the scene may be a
// feature, and features never enter the raw image.

#include "image/Image.h"
#include "integrator/render/Render.h"

namespace fenestra::core {

/// Expected values over the camera rays of each pixel: integrals over the first collision, weighted
/// by its pdf T(t) sigma_t(t) dt. A ray without collision contributes 0.
struct FeatureBuffers {
  Plane light; ///< direct light scattered toward the camera at the mean collision, mean of RGB
  Plane hit;   ///< probability of a collision, 0 to 1
  Plane depth; ///< view-space depth, mm: the mean depth times `hit`
  /// View-space depth, mm, at which half of the light of the ray through the pixel's center is
  /// stopped; infinity: less is. Not for the denoiser, but to find the point that a pixel shows.
  Plane depth50;
  std::array<Plane, 3> albedo;        ///< linear, as Film's
  std::array<Plane, 3> normal;        ///< world axes, toward the camera
  std::array<Plane, 3> surfaceNormal; ///< normal times the probability of scattering at a surface
};

/// Effort per pixel. `draft`: one camera ray and one light sample, for previews.
enum class FeatureEffort { full, draft };

/// Rays start exactly behind the clip's surface and skip empty cells. A pixel gets one ray through
/// its center or, if the result differs from a neighbor's by more than fixed thresholds, the mean
/// of 2x2 rays. So part of an image gets the same features as in the complete image, its border
/// excepted. Uses the threads of the calling arena; the result does not depend on their number.
/// Once `stop` is true, returns soon, with an incomplete result.
FeatureBuffers computeFeatures(const SceneView& scene, FeatureEffort effort = FeatureEffort::full,
                               const StopFlag& stop = neverStopped);

/// Scalar version of computeFeatures, for scenes that SIMD does not support.
FeatureBuffers computeScalarFeatures(const SceneView& scene,
                                     FeatureEffort effort = FeatureEffort::full,
                                     const StopFlag& stop = neverStopped);

} // namespace fenestra::core
