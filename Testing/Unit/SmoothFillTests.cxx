// Continuation of the exact boundary compared with known solutions: constants, a straight edge, and
// depth jumps; and its dependence on the pitch.

#include "ClippingTesting.h"
#include "clip/portable/SmoothFill.h"
#include "clip/surface/BufferFill.h"

#include <gtest/gtest.h>

#include <functional>

namespace fenestra::core::SmoothFillTests {
using namespace testing_clipping;

namespace {

/// Depth buffer of 100 mm with given depths at its focus samples.
struct Sheet {
  Camera camera;
  DepthBuffer buffer;
  std::vector<Region> regions;

  using Depth = std::function<std::optional<double>(const Vec2&)>;

  Sheet(int pixels, const Depth& focus, double width = 100.0)
      : camera(makeAnteriorCamera(Projection::orthographic, 300.0, 0.5 * width, pixels, pixels)),
        buffer(camera, makeCenteredGrid({100, 100, 100})),
        regions(static_cast<std::size_t>(buffer.size()), Region::context) {
    for (std::int64_t sample = 0; sample < buffer.size(); ++sample)
      if (const auto depth = focus(position(sample))) {
        buffer.set(sample, *depth);
        regions[static_cast<std::size_t>(sample)] = Region::focus;
      }
  }

  Vec2 position(std::int64_t sample) const {
    return buffer.position(sample % buffer.columns(), sample / buffer.columns());
  }
  bool isFocus(std::int64_t sample) const {
    return regions[static_cast<std::size_t>(sample)] == Region::focus;
  }
};

TEST(SmoothFill, ConstantDepthContinuesAsConstant) {
  Sheet sheet(200,
              [](const Vec2& x) { return x.norm() < 20.0 ? std::optional(290.0) : std::nullopt; });
  fillSmoothly(sheet.buffer, sheet.regions, {}, 10.0);
  for (std::int64_t sample = 0; sample < sheet.buffer.size(); ++sample)
    EXPECT_NEAR(sheet.buffer.at(sample), 290.0, 1e-4);
}

/// Along a straight edge of constant depth, the far surface solves u'''' = u'' / length^2 with its
/// slope at the edge and the slope 0 at the buffer's end; the near surface is slope * x * exp(-x /
/// d) at the distance x.
class StraightEdge : public ::testing::TestWithParam<std::pair<double, double>> {};

TEST_P(StraightEdge, FillHasTheSlopeAndLevelsOff) {
  const auto [slope, length] = GetParam();
  const double reach = nearFraction * length;
  for (const int pixels : {64, 128, 256, 512}) {
    Sheet sheet(pixels, [slope = slope](const Vec2& x) {
      return x.x() < -20.0 ? std::optional(300.0 + slope * (x.x() + 20.0)) : std::nullopt;
    });
    double edge = -100.0, end = 0.0; // positions of the last samples of the focus and the buffer
    for (std::int64_t column = 0; column < sheet.buffer.columns(); ++column)
      (sheet.isFocus(column) ? edge : end) = sheet.position(column).x();
    const double range = (end - edge) / length;
    fillSmoothly(sheet.buffer, sheet.regions, {}, length);
    const double farSlope = std::clamp(slope, -maxFarSlope, maxFarSlope);
    const double nearSlope = std::clamp(slope - farSlope, -maxNearSlope, maxNearSlope);
    double worst = 0.0;
    for (std::int64_t sample = 0; sample < sheet.buffer.size(); ++sample) {
      const double x = sheet.position(sample).x() - edge;
      const double far =
          farSlope * length * (std::cosh(range) - std::cosh(range - x / length)) / std::sinh(range);
      const double expected =
          300.0 + slope * (edge + 20.0) + far + nearSlope * x * std::exp(-x / reach);
      if (!sheet.isFocus(sample))
        worst = std::max(worst, std::abs(sheet.buffer.at(sample) - expected));
    }
    // Samples farther apart than the reach do not resolve the near surface.
    const double pitch = sheet.camera.pixelPitch();
    const double clampedSlope = std::clamp(slope, -1.0, 1.0);
    EXPECT_LT(worst, 0.08 * std::abs(clampedSlope) * length + 0.01 * pitch) << pixels;
    EXPECT_LT(worst, 0.1 * (reach + pitch)) << pixels;
  }
}

INSTANTIATE_TEST_SUITE_P(Slopes, StraightEdge,
                         ::testing::Values(std::pair{0.5, 5.0}, std::pair{-0.9, 10.0},
                                           std::pair{7.0, 10.0}, std::pair{0.2, 20.0}));

TEST(SmoothFill, ContinuesTheSlopeOfACurvedBoundary) {
  Sheet sheet(512, [](const Vec2& x) {
    return x.norm() < 20.0 ? std::optional(300.0 + 0.01 * x.squaredNorm()) : std::nullopt;
  });
  fillSmoothly(sheet.buffer, sheet.regions, {}, 10.0);
  const double pitch = sheet.camera.pixelPitch();
  for (std::int64_t sample = 0; sample < sheet.buffer.size(); ++sample) {
    const double r = sheet.position(sample).norm();
    if (!sheet.isFocus(sample) && r < 20.0 + 3.0 * pitch) {
      const double x = r - 20.0;
      EXPECT_NEAR(sheet.buffer.at(sample), 304.0 + 0.4 * x * std::exp(-x / 2.5), 0.05) << r;
    }
  }
}

/// A wavy bowl in front of a deeper plane: the slopes of single samples at the boundary are steep
/// and of either sign, and its depth jumps where the two cross.
std::optional<double> findBowlDepth(const Vec2& x) {
  if (x.norm() < 20.0)
    return 300.0 + 0.01 * x.squaredNorm() + std::sin(2.1 * x.x()) * std::cos(1.7 * x.y());
  if ((x - Vec2(25.0, 5.0)).norm() < 12.0)
    return 325.0 + 0.2 * x.x();
  return std::nullopt;
}

TEST(SmoothFill, HardlyDependsOnThePitch) {
  Sheet fine(512, findBowlDepth);
  fillSmoothly(fine.buffer, fine.regions, {}, 10.0);
  const auto interpolate = [&](const Vec2& at) { // mean of the four samples around the position
    const auto column = static_cast<std::int64_t>(fine.buffer.xAxis().index(at.x()));
    const auto row = static_cast<std::int64_t>(fine.buffer.yAxis().index(at.y()));
    double sum = 0.0;
    for (const std::int64_t c : {column, column + 1})
      for (const std::int64_t r : {row, row + 1})
        sum += 0.25 * fine.buffer.at(fine.buffer.sample(c, r));
    return sum;
  };
  for (const int pixels : {64, 128, 256}) {
    Sheet coarse(pixels, findBowlDepth);
    fillSmoothly(coarse.buffer, coarse.regions, {}, 10.0);
    double sum = 0.0, count = 0.0;
    for (std::int64_t sample = 0; sample < coarse.buffer.size(); ++sample)
      if (const Vec2 at = coarse.position(sample);
          !coarse.isFocus(sample) && at.cwiseAbs().maxCoeff() < 49.0) {
        sum += std::abs(coarse.buffer.at(sample) - interpolate(at));
        count += 1.0;
      }
    EXPECT_LT(sum / count, 0.4 * coarse.camera.pixelPitch()) << pixels;
  }
}

TEST(SmoothFill, DepthJumpDoesNotOvershoot) {
  Sheet sheet(256, [](const Vec2& x) -> std::optional<double> {
    if (x.norm() >= 20.0)
      return std::nullopt;
    return x.y() < 0.0 ? 270.0 : 330.0;
  });
  fillSmoothly(sheet.buffer, sheet.regions, {}, 10.0);
  for (std::int64_t sample = 0; sample < sheet.buffer.size(); ++sample) {
    EXPECT_GT(sheet.buffer.at(sample), 270.0 - 6.0);
    EXPECT_LT(sheet.buffer.at(sample), 330.0 + 6.0);
  }
}

/// A jump is as steep as the samples beside the boundary, and flattens with distance from it.
TEST(SmoothFill, JumpFlattensWithDistance) {
  Sheet sheet(256, [](const Vec2& x) -> std::optional<double> {
    if (std::abs(x.x()) >= 20.0)
      return std::nullopt;
    return x.y() < 0.0 ? 270.0 : 330.0;
  });
  fillSmoothly(sheet.buffer, sheet.regions, {}, 10.0);
  const auto findMaxStep = [&](double x) {
    const auto column = static_cast<std::int64_t>(std::ceil(sheet.buffer.xAxis().index(x)));
    double maximum = 0.0;
    for (std::int64_t row = 1; row < sheet.buffer.rows(); ++row)
      maximum = std::max(maximum, std::abs(sheet.buffer.at(sheet.buffer.sample(column, row)) -
                                           sheet.buffer.at(sheet.buffer.sample(column, row - 1))));
    return maximum;
  };
  EXPECT_NEAR(findMaxStep(19.0), 60.0, 1e-3);
  EXPECT_GT(findMaxStep(20.2), 10.0);
  EXPECT_LT(findMaxStep(22.0), 15.0);
  EXPECT_LT(findMaxStep(25.0), 6.0);
  EXPECT_LT(findMaxStep(30.0), 0.7 * findMaxStep(25.0));
}

/// Samples outside a small viewport are coarser; a buffer may be a single column or row.
TEST(SmoothFill, FillsBuffersOfAnyShape) {
  for (const double width : {100.0, 30.0})
    for (const int pixels : {1, 2, 33, 100}) {
      Sheet sheet(
          pixels, [](const Vec2& x) { return std::optional(280.0 + 0.5 * x.x()); }, width);
      std::int64_t contextCount = 0;
      for (std::int64_t sample = 0; sample < sheet.buffer.size(); ++sample)
        if (sheet.position(sample).norm() > 0.3 * width && sample > 0) {
          sheet.regions[static_cast<std::size_t>(sample)] = Region::context;
          sheet.buffer.set(sample, infinity);
          ++contextCount;
        }
      fillSmoothly(sheet.buffer, sheet.regions, {}, 5.0);
      for (std::int64_t sample = 0; sample < sheet.buffer.size(); ++sample)
        ASSERT_NEAR(sheet.buffer.at(sample), 280.0, 60.0)
            << width << ' ' << pixels << ' ' << contextCount;
    }
}

} // namespace
} // namespace fenestra::core::SmoothFillTests
