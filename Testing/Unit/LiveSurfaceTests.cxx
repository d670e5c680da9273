#include "clip/portable/LiveSurface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace fenestra::core::LiveSurfaceTests {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Box with these corners, mm, as triangles.
SurfaceTriangles makeBox(double lower, double upper) {
  SurfaceTriangles box;
  for (int i = 0; i < 8; ++i)
    for (int axis = 0; axis < 3; ++axis)
      box.points.push_back(static_cast<float>((i >> axis & 1) == 0 ? lower : upper));
  box.corners = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return box;
}

BoxCorners makeVolume(double lower, double upper) {
  BoxCorners corners;
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      corners[i][axis] = (i >> axis & 1U) == 0 ? lower : upper;
  return corners;
}

/// Camera 200 mm in front of the origin, which sees 100 mm in 100 rows of pixels there.
LiveCamera makeCamera(bool isPerspective) {
  return {{0, -200, 0}, {0, 0, 0}, {0, 0, 1}, isPerspective, 2.0 * std::atan(0.25) * 180.0 / M_PI,
          50.0,         120,       100};
}

float depthAt(const DepthMap& map, double x, double y) {
  const auto column = std::lround((x - map.grid.x) / map.grid.pitch);
  const auto row = std::lround((map.grid.y - y) / map.grid.pitch);
  if (column < 0 || row < 0 || column >= map.grid.columns || row >= map.grid.rows)
    return static_cast<float>(infinite);
  return map.depths[static_cast<std::size_t>(row * map.grid.columns + column)];
}

class LiveSurfaceOfABox : public ::testing::TestWithParam<bool> {
protected:
  LiveSurface build(double lower, double upper) const {
    return buildLiveSurface(ClosedSurface(makeBox(lower, upper)), makeVolume(-100, 100),
                            makeCamera(GetParam()));
  }
};

/// The front face is 190 mm away; in perspective, it appears 20/19 larger.
TEST_P(LiveSurfaceOfABox, ShowsItsFrontFace) {
  const LiveSurface surface = build(-10, 10);
  const double edge = GetParam() ? 10.0 * 200.0 / 190.0 : 10.0;
  for (double x = -14.5; x < 15.0; x += 1.0)
    for (double y = -14.5; y < 15.0; y += 1.0) {
      const bool isFocus = std::max(std::abs(x), std::abs(y)) < edge;
      const double depth = depthAt(surface.focus, x, y);
      EXPECT_EQ(std::isfinite(depth), isFocus) << x << " " << y;
      EXPECT_NEAR(isFocus ? depth : 190.0, 190.0, 1e-3) << x << " " << y;
    }
}

/// Beside the focus the surface starts near its depth and stays between its depths, everywhere in
/// the view and in the volume's image.
TEST_P(LiveSurfaceOfABox, ContinuesBesideIt) {
  const LiveSurface surface = build(-10, 10);
  EXPECT_NEAR(depthAt(surface.fill, 0.0, 13.0), 191.0, 3.0);
  for (const float depth : surface.fill.depths) {
    EXPECT_GT(depth, 185.0f);
    EXPECT_LT(depth, 215.0f);
  }
  EXPECT_TRUE(std::isfinite(depthAt(surface.fill, 99.0, -99.0)));
}

INSTANTIATE_TEST_SUITE_P(Projections, LiveSurfaceOfABox, ::testing::Values(false, true));

TEST(LiveSurface, IsEmptyWithoutFocusInView) {
  const LiveSurface surface =
      buildLiveSurface(ClosedSurface(SurfaceTriangles()), makeVolume(-100, 100), makeCamera(true));
  EXPECT_TRUE(surface.focus.depths.empty());
  EXPECT_TRUE(surface.fill.depths.empty());
}

TEST(LiveSurface, IsEmptyBehindTheCamera) {
  LiveCamera camera = makeCamera(true);
  camera.target = {0, -400, 0};
  const LiveSurface surface =
      buildLiveSurface(ClosedSurface(makeBox(-10, 10)), makeVolume(-100, 100), camera);
  EXPECT_TRUE(surface.fill.depths.empty());
}

/// A focus that reaches beyond the view on all sides covers it.
TEST(LiveSurface, FillsTheViewInCloseCameras) {
  LiveCamera camera = makeCamera(false);
  camera.scale = 5.0;
  const LiveSurface surface =
      buildLiveSurface(ClosedSurface(makeBox(-10, 10)), makeVolume(-100, 100), camera);
  EXPECT_EQ(surface.focus.depths.size(), 120u * 100u);
  for (const float depth : surface.focus.depths)
    EXPECT_NEAR(depth, 190.0, 1e-3);
}

TEST(LiveSurface, RefusesCamerasWithoutDirectionOrSize) {
  const ClosedSurface box(makeBox(-10, 10));
  const BoxCorners volume = makeVolume(-100, 100);
  LiveCamera camera = makeCamera(true);
  camera.target = camera.position;
  EXPECT_THROW(buildLiveSurface(box, volume, camera), std::invalid_argument);
  camera = makeCamera(true);
  camera.up = {0, 1, 0};
  EXPECT_THROW(buildLiveSurface(box, volume, camera), std::invalid_argument);
  camera = makeCamera(true);
  camera.height = 0;
  EXPECT_THROW(buildLiveSurface(box, volume, camera), std::invalid_argument);
}

} // namespace
} // namespace fenestra::core::LiveSurfaceTests
