#pragma once
// Shapes as signed distance functions: mm, negative inside. Near the surface they are exact to
// first order or slightly too small. Blends: Quilez, "Smooth minimum" (polynomial, quadratic).

#include "base/Vector.h"

#include <functional>
#include <vector>

namespace fenestra::core {

/// Union, intersection and difference of two shapes, given by distances. They are blended where the
/// distances differ by less than `blend`, mm.
double smoothUnion(double a, double b, double blend);
double smoothIntersection(double a, double b, double blend);
double smoothDifference(double a, double b, double blend);

double ellipsoidDistance(const Vec3& point, const Vec3& center, const Vec3& radii);

inline Box expandBox(const Box& box, double margin) {
  return {box.lower.array() - margin, box.upper.array() + margin};
}
inline bool contains(const Box& box, const Vec3& point) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(point[axis] >= box.lower[axis] && point[axis] <= box.upper[axis]))
      return false;
  return true;
}

/// A shape with a bounding box, in the world.
struct Solid {
  std::function<double(const Vec3&)> distance; ///< mm
  Box box;
};
Solid makeEllipsoid(const Vec3& center, const Vec3& radii);
/// Box around the origin with edges rounded by `radius`.
Solid makeBlock(const Vec3& halfSize, double radius);

/// Cross-section of a loft in the axial plane: an ellipse or a superellipse.
struct LoftSection {
  double z = 0.0;
  Vec2 center = Vec2::Zero();
  Vec2 radii = Vec2::Ones();
};
/// Solid through at least two axial cross-sections, by increasing z; center and radii follow
/// Catmull-Rom curves of z. `squareness`: 0 (ellipse) to 1 (superellipse of exponent 4). The ends
/// are flat and rounded over `capBlend` mm.
Solid makeLoft(const std::vector<LoftSection>& sections, double squareness, double capBlend);

/// Point on a tube's axis, and the tube's radius there.
struct TubeNode {
  Vec3 point;
  double radius;
};
/// Tube along a Catmull-Rom curve through its nodes. `stretch` (each component at least 1) flattens
/// it into a band: the cross-section is that many times wider along each axis.
Solid makeTube(const std::vector<TubeNode>& nodes, const Vec3& stretch = Vec3::Ones());

/// Map from the world to a shape's space: origin at `origin`, z along `axis`, y toward `up`, x
/// along axis x up (mirrored: x is the lateral side of a right limb if axis is anterior and up
/// superior). Lengths are preserved.
Affine toShape(const Vec3& origin, const Vec3& axis, const Vec3& up);
/// Solid transformed to the world; `toShape` maps to its own space.
Solid placeSolid(const Affine& toShape, const Solid& solid);

/// Blended combinations of solids, as smoothUnion etc.
Solid unite(const Solid& a, const Solid& b, double blend);
Solid intersect(const Solid& a, const Solid& b, double blend);
Solid subtract(const Solid& solid, const Solid& removed, double blend);
/// Union of `right` and its mirror image at the plane x = 0.
Solid mirrorPair(const Solid& right);

} // namespace fenestra::core
