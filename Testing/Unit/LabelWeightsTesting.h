#pragma once
// Random segments, a scene with a dense medium around them, and its film.

#include "Support.h"
#include "base/Random.h"

namespace fenestra::core::testing {

/// Box of a labelmap with value(voxel) (0 to 255) in each voxel; `first` is its first voxel.
template <typename Value>
Mask makeMask(const Size3& first, const Size3& size, const Value& value) {
  Affine map = Affine::Identity();
  map.linear() = Mat3::Diagonal(Vec3(0.5, 0.75, 2.0));
  map.translation() = Vec3(3.0, -7.0, 11.0);
  map.translate(first.cast<double>());
  Mask mask;
  mask.grid = Grid(size, map);
  mask.maxValue = 255;
  for (std::int64_t z = 0; z < size.z(); ++z)
    for (std::int64_t y = 0; y < size.y(); ++y)
      for (std::int64_t x = 0; x < size.x(); ++x)
        mask.voxels.push_back(static_cast<std::uint8_t>(value(first + Size3(x, y, z))));
  return mask;
}

/// Overlapping boxes of random indicators with a margin of 0; priorities 0 to 2.
inline std::vector<LabelWeights::Part> makeRandomParts(int count) {
  std::vector<LabelWeights::Part> parts;
  for (int i = 0; i < count; ++i) {
    Random random(7, static_cast<std::uint64_t>(i), 0);
    const auto randomInt = [&](double limit) {
      return static_cast<std::int64_t>(random.uniform() * limit);
    };
    const Size3 first(randomInt(9), randomInt(9), randomInt(9)),
        size(4 + randomInt(9), 4 + randomInt(9), 4 + randomInt(9));
    const bool isHard = i % 2 == 0;
    const auto priority = static_cast<int>(randomInt(3));
    const auto value = [&, last = Size3(first + size)](const Size3& voxel) {
      const bool inside =
          (voxel.array() > first.array()).all() && (voxel.array() + 1 < last.array()).all();
      if (!inside)
        return std::int64_t{0};
      return isHard ? 255 : randomInt(256);
    };
    parts.push_back({makeMask(first, size, value), priority, static_cast<std::uint8_t>(i % 6 + 1)});
  }
  return parts;
}

/// Dense medium whose grid is offset from that of makeRandomParts() and extends partly beyond it.
inline TestScene makePartsScene() {
  const LabelWeights weights = makeLabelWeights(makeRandomParts(12));
  Affine map = weights.grid().indexToWorld;
  map.translate(Vec3(0.4, -0.7, 0.2));
  const Grid grid(weights.grid().size, map);
  return {makeVolume(grid, [](const Vec3& p) { return 0.3 + 0.02 * p.x(); }),
          makeLinearTransfer(0.6, Rgb(0.9, 0.8, 0.3)),
          {EnvironmentLight{}},
          {.position = grid.worldCenter() + Vec3(0, -100, 20),
           .target = grid.worldCenter(),
           .scale = 8.0}};
}

/// Film of 64 samples per pixel, with normals.
inline Film renderFilm(const TestScene& scene, Integrator integrator) {
  RenderSettings settings;
  settings.samples = 64;
  settings.integrator = integrator;
  settings.path.wantNormals = true;
  return scene.render(settings).film;
}

/// Root mean square over pixels and channels of the differences of value(pixel).
template <typename Value>
double computeRmsDifference(const Film& a, const Film& b, const Value& value) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.pixelCount(); ++i)
    sum += (value(a.pixels()[i]) - value(b.pixels()[i])).matrix().squaredNorm();
  return std::sqrt(sum / (3.0 * static_cast<double>(a.pixelCount())));
}

} // namespace fenestra::core::testing
