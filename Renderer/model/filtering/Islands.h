#pragma once
// Islands of opacity: small groups of voxels that a transfer function shows by themselves, such as
// noise between the shoulders that reaches the values of bone.

#include "model/volume/Volume.h"

#include <functional>
#include <vector>

namespace fenestra::core {

struct RunOfIsland {
  std::int64_t begin, end; ///< voxels of one row, by linear index
};

using RunPredicate = std::function<bool(const RunOfIsland&)>;

/// Voxels of all islands, in ascending order.
struct Islands {
  std::vector<RunOfIsland> runs = {};
  std::int64_t count = 0; ///< islands
  double volume = 0.0;    ///< mm^3, of all of them
};

/// Groups of voxels above `onset`, connected by faces, edges or corners, whose volume is less than
/// `largest` mm^3. The greatest group is none, so that a small subject does not vanish, nor is any
/// with a preserved run.
Islands findIslands(const Volume& volume, double onset, double largest,
                    const RunPredicate& isPreserved = {});

/// Lowers the voxels of islands to `onset`, rounded down for integers. `volume`: of the same grid.
void removeIslands(Volume& volume, const Islands& islands, double onset);

} // namespace fenestra::core
