#pragma once
// The one place where the voxel type becomes known. For render's own sources.

#include "transport/render/Render.h"

namespace fenestra {

/// Calls work(medium, tracker) for the volume's storage type.
template <typename Work>
auto withMedium(const RenderScene& scene, Work&& work, const StopFlag& stop = neverStopped) {
  return std::visit(
      [&](const auto& voxels) {
        using Voxel = typename std::decay_t<decltype(voxels)>::value_type;
        const Medium<Voxel> medium(scene.volume.grid, voxels, scene.transfer, scene.style);
        const Tracker<Voxel> tracker(Domain(scene.volume.grid, scene.crop), medium, scene.majorants,
                                     scene.clip, stop);
        return work(medium, tracker);
      },
      scene.volume.voxels);
}

} // namespace fenestra
