#pragma once
// Expected first flight along the eye rays of each pixel, by a march: features for the filter, free
// of noise, and independent of the samples, as the filter's told error needs them.
//
// The march has a step size. Features may: any function of the scene serves, and none of these
// numbers becomes a part of the picture.

#include "image/Image.h"
#include "integrator/render/Render.h"

namespace fenestra {

/// Expected values over the eye rays of each pixel; a ray that meets nothing counts as 0. Sums are
/// over collisions, weighted by their probability T(t) sigma_t(t) dt.
struct FeatureBuffers {
  Plane light; ///< radiance of light that a pixel's mean collision scatters first, mean of colours
  Plane hit;   ///< probability of a collision, 0 to 1
  Plane depth; ///< sum of view-space depth, mm: the mean depth times `hit`
  std::array<Plane, 3> albedo; ///< linear, as Film's
  std::array<Plane, 3> normal; ///< world axes, toward the eye
  std::array<Plane, 3>
      surfaceNormal; ///< the same, times the probability of scattering at a surface
};

/// Rays start exactly behind the clip's surface; cells without matter are stepped over. One ray
/// through the middle of a pixel, or, where that differs from a neighbour's by more than fixed
/// thresholds, the mean of 2x2: a part of a picture is marched as the whole is, but for its border.
/// Uses the calling arena's threads; independent of their number.
FeatureBuffers computeFeatures(const SceneView& scene);

/// The same, ray by ray (denoise/features/RayMarcher.h): for scenes that lanes do not serve.
FeatureBuffers computeScalarFeatures(const SceneView& scene);

} // namespace fenestra
