#pragma once
// The kinds of light, as plain data. Directions and lengths are in world space (mm, RAS) or in the
// camera's frame; LightSet.h prepares lights for sampling.

#include "base/Vector.h"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

namespace fenestra {

/// Weight of a radiance in choices between lights and between texels.
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

/// Frame of a light's positions and directions. `camera`: x is right, y up, z toward the viewer,
/// the origin is the volume's centre, and lengths are in radii of its bounding sphere. `focus`: the
/// world's axes and mm, the origin is the centroid of the focus.
enum class LightFrame { world, camera, focus };

/// Radiance from every direction, by t, the cosine of the angle between the direction toward the
/// sky and `up`: linear in t from `middle` (t = 0) to `top` (t = 1) and to `bottom` (t = -1).
struct SkyLight {
  Rgb top = Rgb::Ones(), middle = Rgb::Ones(), bottom = Rgb::Ones();
  Vec3 up = Vec3::UnitY(); ///< unit
  LightFrame frame = LightFrame::camera;
};

/// Parallel light travelling along `direction`; `irradiance` on a plane facing the light.
struct DirectionalLight {
  Vec3 direction = -Vec3::UnitZ(); ///< unit
  Rgb irradiance = Rgb::Ones();
};

/// Emits from one side, along `normal`.
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

/// Ball of light. From outside its near half is seen, and emits outward; from inside it is light
/// from all around: a ray from anywhere takes `radiance` once, where it first meets the sphere.
struct SphereLight {
  Vec3 center = Vec3::Zero();
  double diameter = 1.0;
  Rgb radiance = Rgb::Ones();
  LightFrame frame = LightFrame::world;
};

using Light = std::variant<EnvironmentLight, DirectionalLight, AreaLight, SkyLight, SphereLight>;

} // namespace fenestra
