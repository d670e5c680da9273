#pragma once
// Estimates the grid on which the labels of a label map were made. Tools resample label maps to the
// grid of a scan by nearest neighbors, so that their stairs are as wide as their native voxels.

#include "base/LargePages.h"
#include "base/Vector.h"

#include <cstdint>
#include <variant>

namespace fenestra::core {

/// Labels in the smallest type that holds all values; a voxel's layers are adjacent, x fastest.
using Labels =
    std::variant<LargeArray<std::uint8_t>, LargeArray<std::int16_t>, LargeArray<std::int32_t>>;

/// Edges of the native voxels along each axis, in voxels of the label map (`size`), each at least
/// 1. Nearest neighbor resampling to a finer grid repeats planes: if no label changes between a
/// fraction e of neighboring planes, native voxels are 1 / (1 - e) voxels wide. The result is 1
/// where few planes are repeated, or where there are too few planes to decide. If labels of several
/// grids are joined, it is the finest one.
Vec3 estimateNativeVoxels(const Labels& labels, const Size3& size, std::size_t layerCount);

} // namespace fenestra::core
