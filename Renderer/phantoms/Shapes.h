#pragma once
// Shapes as distance functions: negative inside, positive outside, in mm, exact near the surface to
// first order or a little less. The blends follow Quilez, "Smooth minimum" (polynomial, quadratic).

#include "base/Vector.h"

#include <functional>
#include <vector>

namespace fenestra {

/// 0 up to `low`, 1 from `high` on, smooth between.
double smoothStep(double low, double high, double x);

/// Union, intersection and difference of two shapes, blended where they are within `blend` mm.
double smoothUnion(double a, double b, double blend);
double smoothIntersection(double a, double b, double blend);
double smoothDifference(double a, double b, double blend);

double ellipsoidDistance(const Vec3& point, const Vec3& center, const Vec3& radii);

/// A box around the origin with its edges rounded.
double roundedBoxDistance(const Vec3& point, const Vec3& halfSize, double radius);

Box expanded(const Box& box, double margin);
bool contains(const Box& box, const Vec3& point);
/// The box around both, and around a box seen through an affine map.
Box united(const Box& a, const Box& b);
Box mapped(const Affine& map, const Box& box);

/// From the world to a shape's own space, in which `origin` is 0, z runs along `axis`, y toward
/// `up` and x along axis x up (a mirrored space: x is a right limb's lateral side where axis is
/// anterior and up superior). mm stay mm.
Affine toShape(const Vec3& origin, const Vec3& axis, const Vec3& up);

/// A shape with a box around it, in the world.
struct Solid {
  std::function<double(const Vec3&)> distance; ///< mm
  Box box;
};
Solid ellipsoid(const Vec3& center, const Vec3& radii);
/// Edges rounded by `radius`; `halfSize` along the shape's own x, y, z.
Solid block(const Affine& toShape, const Vec3& halfSize, double radius);
Solid unite(const Solid& a, const Solid& b, double blend);
Solid intersect(const Solid& a, const Solid& b, double blend);

/// A cross-section of a loft: an ellipse, more or less square, in the axial plane.
struct LoftSection {
  double z = 0.0;
  Vec2 center = Vec2::Zero();
  Vec2 radii = Vec2::Ones();
};

/// A solid through axial cross-sections, in which centre and radii run as Catmull-Rom curves of z.
class Loft {
public:
  /// Sections by rising z, at least two. `squareness` runs from 0 (ellipse) to 1 (superellipse of
  /// exponent 4). The ends are flat, rounded over `capBlend` mm.
  Loft(std::vector<LoftSection> sections, double squareness, double capBlend);

  double distance(const Vec3& point) const;
  const Box& box() const { return m_box; }

private:
  LoftSection sectionAt(double z) const;

  std::vector<LoftSection> m_sections;
  double m_squareness, m_capBlend;
  Box m_box;
};

/// A loft in a space of its own.
Solid placed(const Affine& toShape, const Loft& loft);

/// A point of a tube's axis and the tube's radius there.
struct TubeNode {
  Vec3 point;
  double radius;
};

/// A tube along a Catmull-Rom curve through its nodes. `stretch` (each component at least 1) makes
/// it a band: its cross-section is that many times wider along each axis.
class Tube {
public:
  Tube(const std::vector<TubeNode>& nodes, const Vec3& stretch = Vec3::Ones());

  double distance(const Vec3& point) const;
  const Box& box() const { return m_box; }

private:
  std::vector<TubeNode> m_nodes; ///< of the refined axis, in the space divided by the stretch
  Vec3 m_stretch;
  Box m_box;
};

} // namespace fenestra
