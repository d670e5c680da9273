#pragma once
// Matter of the clipped volume at a point.

#include "clip/keep/Clip.h"
#include "model/medium/Medium.h"

namespace fenestra {

/// Matter at a point, given in world and in index space; where there is surface shading, with the
/// gradient of the clip's cut. `wantGradient`: as Medium::matter.
template <typename Voxel>
Matter matterAt(const Medium<Voxel>& medium, const Clip& clip, const Vec3& world, const Vec3& index,
                bool wantGradient) {
  if (!medium.transfer().shading)
    return medium.matter(index, wantGradient);
  return medium.matter(index, wantGradient, cutGradient(clip, world));
}

} // namespace fenestra
