#pragma once
// Colours of segments in the form that lanes read.

#include "base/Narrow.h"
#include "model/medium/Tint.h"
#include "transport/lanes/Medium.h"

#include <optional>
#include <vector>

namespace fenestra {

/// A view: the tint must outlive the object.
struct WideTint {
  /// Voxels and bricks of Shares along one axis.
  struct Axis {
    float last;         ///< index of the last voxel
    float lastCell;     ///< greatest index of a lower voxel in interpolation
    std::int32_t brick; ///< offset of the next brick
  };

  /// True if lanes can number the words of all groups.
  static bool serves(const Tint& tint);
  /// `volume`: whose points are asked for.
  WideTint(const Tint& tint, const Grid& volume);

  AffineRows toShares; ///< from the volume's index space
  std::array<Axis, 3> axes;
  const std::int32_t* bricks; ///< Shares::bricks()
  const Shares::Group* groups;
  std::vector<std::optional<WideTable>> albedo; ///< of each component, as in Tint
};

} // namespace fenestra
