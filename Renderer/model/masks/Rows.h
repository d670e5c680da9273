#pragma once
// Loops over the rows of a grid.

#include "model/volume/Grid.h"

#include <tbb/parallel_for.h>

namespace fenestra::core {

/// Calls visit(y, z, index of the first voxel) for each row, in parallel.
template <typename Visitor>
void forEachRow(const Size3& size, const Visitor& visit) {
  tbb::parallel_for(std::int64_t{0}, size.z(), [&](std::int64_t z) {
    for (std::int64_t y = 0; y < size.y(); ++y)
      visit(y, z, linearIndex({0, y, z}, size));
  });
}

} // namespace fenestra::core
