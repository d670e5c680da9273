// Depth buffer: positions and extent of its samples, interpolation, and clamping beyond them.

#include "ClippingTesting.h"
#include "base/Error.h"
#include "clip/field/DepthPyramid.h"

#include <gtest/gtest.h>

namespace fenestra::core::DepthBufferTests {
using namespace testing_clipping;

namespace {

constexpr std::int64_t maxSamples = 4 << 20;

TEST(DepthBuffer, SamplesAreAtPixelCentersOfTheViewport) {
  for (const auto projection : {Projection::orthographic, Projection::perspective}) {
    const Camera camera = makeAnteriorCamera(projection, 300.0, 20.0, 37, 22);
    const DepthBuffer buffer(camera, makeCenteredGrid({100, 100, 100}));
    EXPECT_GT(buffer.columns(), 37);
    for (int row = 0; row < 22; ++row)
      for (int column = 0; column < 37; ++column) {
        const Vec2 pixel = camera.toPlane(column + 0.5, row + 0.5);
        const std::int64_t sample = buffer.viewportSample(column, row);
        EXPECT_LT(
            (buffer.position(sample % buffer.columns(), sample / buffer.columns()) - pixel).norm(),
            1e-12);
      }
  }
}

TEST(DepthBuffer, SpansTheVolumesProjection) {
  const Grid grid = makeCenteredGrid({200, 300, 100});
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 500.0, 10.0, 64, 64);
  const DepthBuffer buffer(camera, grid);
  const double pixel = camera.pixelPitch();
  EXPECT_EQ(buffer.xAxis().factor, 1.0);
  EXPECT_NEAR(buffer.xAxis().coordinate(0), -100.0, pixel);
  EXPECT_NEAR(buffer.xAxis().coordinate(buffer.columns() - 1), 100.0, pixel);
  EXPECT_NEAR(buffer.yAxis().coordinate(0), 50.0, pixel);
  EXPECT_NEAR(buffer.yAxis().coordinate(buffer.rows() - 1), -50.0, pixel);
  EXPECT_LE(buffer.xAxis().coordinate(0), -100.0);
}

TEST(DepthBuffer, LargeVolumeIsCoarserBeyondTheViewport) {
  const Grid grid = makeCenteredGrid({500, 500, 500});
  for (const double scale : {10.0, 5.0, 0.01, 1e-6}) {
    const Camera camera = makeAnteriorCamera(Projection::orthographic, 1000.0, scale, 300, 200);
    const DepthBuffer buffer(camera, grid);
    EXPECT_LE(buffer.size(), maxSamples);
    EXPECT_GT(buffer.xAxis().factor, 1.0);
    EXPECT_EQ(buffer.xAxis().factor, std::floor(buffer.xAxis().factor));
    EXPECT_LE(buffer.xAxis().coordinate(0), -250.0 * (1 - 1e-12));
    EXPECT_GE(buffer.yAxis().coordinate(0), 250.0 * (1 - 1e-12));
  }
}

TEST(DepthBuffer, CoarseningFactorIsTheSmallestPossible) {
  const Grid grid = makeCenteredGrid({500, 500, 500});
  const auto factor = [&](double scale) {
    const Camera camera = makeAnteriorCamera(Projection::orthographic, 1000.0, scale, 300, 200);
    return DepthBuffer(camera, grid).xAxis().factor;
  };
  EXPECT_EQ(factor(40.0), 1.0); // 1250^2 samples
  EXPECT_EQ(factor(10.0), 3.0); // (300 + 4700 / 3) (200 + 4800 / 3), against (2650) (2600)
  EXPECT_EQ(factor(5.0), 6.0);  // (300 + 9700 / 6) (200 + 9800 / 6), against (2240) (2160)
}

TEST(DepthBuffer, PerspectiveReachesToSeventyFiveDegrees) {
  const Camera camera = makeAnteriorCamera(Projection::perspective, 30.0, 10.0, 64, 64);
  const DepthBuffer buffer(camera, makeCenteredGrid({100, 100, 100})); // the camera is inside
  const double limit = 30.0 * std::tan(75.0 * pi / 180.0);
  const double sample = buffer.xAxis().factor * camera.pixelPitch();
  EXPECT_NEAR(buffer.xAxis().coordinate(0), -limit, sample);
  EXPECT_NEAR(buffer.yAxis().coordinate(buffer.rows() - 1), -limit, sample);
}

TEST(DepthBuffer, IndexAndCoordinateAreInverse) {
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 1000.0, 5.0, 300, 200);
  const DepthBuffer buffer(camera, makeCenteredGrid({500, 500, 500}));
  for (const DepthAxis* axis : {&buffer.xAxis(), &buffer.yAxis()})
    for (std::int64_t i = 0; i < axis->size(); ++i) {
      EXPECT_NEAR(axis->index(axis->coordinate(i)), static_cast<double>(i), 1e-9);
    }
  EXPECT_EQ(buffer.xAxis().index(-1e9), 0.0);
  EXPECT_EQ(buffer.xAxis().index(infinity), static_cast<double>(buffer.columns() - 1));
  EXPECT_EQ(buffer.xAxis().index(std::nan("")), static_cast<double>(buffer.columns() - 1));
}

TEST(DepthBuffer, InterpolatesLinearFunctionsExactlyAcrossBothDensities) {
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 1e5, 5.0, 300, 200);
  DepthBuffer buffer(camera, makeCenteredGrid({500, 500, 500}));
  ASSERT_GT(buffer.xAxis().factor, 1.0);
  const auto plane = [](const Vec2& p) { return 1e5 + 0.25 * p.x() - 0.5 * p.y(); };
  for (std::int64_t row = 0; row < buffer.rows(); ++row)
    for (std::int64_t column = 0; column < buffer.columns(); ++column)
      buffer.set(buffer.sample(column, row), plane(buffer.position(column, row)));
  Random random(1, 0, 0);
  for (int i = 0; i < 100000; ++i) {
    const Vec2 p = randomPoint(random, i % 2 ? -250 : -7, i % 2 ? 250 : 7).head<2>();
    EXPECT_NEAR(buffer.depth(p), plane(p), 2e-5);
  }
  EXPECT_NEAR(buffer.depth({1e6, 0.0}), plane({250.0, 0.0}), 0.1); // clamped to the edge
}

TEST(DepthBuffer, NearestReturnsTheSampleOfThePixel) {
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 100.0, 4.0, 8, 8);
  DepthBuffer buffer(camera, makeCenteredGrid({2, 2, 2}));
  for (std::int64_t i = 0; i < buffer.size(); ++i)
    buffer.set(i, static_cast<double>(i));
  EXPECT_EQ(buffer.nearestDepth({-3.9, 3.9}), 0.0);
  EXPECT_EQ(buffer.nearestDepth({-2.1, 3.1}), 1.0);
  EXPECT_EQ(buffer.nearestDepth({-2.1, 2.9}), 9.0);
  EXPECT_EQ(buffer.nearestDepth({99.0, -99.0}), 63.0);
}

TEST(DepthBuffer, RejectsAnImageWithoutExtent) {
  const Grid grid = makeCenteredGrid({2, 2, 2});
  for (const double scale : {0.0, -1.0, 1e-30, infinity, std::nan("")}) {
    EXPECT_THROW(
        DepthBuffer(makeAnteriorCamera(Projection::orthographic, 100.0, scale, 8, 8), grid), Error);
  }
}

TEST(DepthBuffer, ViewportBeyondTheLimitKeepsItsPixels) {
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 100.0, 0.5, 1, 5000000);
  const DepthBuffer buffer(camera, makeCenteredGrid({2, 2, 2}));
  EXPECT_EQ(buffer.xAxis().inside, 1);
  EXPECT_EQ(buffer.yAxis().inside, 5000000);
  EXPECT_LE(buffer.size(), 3 * 5000002);
}

TEST(DepthPyramid, BoundsHoldForEveryDepthInARectangle) {
  Random random(2, 0, 0);
  for (const auto& [width, height] : {std::pair{1, 1}, {5, 1}, {33, 17}, {64, 64}}) {
    const Camera camera = makeAnteriorCamera(Projection::orthographic, 100.0, 8.0, width, height);
    DepthBuffer buffer(camera, makeCenteredGrid({20, 20, 20}));
    for (std::int64_t i = 0; i < buffer.size(); ++i)
      buffer.set(i, uniform(random, 50, 150));
    const DepthPyramid pyramid(buffer);
    double minimum = infinity, maximum = -infinity;
    for (std::int64_t i = 0; i < buffer.size(); ++i) {
      minimum = std::min(minimum, buffer.at(i));
      maximum = std::max(maximum, buffer.at(i));
    }
    const auto fullRange =
        pyramid.bounds(buffer, Vec2::Constant(-infinity), Vec2::Constant(infinity));
    EXPECT_EQ(fullRange.begin, minimum);
    EXPECT_EQ(fullRange.end, maximum);
    for (int trial = 0; trial < 2000; ++trial) {
      const Vec2 a = randomPoint(random, -15, 15).head<2>();
      const Vec2 b = a + std::pow(random.uniform(), 3) * randomPoint(random, -15, 15).head<2>();
      const Interval bounds = pyramid.bounds(buffer, a, b);
      for (int i = 0; i < 50; ++i) {
        const Vec2 p(uniform(random, a.x(), b.x()), uniform(random, a.y(), b.y()));
        ASSERT_LE(bounds.begin, buffer.depth(p) + 1e-9);
        ASSERT_LE(bounds.begin, buffer.nearestDepth(p));
        ASSERT_GE(bounds.end, buffer.depth(p) - 1e-9);
        ASSERT_GE(bounds.end, buffer.nearestDepth(p));
      }
    }
  }
}

TEST(DepthPyramid, BoundsAreTightOnASmallRectangle) {
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 100.0, 32.0, 64, 64);
  DepthBuffer buffer(camera, makeCenteredGrid({20, 20, 20}));
  for (std::int64_t i = 0; i < buffer.size(); ++i)
    buffer.set(i, 100.0 + buffer.position(i % 64, i / 64).x());
  const DepthPyramid pyramid(buffer);
  for (double x = -20.0; x < 20.0; x += 0.7) {
    const auto [minimum, maximum] = pyramid.bounds(buffer, {x, 0.0}, {x + 2.0, 2.0});
    EXPECT_GT(minimum, 100.0 + x - 5.0);
    EXPECT_LT(maximum, 102.0 + x + 5.0);
  }
}

} // namespace
} // namespace fenestra::core::DepthBufferTests
