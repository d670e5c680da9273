#pragma once
// Light descriptions as plain data. Directions and lengths are in world space (mm, RAS) or in the
// camera's frame; LightSet.h prepares lights for sampling. Renderer/README.md says how to add a
// kind.

#include "base/Vector.h"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

namespace fenestra::core {

/// Scalar measure of a radiance for choosing between lights and between texels.
inline double brightness(const Rgb& radiance) {
  return radiance.maxCoeff();
}

/// Latitude-longitude radiance, row 0 superior, middle column anterior.
struct EnvironmentMap {
  int width = 0, height = 0;
  std::vector<float> rgb; ///< width * height * 3, row by row from the top
};

/// Radiance from every direction: a constant, times the map if present.
struct EnvironmentLight {
  Rgb radiance = Rgb::Ones();
  EnvironmentMap map = {}; ///< empty (width 0): constant
};

/// Frame of a light's positions and directions. `camera`: x is right, y up, z toward the camera;
/// the origin is the volume's center, and the unit is the radius of its bounding sphere. `focus`:
/// world axes and mm; the origin is the centroid of the focus.
enum class LightFrame { world, camera, focus };

/// Radiance from every direction as a function of t, the cosine of the angle between that direction
/// and `up`: linear in t from `middle` (t = 0) to `top` (t = 1) and to `bottom` (t = -1).
struct SkyLight {
  Rgb top = Rgb::Ones(), middle = Rgb::Ones(), bottom = Rgb::Ones();
  Vec3 up = Vec3::UnitY(); ///< unit
  LightFrame frame = LightFrame::camera;
};

/// Parallel light traveling along `direction`, with `irradiance` on a plane that faces the light.
struct DirectionalLight {
  Vec3 direction = -Vec3::UnitZ(); ///< unit
  Rgb irradiance = Rgb::Ones();
};

/// One-sided emitter: emits along `normal`.
struct AreaLight {
  enum class Shape { rectangle, disk };
  Shape shape = Shape::rectangle;
  Vec3 center = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ(); ///< unit
  Vec3 up = Vec3::UnitY();  ///< orients a rectangle's second edge; need not be orthogonal to normal
  Vec2 size = Vec2::Ones(); ///< full edges; disk: diameter in x
  Rgb radiance = Rgb::Ones();
  LightFrame frame = LightFrame::world;
};

/// Emitting sphere. From outside, the near half is visible and emits outward. From inside, light
/// arrives from all directions: every ray receives `radiance` once, at its first intersection.
struct SphereLight {
  Vec3 center = Vec3::Zero();
  double diameter = 1.0;
  Rgb radiance = Rgb::Ones();
  LightFrame frame = LightFrame::world;
};

using Light = std::variant<EnvironmentLight, DirectionalLight, AreaLight, SkyLight, SphereLight>;

} // namespace fenestra::core
