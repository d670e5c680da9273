// Clipping surface on a turntable: metrics of its change, and temporal smoothing.

#include "Approx.h"
#include "ClippingTesting.h"
#include "clip/surface/SteadySurface.h"
#include "metrics/SurfaceChange.h"

#include <gtest/gtest.h>

namespace fenestra::core::SurfaceChangeTests {
using namespace testing_clipping;

namespace {

TEST(RotateAroundTarget, IsCounterClockwiseSeenFromAbove) {
  CameraPose pose;
  pose.target = {1, 2, 3};
  pose.position = {1, 102, 43}; // anterior, and above
  pose.up = {0, 0, 2};
  EXPECT_TRUE(isApprox(rotateAroundTarget(pose, 90.0).position, Vec3(-99, 2, 43)));
  EXPECT_TRUE(isApprox(rotateAroundTarget(pose, -180.0).position, Vec3(1, -98, 43)));
  EXPECT_EQ(rotateAroundTarget(pose, 0.0).position, pose.position);
  EXPECT_EQ(rotateAroundTarget(pose, 77.0).target, pose.target);
  EXPECT_EQ(rotateAroundTarget(pose, 77.0).up, pose.up);
}

/// Image of 4 x 4 pixels of 1 mm; the surface is flat at the target's depth, all of it context.
VisibleSurface makeLevelSurface() {
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 100.0, 2.0, 4, 4);
  return {camera, std::vector<Region>(16, Region::context), std::vector<double>(16, 100.0)};
}

TEST(SurfaceChange, IsPerDegreeOverPixelsThatStayContext) {
  VisibleSurface before = makeLevelSurface(), after = makeLevelSurface();
  for (std::size_t pixel = 0; pixel < 16; ++pixel)
    after.depths[pixel] += pixel < 4 ? 3.0 : -1.0;
  before.regions[4] = Region::focus;
  after.regions[5] = Region::outside;
  after.depths[4] = after.depths[5] = 1e6; // must be ignored
  const SurfaceChange change = measureChange(before, after, Vec3::UnitZ(), -2.0);
  EXPECT_DOUBLE_EQ(change.mean, (4 * 1.5 + 10 * 0.5) / 14.0);
  EXPECT_DOUBLE_EQ(change.p95, 1.5);
  EXPECT_DOUBLE_EQ(change.max, 1.5);
}

TEST(SurfaceChange, ExcessIsRelativeToTheSpeedOfTheFocus) {
  VisibleSurface before = makeLevelSurface(), after = makeLevelSurface();
  after.regions[3] = Region::focus; // the top right pixel, 1.5 mm right of and above the center,
  after.depths[3] = 98.0;           // and 2 mm closer to the camera: 2.5 mm from the axis
  after.depths[8] = 101.0;
  const SurfaceChange change = measureChange(before, after, Vec3(0, 0, 7), 1.0);
  EXPECT_NEAR(change.focus, 2.5 * pi / 180.0, 1e-12);
  EXPECT_DOUBLE_EQ(change.max, 1.0);
  EXPECT_DOUBLE_EQ(change.excess(), 1.0 - change.focus);
  EXPECT_EQ(measureChange(before, before, Vec3::UnitZ(), 1.0).excess(), 0.0);
  EXPECT_EQ(measureChange(before, before, Vec3::UnitZ(), 1.0).focus, 0.0) << "no visible focus";
}

/// Balls of 7 and 5 mm in a block that appear from behind each other as the camera orbits them.
class RotatedBalls : public ::testing::Test {
protected:
  const Grid grid = makeCenteredGrid({80, 80, 40});
  const Mask balls = makeMask(grid, [](const Vec3& p) {
    return (p - Vec3(0, -14, 0)).norm() <= 7.0 || (p - Vec3(0, 16, 4)).norm() <= 5.0;
  });
  SurfaceOptions options{.boundary = Boundary::exact};

  static Camera makeCamera(double degrees) {
    const Camera first = makeAnteriorCamera(Projection::orthographic, 200.0, 30.0, 60, 60);
    return {rotateAroundTarget(first.pose(), degrees), 60, 60};
  }
  ClippingSurface makeSurface(double degrees, double steady) const {
    return buildSteadySurface(makeCamera(degrees), grid, balls, options, steady);
  }
  VisibleSurface makeVisible(double degrees, double steady) const {
    const ClippingSurface surface = makeSurface(degrees, steady);
    std::vector<double> focus;
    for (int row = 0; row < 60; ++row)
      for (int column = 0; column < 60; ++column)
        focus.push_back(surface.focus.depth.at(surface.focus.depth.viewportSample(column, row)));
    return makeVisibleSurface(std::get<ClipDepth>(surface.clip), focus, grid);
  }
  double findMaxP95(double steady) const {
    constexpr double step = 4.0;
    double maximum = 0.0;
    VisibleSurface before = makeVisible(0.0, steady);
    for (double degrees = step; degrees <= 40.0; degrees += step) {
      VisibleSurface after = makeVisible(degrees, steady);
      maximum = std::max(maximum, measureChange(before, after, Vec3::UnitZ(), step).p95);
      before = std::move(after);
    }
    return maximum;
  }
};

TEST_F(RotatedBalls, VisibleDepthsAreThoseOfTheSurface) {
  const VisibleSurface visible = makeVisible(0.0, 0.0);
  // The front of the near ball is at the image center; there is no focus near the left edge.
  EXPECT_EQ(visible.regions[30 * 60 + 30], Region::focus);
  EXPECT_NEAR(visible.depths[30 * 60 + 30], 200.0 - 14.0 - 7.0, 0.5);
  EXPECT_EQ(visible.regions[30 * 60 + 2], Region::context);
}

TEST_F(RotatedBalls, SurfaceIsUnchangedWithoutSmoothing) {
  const auto depths = [&](double steady, SurfaceMode mode) {
    options.mode = mode;
    return std::get<ClipDepth>(makeSurface(20.0, steady).clip).buffer->depthsFromReference();
  };
  options.mode = SurfaceMode::surface;
  EXPECT_EQ(depths(0.0, SurfaceMode::surface),
            std::get<ClipDepth>(buildClippingSurface(makeCamera(20.0), grid, balls, options).clip)
                .buffer->depthsFromReference());
  EXPECT_EQ(depths(8.0, SurfaceMode::cutaway), depths(0.0, SurfaceMode::cutaway));
  EXPECT_NE(depths(8.0, SurfaceMode::surface), depths(0.0, SurfaceMode::surface));
}

TEST_F(RotatedBalls, SmoothedSurfaceMeetsTheFocus) {
  const ClippingSurface plain = makeSurface(20.0, 0.0), steady = makeSurface(20.0, 8.0);
  const DepthBuffer& a = *std::get<ClipDepth>(plain.clip).buffer;
  const DepthBuffer& b = *std::get<ClipDepth>(steady.clip).buffer;
  int adjacentCount = 0;
  for (std::int64_t row = 0; row < a.rows(); ++row)
    for (std::int64_t column = 0; column < a.columns(); ++column) {
      const double difference = std::abs(a.at(a.sample(column, row)) - b.at(b.sample(column, row)));
      if (plain.focus.isFocus(column, row)) {
        EXPECT_EQ(difference, 0.0);
      } else if (plain.focus.isFocus(column - 1, row) || plain.focus.isFocus(column + 1, row)) {
        EXPECT_LT(difference, 0.25) << "one sample of the blend over 8 mm";
        ++adjacentCount;
      }
    }
  EXPECT_GT(adjacentCount, 20);
}

TEST_F(RotatedBalls, SmoothedSurfaceChangesMoreSlowly) {
  const double unsmoothed = findMaxP95(0.0), steady = findMaxP95(8.0);
  EXPECT_LT(steady, 0.6 * unsmoothed) << unsmoothed << " mm per degree";
}

} // namespace
} // namespace fenestra::core::SurfaceChangeTests
