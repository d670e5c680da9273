#pragma once
// Matter of the clipped volume at a point, given in world and in index space. `wantGradient`: as
// Medium::matter.

#include "clip/field/Clip.h"
#include "model/medium/Medium.h"

namespace fenestra {

/// Gradient of the clip's cut, where surfaces are shaded.
template <typename Voxel>
Vec3 findCutGradient(const Medium<Voxel>& medium, const Clip& clip, const Vec3& world) {
  return medium.transfer().shading ? cutGradient(clip, world) : Vec3::Zero();
}

/// Parts of a mixture; what a clip keeps matters where it does not keep as much of all.
template <typename Voxel>
MixturePoint makeMixturePoint(const Medium<Voxel>& medium, const Clip& clip, const Vec3& world,
                              const Vec3& index) {
  return medium.makePoint(index,
                          medium.mixtureField()->hasUnclipped() ? clipWeight(clip, world) : 1.0);
}

/// Matter that a collision meets; of a mixture one component, drawn.
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

/// Calls visit(matter, probability) for all matter that a collision may meet.
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

} // namespace fenestra
