#include "model/volume/Mask.h"

#include <algorithm>

namespace fenestra {

bool meetsMask(const Mask& mask, const Box& box) {
  const Vec3 last = (mask.grid.size.array() - 1).cast<double>();
  const auto within = [&](const Vec3& index) { return index.cwiseMax(0.0).cwiseMin(last); };
  const Size3 first = within(box.lower.array().floor()).cast<std::int64_t>();
  const Size3 end = within(box.upper.array().ceil()).cast<std::int64_t>().array() + 1;
  const Size3& size = mask.grid.size;
  for (std::int64_t z = first.z(); z < end.z(); ++z)
    for (std::int64_t y = first.y(); y < end.y(); ++y) {
      const auto row = mask.voxels.begin() + size.x() * (y + size.y() * z);
      if (std::any_of(row + first.x(), row + end.x(),
                      [&](std::uint8_t voxel) { return voxel >= mask.half(); }))
        return true;
    }
  return false;
}

} // namespace fenestra
