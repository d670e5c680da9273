#pragma once
// Which voxels a closed surface holds. For io's own sources.

#include "base/Vector.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace fenestra {

/// Voxels [first, last) of the row (y, z) along x.
struct VoxelRun {
  std::int64_t y = 0, z = 0, first = 0, last = 0;
};

/// The voxels of a grid of `size` whose centres (at integers) are inside: an odd number of the
/// surface's triangles lies before them in their row. Points are in index space. The rows' places
/// count as moved by an infinitesimal in y, and a smaller one in z, so that no row meets an edge
/// and each crossing counts once (Edelsbrunner and Mücke 1990, "Simulation of simplicity"). Nothing
/// where the surface has a hole in some row, or crosses rows more than a thousand million times.
std::optional<std::vector<VoxelRun>>
voxelRuns(const std::vector<Vec3>& points,
          const std::vector<std::array<std::uint32_t, 3>>& triangles, const Size3& size);

} // namespace fenestra
