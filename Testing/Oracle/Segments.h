#pragma once
// Colours of segments at a point, straight from their labels.

#include "OracleScene.h"

namespace fenestra::oracle {

class Segments {
public:
  explicit Segments(const TintDescription& tint) : m_tint(tint) {}

  /// Albedo at a world point where the scalar's own is `own`: mean over the components, weighted by
  /// trilinear shares of the eight voxels around.
  Rgb albedo(const Vec3& world, double scalar, const Rgb& own) const;

private:
  /// Shares at a voxel of the first segment's labelmap, in 255ths, by component.
  std::vector<double> sharesAt(const Vec3& voxel) const;

  const TintDescription& m_tint;
};

} // namespace fenestra::oracle
