#pragma once
// Distances between voxels.

#include "model/volume/Grid.h"

#include <vector>

namespace fenestra::core {

using Marks = std::vector<std::uint8_t>; ///< 1: voxels of a set; x fastest

/// Distances, mm, from each voxel to the nearest marked one, limited to `most`. Exact where the
/// grid's axes are orthogonal. Time grows with `most` per voxel edge.
std::vector<float> computeDistances(const Marks& marks, const Grid& grid, double most);

} // namespace fenestra::core
