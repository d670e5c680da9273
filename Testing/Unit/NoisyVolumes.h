#pragma once
// Volumes with noise, for tests of filters.

#include "base/Random.h"
#include "model/volume/Volume.h"

#include <numbers>

namespace fenestra::core::testing {

/// Standard normal number of a voxel.
inline double normalNoise(std::uint64_t seed, const Size3& voxel) {
  const auto place = static_cast<std::uint64_t>(linearIndex(voxel, {1 << 12, 1 << 12, 1 << 12}));
  Random random(seed, place, 0);
  const double radius = std::sqrt(-2.0 * std::log(1.0 - random.uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * random.uniform());
}

inline Grid makeScaledGrid(const Size3& size, const Vec3& spacing) {
  Affine map = Affine::Identity();
  map.linear() = Mat3::Diagonal(spacing);
  return {size, map};
}

/// Volume of value(voxel); integers are rounded.
template <typename Voxel, typename Function>
Volume makeVoxels(const Grid& grid, Function&& value) {
  LargeArray<Voxel> voxels;
  for (std::int64_t z = 0; z < grid.size.z(); ++z)
    for (std::int64_t y = 0; y < grid.size.y(); ++y)
      for (std::int64_t x = 0; x < grid.size.x(); ++x) {
        const double v = value(Size3(x, y, z));
        voxels.push_back(static_cast<Voxel>(std::is_integral_v<Voxel> ? std::round(v) : v));
      }
  Volume volume{grid, std::move(voxels), 0.0, 0.0, "test volume", {}};
  computeRange(volume);
  return volume;
}

template <typename Voxel>
const LargeArray<Voxel>& voxelsOf(const Volume& volume) {
  return std::get<LargeArray<Voxel>>(volume.voxels);
}

} // namespace fenestra::core::testing
