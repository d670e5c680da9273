#pragma once
// Label weights in SIMD form.

#include "base/Narrow.h"
#include "model/medium/LabelWeights.h"

#include <array>

namespace fenestra::core {

/// One axis of a voxel grid, for interpolation.
struct SimdAxis {
  float last;          ///< index of the last voxel
  float lastCell;      ///< maximum index of the lower voxel in interpolation
  std::int32_t stride; ///< array offset of the next voxel or brick; 0 along an axis of one voxel
};
using SimdAxes = std::array<SimdAxis, 3>;

/// `counts`: voxels or bricks per axis, which give the strides.
inline SimdAxes makeSimdAxes(const Size3& voxels, const Size3& counts) {
  const auto axis = [&](int i, std::int64_t stride) {
    return SimdAxis{static_cast<float>(voxels[i] - 1),
                    static_cast<float>(std::max<std::int64_t>(voxels[i] - 2, 0)),
                    static_cast<std::int32_t>(voxels[i] > 1 ? stride : 0)};
  };
  return {axis(0, 1), axis(1, counts.x()), axis(2, counts.x() * counts.y())};
}

/// Non-owning: the label weights must outlive the object.
struct SimdLabelWeights {
  /// True if 32 bits can index the bytes of all planes.
  static bool isSupported(const LabelWeights& weights) {
    constexpr std::size_t maxCount = std::size_t{1} << 32; // indices of 32 bits
    return weights.planes().size() <= maxCount / sizeof(LabelWeights::Plane);
  }
  /// `volume`: grid of the points to be looked up.
  SimdLabelWeights(const LabelWeights& weights, const Grid& volume)
      : toWeights(affineRows(weights.grid().worldToIndex * volume.indexToWorld)),
        axes(makeSimdAxes(weights.grid().size, weights.brickCount())),
        bricks(weights.bricks().data()),
        planes(weights.planes().data()),
        brickCount(weights.bricks().size()),
        planeCount(weights.planes().size()) {}

  AffineRows toWeights; ///< from the volume's index space
  SimdAxes axes;
  const std::int32_t* bricks; ///< LabelWeights::bricks()
  const LabelWeights::Plane* planes;
  std::size_t brickCount, planeCount;
};

} // namespace fenestra::core
