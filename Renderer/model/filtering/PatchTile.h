#pragma once
// Working memory of non-local means: a part of the volume that stays in the cache.

#include "base/Vector.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace fenestra::core {

/// Sums of a row of voxels.
struct PatchSums {
  float* weights;
  float* changes; ///< weighted differences from the voxel
  float* greatest;

  /// Mean difference from voxel x of the row, which itself weighs as much as the greatest other.
  float meanChange(std::int64_t x) const {
    constexpr float leastWeight = 1e-3F;
    return changes[x] / (weights[x] + std::max(greatest[x], leastWeight));
  }
};

struct PatchTile {
  static constexpr std::int64_t columns = 128, rows = 32, slices = 8;
  static constexpr std::int64_t reach = 3;          ///< greatest offset of averaged voxels
  static constexpr std::int64_t margin = reach + 1; ///< and a voxel of their patches
  static Size3 largest() { return {columns, rows, slices}; }

  PatchTile(std::vector<Size3> stepsIn, float noiseIn, bool hasValues)
      : steps(std::move(stepsIn)),
        noise(noiseIn),
        compared(stride * (rows + 2 * margin) * (slices + 2 * margin)),
        values(hasValues ? compared.size() : 0),
        scratch(columns * (rows + 2)),
        m_slices(3 * sliceSize),
        m_sums(3 * sliceSize * slices) {}

  /// Index of a row's first voxel; y and z may lie in the margin.
  std::int64_t index(std::int64_t y, std::int64_t z) const {
    return margin + stride * (y + margin + (rows + 2 * margin) * (z + margin));
  }
  std::int64_t offset(const Size3& step) const {
    return step.x() + stride * (step.y() + (rows + 2 * margin) * step.z());
  }
  const float* averaged() const { return values.empty() ? compared.data() : values.data(); }
  /// Squared differences of slice z, of which the last three are stored.
  float* slice(std::int64_t z) {
    return &m_slices[static_cast<std::size_t>((z + 3) % 3) * sliceSize];
  }
  PatchSums sums(std::int64_t y, std::int64_t z) {
    float* const first = &m_sums[static_cast<std::size_t>(3 * (y + rows * z) * columns)];
    return {first, first + columns, first + 2 * columns};
  }
  void clearSums() { std::ranges::fill(m_sums, 0.0F); }

  std::vector<Size3> steps;            ///< offsets of the voxels that are averaged
  float noise;                         ///< 2 s^2 / (16 h^2)
  Size3 size = largest();              ///< voxels without margin
  std::vector<float> compared, values; ///< with margin; values: empty if they are the compared ones
  std::vector<float> scratch;

private:
  static constexpr std::int64_t stride = columns + 2 * margin; ///< floats per row
  static constexpr std::int64_t sliceSize = columns * rows;

  std::vector<float> m_slices, m_sums;
};

} // namespace fenestra::core
