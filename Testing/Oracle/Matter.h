#pragma once
// The classified volume at a point, straight from the voxels and the medium table's knots.

#include "OracleScene.h"

namespace fenestra::oracle {

class Matter {
public:
  Matter(const Volume& volume, const TransferFunction& transfer, const std::optional<Affine>& crop);

  /// Whether a world point is in the volume's box and in what the crop leaves of it.
  bool inside(const Vec3& world) const;
  /// Extinction, mm^-1; only inside.
  double extinction(const Vec3& world) const;
  Rgb albedo(const Vec3& world) const;
  /// Of the scalar, per mm, world axes.
  Vec3 gradient(const Vec3& world) const;
  /// Chance that a collision scatters at a surface (design, section 1).
  double surfaceProbability(const Vec3& world) const;
  /// No extinction anywhere is greater.
  double majorant() const { return m_majorant; }
  double g() const { return m_transfer.g; }
  const SurfaceShading& shading() const { return *m_transfer.shading; }

  /// The part of a world ray, from t = 0 on, that is inside the volume's box; empty where it
  /// misses.
  Interval inBox(const Vec3& origin, const Vec3& direction) const;

private:
  double scalarAtIndex(const Vec3& index) const;

  Size3 m_size;
  Affine m_worldToIndex;
  std::vector<float> m_voxels; ///< exact for every storage type
  const TransferFunction& m_transfer;
  std::optional<Affine> m_worldToCrop;
  double m_majorant;
};

} // namespace fenestra::oracle
