#pragma once
// The medium under the clip at a point, given in world and in index space. Medium is independent of
// the clip; here a soft cut adds its gradient (Clip.h), for scattering and for the ray marcher.
// `wantGradient` is that of Medium::evaluate.

#include "clip/field/Clip.h"
#include "model/medium/Medium.h"

namespace fenestra::core {

/// Gradient that the clip's soft cut adds; zero without surface shading.
template <typename Voxel>
Vec3 findCutGradient(const Medium<Voxel>& medium, const Clip& clip, const Vec3& world) {
  return medium.transfer().shading ? cutGradient(clip, world) : Vec3::Zero();
}

/// Point of a mixture. The clip weight matters only if the clip treats components differently.
template <typename Voxel>
MixturePoint makeMixturePoint(const Medium<Voxel>& medium, const Clip& clip, const Vec3& world,
                              const Vec3& index) {
  return medium.makePoint(index,
                          medium.mixtureField()->hasUnclipped() ? clipWeight(clip, world) : 1.0);
}

/// Medium at a collision: of a mixture, one component, sampled in proportion to its extinction.
template <typename Voxel>
MediumSample sampleMedium(const Medium<Voxel>& medium, const Clip& clip, const Vec3& world,
                          const Vec3& index, bool wantGradient, Random& random) {
  const Vec3 cut = findCutGradient(medium, clip, world);
  if (!medium.mixtureField())
    return medium.evaluate(index, wantGradient, cut);
  const MixturePoint point = makeMixturePoint(medium, clip, world, index);
  return medium.evaluate(medium.mixtureField()->sampleComponent(point, random), point, wantGradient,
                         cut);
}

/// Calls visit(medium, probability) for each medium that a collision may sample.
template <typename Voxel, typename Visit>
void forEachMediumSample(const Medium<Voxel>& medium, const Clip& clip, const Vec3& world,
                         const Vec3& index, bool wantGradient, Visit&& visit) {
  const Vec3 cut = findCutGradient(medium, clip, world);
  if (!medium.mixtureField()) {
    visit(medium.evaluate(index, wantGradient, cut), 1.0);
    return;
  }
  const MixturePoint point = makeMixturePoint(medium, clip, world, index);
  const double all = medium.mixtureField()->extinction(point);
  medium.mixtureField()->forEachPart(point, [&](const MixturePart& part) {
    visit(medium.evaluate(part.component, point, wantGradient, cut), part.extinction / all);
  });
}

} // namespace fenestra::core
