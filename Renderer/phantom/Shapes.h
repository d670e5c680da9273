#pragma once
// Shapes as distance functions: negative inside, positive outside, in mm, exact near the surface to
// first order or a little less. The blends follow Quilez, "Smooth minimum" (polynomial, quadratic).

#include "core/Vector.h"

#include <vector>

namespace fenestra {

/// 0 up to `low`, 1 from `high` on, smooth between.
double smoothStep(double low, double high, double x);

/// Union, intersection and difference of two shapes, blended where they are within `blend` mm.
double smoothUnion(double a, double b, double blend);
double smoothIntersection(double a, double b, double blend);
double smoothDifference(double a, double b, double blend);

double ellipsoidDistance(const Vec3& point, const Vec3& center, const Vec3& radii);

Box expanded(const Box& box, double margin);

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
