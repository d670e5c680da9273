#pragma once
// Voxels inside a closed surface.

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

/// Voxels of a grid of `size` whose centres (at integers) are inside: an odd number of the
/// surface's triangles lies before them in their row. `points` are in index space. Rows count as
/// moved by an infinitesimal in y, and a smaller one in z, so that no row meets an edge and each
/// crossing counts once (Edelsbrunner and Mücke 1990, "Simulation of simplicity"). nullopt: the
/// surface has a hole in some row, or more than 10^9 pairs of row and triangle would be tested.
std::optional<std::vector<VoxelRun>>
voxelizeSurface(const std::vector<Vec3>& points,
                const std::vector<std::array<std::uint32_t, 3>>& triangles, const Size3& size);

} // namespace fenestra
