#pragma once
// The classified volume at a point, directly from voxels and knots of the transfer function.

#include "OracleScene.h"

namespace fenestra::core::oracle {

/// Value at s from sorted knots; at a step, the value on its right.
Rgb evaluate(const ColorFunction& f, double s);

/// Maximum extinction of a transfer function, mm^-1.
double findMaxExtinction(const TransferFunction& transfer);

/// Interval of a ray, t >= 0, inside a box; empty: the ray misses.
Interval intersectBox(const Box& box, const Ray& ray);

class Medium {
public:
  Medium(const Volume& volume, const TransferFunction& transfer, const std::optional<Affine>& crop);

  /// True if a world point lies in the volume's box and in the crop.
  bool contains(const Vec3& world) const;
  double scalar(const Vec3& world) const { return scalarAtIndex(m_worldToIndex * world); }
  /// Transfer function of the volume. The functions below accept that of a component instead.
  const TransferFunction& transfer() const { return m_transfer; }
  /// Gradient for surfaces, by the kind of the volume's transfer function, in spans (scalar ranges
  /// of that function) per mm. Requires two knots.
  Vec3 spansPerMm(const Vec3& world) const;
  /// Extinction, mm^-1, by a transfer function; valid inside the volume only.
  double extinction(const TransferFunction& transfer, const Vec3& world, double scalar) const;
  /// Probability that a collision scatters at a surface (Kroes, Post, Botha 2012). `slope` is the
  /// gradient's magnitude, spans per mm.
  double surfaceProbability(const TransferFunction& transfer, const Vec3& world,
                            double slope) const;

  /// Interval of a world ray, t >= 0, inside the volume's box; empty: the ray misses.
  Interval boxInterval(const Vec3& origin, const Vec3& direction) const;

private:
  double scalarAtIndex(const Vec3& index) const;
  double scalarAtVoxel(const Size3& voxel) const;
  /// Differences per voxel along the index axes; Sobel's at a voxel, and interpolated.
  Vec3 centralDifference(const Vec3& index) const;
  Vec3 sobelAtVoxel(const Size3& voxel) const;
  Vec3 sobelDifference(const Vec3& index) const;

  Size3 m_size;
  Affine m_worldToIndex;
  std::vector<float> m_voxels; ///< exact for every storage type
  const TransferFunction& m_transfer;
  std::optional<Affine> m_worldToCrop;
};

} // namespace fenestra::core::oracle
