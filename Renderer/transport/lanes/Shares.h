#pragma once
// Shares of segments in the form that lanes read.

#include "base/Narrow.h"
#include "model/medium/Shares.h"
#include "transport/lanes/Medium.h"

#include <array>

namespace fenestra {

/// A view: the shares must outlive the object.
struct WideShares {
  /// Voxels and bricks of Shares along one axis.
  struct Axis {
    float last;         ///< index of the last voxel
    float lastCell;     ///< greatest index of a lower voxel in interpolation
    std::int32_t brick; ///< offset of the next brick
  };

  /// True if lanes can number the bytes of all planes.
  static bool serves(const Shares& shares);
  /// `volume`: whose points are asked for.
  WideShares(const Shares& shares, const Grid& volume);

  AffineRows toShares; ///< from the volume's index space
  std::array<Axis, 3> axes;
  const std::int32_t* bricks; ///< Shares::bricks()
  const Shares::Plane* planes;
};

} // namespace fenestra
