#pragma once
// A regular voxel grid with its transform to world space. Rays are mapped affinely to index or cell
// space, but their parameter stays in world mm, so that distances agree in all spaces.

#include "base/Vector.h"

#include <cstdint>

namespace fenestra::core {

/// Linear index of a voxel (or cell) in a grid of `size`, x fastest.
inline std::size_t linearIndex(const Size3& voxel, const Size3& size) {
  return static_cast<std::size_t>(voxel.x() + size.x() * (voxel.y() + size.y() * voxel.z()));
}

/// Voxel centers are at integers in index space; the grid fills [-0.5, size - 0.5] in each axis.
struct Grid {
  Size3 size = Size3::Zero();               ///< voxels per axis, fastest axis first
  Affine indexToWorld = Affine::Identity(); ///< index to RAS mm; any invertible map
  Affine worldToIndex = Affine::Identity();

  Grid() = default;
  Grid(const Size3& sizeIn, const Affine& indexToWorldIn)
      : size(sizeIn), indexToWorld(indexToWorldIn), worldToIndex(indexToWorldIn.inverse()) {}

  bool operator==(const Grid&) const = default;

  std::int64_t voxelCount() const { return size.prod(); }
  Box indexBox() const { return {Vec3::Constant(-0.5), size.cast<double>().array() - 0.5}; }
  /// Distance between neighboring voxel centers along each axis, mm.
  Vec3 spacing() const { return indexToWorld.linear().columnNorms(); }
  Vec3 worldCenter() const { return indexToWorld * indexBox().center(); }
  Vec3 worldCorner(int i) const { return indexToWorld * indexBox().corner(i); }
  /// Radius of the box's bounding sphere around worldCenter(), mm.
  double boundingRadius() const {
    double radius = 0.0;
    for (int i = 0; i < 4; ++i) // opposite corners are at the same distance
      radius = std::max(radius, (worldCorner(i) - worldCenter()).norm());
    return radius;
  }
};

} // namespace fenestra::core
