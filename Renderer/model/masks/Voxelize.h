#pragma once
// Scan conversion of a closed triangle mesh.

#include "base/Vector.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace fenestra::core {

/// Voxels [first, last) along x in the row (y, z).
struct VoxelRun {
  std::int64_t y = 0, z = 0, first = 0, last = 0;
};

/// Voxels of a grid of `size` whose centers (at integers) are inside the mesh: an odd number of
/// triangles lies before them in their row. `points` are in index space. Each row is perturbed by
/// an infinitesimal in y and a smaller one in z, so that it meets no edge and each intersection
/// counts once (Edelsbrunner and Mücke 1990, "Simulation of simplicity"). nullopt: the mesh has a
/// hole in some row, or more than 10^9 pairs of row and triangle would be tested.
std::optional<std::vector<VoxelRun>>
voxelizeSurface(const std::vector<Vec3>& points,
                const std::vector<std::array<std::uint32_t, 3>>& triangles, const Size3& size);

} // namespace fenestra::core
