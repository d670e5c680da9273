#pragma once
// Optical depth along a ray, exact up to rounding and independent of tracking: it uses only the
// voxels and the knots of the transfer function.

#include "model/medium/TransferFunction.h"
#include "model/volume/Volume.h"

#include <vector>

namespace fenestra::core::testing {

class LineIntegral {
public:
  /// Requires a scene without a clip and without gradient opacity.
  LineIntegral(const Volume& volume, const TransferFunction& transfer);

  /// Interval of a ray (world, unit direction), t >= 0, inside the volume's box.
  Interval boxInterval(const Ray& ray) const;
  /// Scalar at a point (world) inside the box; extinction at a scalar, mm^-1.
  double interpolate(const Vec3& point) const;
  double extinction(double scalar) const;
  /// Optical depth of the part of the ray that is inside the box and within `range` (mm).
  double opticalDepth(const Ray& ray, const Interval& range = {}) const;

private:
  struct Knot {
    double position, extinction;
  };
  /// Scalar along a ray within one cell between voxel centers: a cubic in u, 0 to 1.
  struct Cubic {
    double c0, c1, c2, c3;
    double operator()(double u) const { return c0 + u * (c1 + u * (c2 + u * c3)); }
  };

  Interval boxInterval(const Vec3& origin, const Vec3& direction) const;
  Cubic fitCubic(const Vec3& from, const Vec3& to) const;
  void addKnotCrossings(const Cubic& cubic, std::vector<double>& breaks) const;
  double meanExtinction(const Cubic& cubic) const;
  double interpolateInCell(const Vec3& index, const Vec3& inCell) const;

  Affine m_worldToIndex;
  Size3 m_size;
  std::vector<double> m_scalars;
  std::vector<Knot> m_knots;
};

} // namespace fenestra::core::testing
