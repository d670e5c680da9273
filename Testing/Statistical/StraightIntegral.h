#pragma once
// The medium, and the optical depth of a ray, exact to rounding and independent of tracking: from
// the voxels and the knots of the medium's table alone.

#include "model/medium/TransferFunction.h"
#include "model/volume/Volume.h"

#include <vector>

namespace fenestra::testing {

class StraightIntegral {
public:
  /// No clip, no gradient opacity.
  StraightIntegral(const Volume& volume, const TransferFunction& transfer);

  /// Where a ray (world, unit direction) is inside the box that the voxels fill, from t = 0 on.
  Interval inside(const Ray& ray) const;
  /// At a point (world) inside the box, and at a scalar.
  double scalar(const Vec3& point) const;
  double extinction(double scalar) const;
  /// Of the part of the ray that is inside and within `range`, mm.
  double opticalDepth(const Ray& ray, const Interval& range = {}) const;

private:
  struct Knot {
    double position, extinction;
  };
  /// The scalar along a ray within one cell between voxel centres: a cubic in u, from 0 to 1.
  struct Cubic {
    double c0, c1, c2, c3;
    double operator()(double u) const { return c0 + u * (c1 + u * (c2 + u * c3)); }
  };

  Interval inside(const Vec3& origin, const Vec3& direction) const;
  Cubic cubicBetween(const Vec3& from, const Vec3& to) const;
  void addCrossings(const Cubic& cubic, std::vector<double>& breaks) const;
  double meanExtinction(const Cubic& cubic) const;
  double scalarInCell(const Vec3& index, const Vec3& inCell) const;

  Affine m_worldToIndex;
  Size3 m_size;
  std::vector<double> m_scalars;
  std::vector<Knot> m_knots;
};

} // namespace fenestra::testing
