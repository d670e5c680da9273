#pragma once
// Grids, masks and cameras for tests of the clipping surface.

#include "base/Random.h"
#include "clip/focus/FocusDepth.h"
#include "model/camera/Camera.h"
#include "model/volume/Mask.h"

#include <string>
#include <vector>

namespace fenestra::core::testing_clipping {

inline double uniform(Random& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

inline Vec3 randomPoint(Random& random, double low, double high) {
  return {uniform(random, low, high), uniform(random, low, high), uniform(random, low, high)};
}

/// Grid with voxels of `spacing` mm, centered at the world origin.
inline Grid makeCenteredGrid(const Size3& size, const Vec3& spacing = Vec3::Ones()) {
  Affine map = Affine::Identity();
  map.linear() = Mat3::Diagonal(spacing);
  map.translation() = -0.5 * spacing.cwiseProduct((size.array() - 1).cast<double>().matrix());
  return {size, map};
}

/// Mask of the voxels whose centers, world mm, satisfy the predicate.
template <typename Predicate>
Mask makeMask(const Grid& grid, const Predicate& predicate) {
  Mask mask;
  mask.grid = grid;
  mask.names = {"A"};
  for (std::int64_t z = 0; z < grid.size.z(); ++z)
    for (std::int64_t y = 0; y < grid.size.y(); ++y)
      for (std::int64_t x = 0; x < grid.size.x(); ++x) {
        const bool isInside = predicate(Vec3(grid.indexToWorld * Size3(x, y, z).cast<double>()));
        mask.voxels.push_back(isInside ? 1 : 0);
        mask.count += isInside ? 1 : 0;
      }
  return mask;
}

inline Mask makeBoxMask(const Grid& grid, const Vec3& lower, const Vec3& upper) {
  return makeMask(grid, [&](const Vec3& p) {
    return (p.array() >= lower.array()).all() && (p.array() <= upper.array()).all();
  });
}

inline Mask makeSphereMask(const Grid& grid, double radius) {
  return makeMask(grid, [&](const Vec3& p) { return p.norm() <= radius; });
}

/// Camera that looks at the origin from anterior, `distance` mm away (y grows with depth). `scale`:
/// half the visible height at the origin in both projections, mm.
inline Camera makeAnteriorCamera(Projection projection, double distance, double scale, int width,
                                 int height) {
  CameraPose pose;
  pose.projection = projection;
  pose.position = {0.0, -distance, 0.0};
  pose.target = Vec3::Zero();
  pose.scale = scale;
  pose.angle = 360.0 / pi * std::atan(scale / distance);
  return {pose, width, height};
}

/// Focus region drawn with '#': 1 mm per sample, depth = column + 10 row, mm. The buffer has
/// exactly the drawn samples.
inline FocusDepth makeFocusDepth(const std::vector<std::string>& rows) {
  const auto width = static_cast<int>(rows[0].size());
  const auto height = static_cast<int>(rows.size());
  const Camera camera =
      makeAnteriorCamera(Projection::orthographic, 100.0, 0.5 * height, width, height);
  FocusDepth focus{DepthBuffer(camera, makeCenteredGrid({1, 1, 1}, Vec3::Constant(1e-3))), {}};
  for (std::int64_t row = 0; row < height; ++row)
    for (std::int64_t column = 0; column < width; ++column) {
      const bool isInside =
          rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] == '#';
      focus.regions.push_back(isInside ? Region::focus : Region::context);
      if (isInside)
        focus.depth.set(focus.depth.sample(column, row), static_cast<double>(column + 10 * row));
    }
  return focus;
}

} // namespace fenestra::core::testing_clipping
