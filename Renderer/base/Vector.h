#pragma once
// Types shared by all folders: points and directions, colors, rays, intervals, boxes.
// Spaces are named where a value is declared: "world" is RAS in mm, "index" counts voxels (voxel
// centers at integers), "view" is defined in model/camera/Camera.h. Files in LPS are converted to
// RAS when they are read.

#include "base/Affine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fenestra::core {

using Vec2 = Vector<double, 2>;
using Size3 = Vector<std::int64_t, 3>;

/// Linear Rec. 709 red, green, blue; unbounded.
using Rgb = Array<double, 3>;

inline constexpr double pi = std::numbers::pi;
inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Range [begin, end] of a ray's parameter; empty if end <= begin or either is NaN.
struct Interval {
  double begin = 0.0;
  double end = infinity;

  bool isEmpty() const { return !(begin < end); }
};

/// Shortest interval that contains both; {infinity, -infinity} is the neutral element.
inline Interval enclose(const Interval& a, const Interval& b) {
  return {std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

/// Smooth step from 0 at `low` to 1 at `high`; falling if low > high.
inline double smoothStep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// origin + t * direction. In world space the direction is a unit vector, so t is in mm; mapped
/// into index space the direction is scaled so that t stays in world mm.
struct Ray {
  Vec3 origin = Vec3::Zero();
  Vec3 direction = Vec3::UnitZ();

  Vec3 at(double t) const { return origin + t * direction; }
};

inline Ray transformRay(const Affine& map, const Ray& ray) {
  return {map * ray.origin, map.linear() * ray.direction};
}

/// An axis-aligned box.
struct Box {
  Vec3 lower = Vec3::Zero();
  Vec3 upper = Vec3::Zero();

  bool operator==(const Box&) const = default;

  /// Contains no point; grows by extend().
  static Box makeEmpty() { return {Vec3::Constant(infinity), Vec3::Constant(-infinity)}; }
  void extend(const Vec3& point) {
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }

  Vec3 center() const { return 0.5 * (lower + upper); }
  Vec3 corner(int i) const {
    return {i & 1 ? upper.x() : lower.x(), i & 2 ? upper.y() : lower.y(),
            i & 4 ? upper.z() : lower.z()};
  }

  /// The part of `range` in which the ray is inside the box (slab test). Direction components may
  /// be zero; a ray exactly in a face counts as inside.
  Interval clip(const Ray& ray, Interval range = {}) const {
    for (int axis = 0; axis < 3; ++axis) {
      const double d = ray.direction[axis];
      const double o = ray.origin[axis];
      if (d == 0.0) {
        if (o < lower[axis] || o > upper[axis])
          return {0.0, 0.0};
        continue;
      }
      const double t0 = (lower[axis] - o) / d;
      const double t1 = (upper[axis] - o) / d;
      range.begin = std::max(range.begin, std::min(t0, t1));
      range.end = std::min(range.end, std::max(t0, t1));
    }
    return range;
  }
};

/// A right-handed orthonormal frame around a unit normal (Duff et al. 2017, "Building an
/// Orthonormal Basis, Revisited").
struct Frame {
  Vec3 tangent, bitangent, normal;

  explicit Frame(const Vec3& n) : normal(n) {
    const double sign = std::copysign(1.0, n.z());
    const double a = -1.0 / (sign + n.z());
    const double b = n.x() * n.y() * a;
    tangent = {1.0 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()};
    bitangent = {b, sign + n.y() * n.y() * a, -n.y()};
  }

  Vec3 toWorld(const Vec3& v) const { return v.x() * tangent + v.y() * bitangent + v.z() * normal; }
  Vec3 toLocal(const Vec3& v) const { return {v.dot(tangent), v.dot(bitangent), v.dot(normal)}; }
};

} // namespace fenestra::core
