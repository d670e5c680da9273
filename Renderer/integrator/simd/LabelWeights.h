#pragma once
// Shares of segments in the form that lanes read.

#include "base/Narrow.h"
#include "model/medium/LabelWeights.h"

#include <array>

namespace fenestra {

/// Voxels along one axis, for interpolation in lanes.
struct SimdAxis {
  float last;          ///< index of the last voxel
  float lastCell;      ///< greatest index of a lower voxel in interpolation
  std::int32_t stride; ///< offset in this axis of the next voxel or brick; 0 for one voxel
};
using SimdAxes = std::array<SimdAxis, 3>;

/// `counts`: of voxels or bricks, for the strides.
inline SimdAxes makeSimdAxes(const Size3& voxels, const Size3& counts) {
  const auto axis = [&](int i, std::int64_t stride) {
    return SimdAxis{static_cast<float>(voxels[i] - 1),
                    static_cast<float>(std::max<std::int64_t>(voxels[i] - 2, 0)),
                    static_cast<std::int32_t>(voxels[i] > 1 ? stride : 0)};
  };
  return {axis(0, 1), axis(1, counts.x()), axis(2, counts.x() * counts.y())};
}

/// A view: the shares must outlive the object.
struct SimdLabelWeights {
  /// True if lanes can number the bytes of all planes.
  static bool isSupported(const LabelWeights& weights) {
    constexpr std::size_t maxCount = std::size_t{1} << 32; // indices of 32 bits
    return weights.planes().size() <= maxCount / sizeof(LabelWeights::Plane);
  }
  /// `volume`: whose points are asked for.
  SimdLabelWeights(const LabelWeights& weights, const Grid& volume)
      : toWeights(affineRows(weights.grid().worldToIndex * volume.indexToWorld)),
        axes(makeSimdAxes(weights.grid().size, weights.brickCount())),
        bricks(weights.bricks().data()),
        planes(weights.planes().data()) {}

  AffineRows toWeights; ///< from the volume's index space
  SimdAxes axes;
  const std::int32_t* bricks; ///< Shares::bricks()
  const LabelWeights::Plane* planes;
};

} // namespace fenestra
