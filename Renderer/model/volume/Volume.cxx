#include "model/volume/Volume.h"

namespace fenestra {

void computeRange(Volume& volume) {
  std::visit(
      [&volume](const auto& voxels) {
        if (voxels.empty())
          return;
        const auto [low, high] = std::minmax_element(voxels.begin(), voxels.end());
        volume.minimum = static_cast<double>(*low);
        volume.maximum = static_cast<double>(*high);
      },
      volume.voxels);
}

} // namespace fenestra
