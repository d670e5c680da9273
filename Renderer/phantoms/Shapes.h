#pragma once
// Shapes as distance functions: mm, negative inside, positive outside; near the surface exact to
// first order, or slightly less. Blends follow Quilez, "Smooth minimum" (polynomial, quadratic).

#include "base/Vector.h"

#include <functional>
#include <vector>

namespace fenestra {

/// Union, intersection and difference of two shapes, blended where their distances differ by less
/// than `blend`, mm.
double smoothUnion(double a, double b, double blend);
double smoothIntersection(double a, double b, double blend);
double smoothDifference(double a, double b, double blend);

double ellipsoidDistance(const Vec3& point, const Vec3& center, const Vec3& radii);

Box expandBox(const Box& box, double margin);
bool contains(const Box& box, const Vec3& point);

/// Shape with a box around it, in the world.
struct Solid {
  std::function<double(const Vec3&)> distance; ///< mm
  Box box;
};
Solid makeEllipsoid(const Vec3& center, const Vec3& radii);
/// Box around the origin with edges rounded by `radius`.
Solid makeBlock(const Vec3& halfSize, double radius);

/// Cross-section of a loft in the axial plane: an ellipse, or more square.
struct LoftSection {
  double z = 0.0;
  Vec2 center = Vec2::Zero();
  Vec2 radii = Vec2::Ones();
};
/// Solid through axial cross-sections, by rising z, at least two; centre and radii follow
/// Catmull-Rom curves of z. `squareness`: 0 (ellipse) to 1 (superellipse of exponent 4). The ends
/// are flat, rounded over `capBlend` mm.
Solid makeLoft(const std::vector<LoftSection>& sections, double squareness, double capBlend);

/// Point of a tube's axis, and the tube's radius there.
struct TubeNode {
  Vec3 point;
  double radius;
};
/// Tube along a Catmull-Rom curve through its nodes. `stretch` (each component at least 1) makes a
/// band: its cross-section is that many times wider along each axis.
Solid makeTube(const std::vector<TubeNode>& nodes, const Vec3& stretch = Vec3::Ones());

/// Map from the world to a shape's space with origin at `origin`, z along `axis`, y toward `up`,
/// and x along axis x up (mirrored: x is the lateral side of a right limb if axis is anterior and
/// up superior). Units stay mm.
Affine toShape(const Vec3& origin, const Vec3& axis, const Vec3& up);
/// Solid placed by the map to its own space.
Solid placeSolid(const Affine& toShape, const Solid& solid);

/// Solids blended as by smoothUnion and its like.
Solid unite(const Solid& a, const Solid& b, double blend);
Solid intersect(const Solid& a, const Solid& b, double blend);
Solid subtract(const Solid& solid, const Solid& removed, double blend);
/// `right` and its mirror image at the plane x = 0.
Solid mirrorPair(const Solid& right);

} // namespace fenestra
