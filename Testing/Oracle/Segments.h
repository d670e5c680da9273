#pragma once
// Label weights of components at a point, directly from the masks of their segments.

#include "OracleScene.h"

#include <array>

namespace fenestra::core::oracle {

class Segments {
public:
  static constexpr std::size_t maxComponents = 16;
  /// Label weight of each component; all sum to 1.
  using Weights = std::array<double, maxComponents>;

  /// Throws std::invalid_argument for too many components.
  explicit Segments(const ComponentsDescription& description);

  /// Trilinear between the voxels of the first segment's label map.
  Weights at(const Vec3& world) const { return atIndex(m_worldToIndex * world); }
  /// Gradient of a component's label weight, per mm, world axes: differences over two voxels.
  Vec3 gradient(std::size_t component, const Vec3& world) const;

private:
  Weights atIndex(const Vec3& index) const;
  /// At a voxel, in 255ths.
  Weights computeVoxel(const Vec3& at) const;

  const ComponentsDescription& m_description;
  Affine m_worldToIndex;
  Vec3 m_first, m_count; ///< box of voxels outside which component 0 has weight 1
  std::vector<Weights> m_voxels;
};

} // namespace fenestra::core::oracle
