#pragma once
// Lines that stand for the cells between eight voxels: four per cell, along the axis of greatest
// change, at the points of Gauss's quadrature across it.

#include "model/masks/LevelLengths.h"

#include <array>
#include <cstdint>

namespace fenestra::core {

/// Adds the lines of a row of `count` - 1 cells between `count` voxels of four rows: (y, z),
/// (y + 1, z), (y, z + 1), (y + 1, z + 1). `values`: replacements of the voxel values.
void addCellLines(const std::array<const std::uint8_t*, 4>& rows, std::int64_t count,
                  const VoxelValues& values, LevelLengths& lengths);

} // namespace fenestra::core
