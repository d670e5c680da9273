// Margins and smoothing of masks, tested on balls and slabs.

#include "ClippingTesting.h"
#include "base/Error.h"
#include "clip/focus/FocusDepth.h"
#include "files/segments/SegmentationReader.h"
#include "model/masks/EqualVolume.h"

#include <gtest/gtest.h>

namespace fenestra::core::MaskShapingTests {
using namespace testing_clipping;

namespace {

const Grid volume = makeCenteredGrid({61, 61, 41}, {1.0, 1.0, 1.5});

/// Mask of a ball, cropped like the masks that readers return.
Mask makeBall(double radius) {
  return makeMask(makeCenteredGrid({33, 33, 25}, {1.0, 1.0, 1.5}),
                  [&](const Vec3& p) { return p.norm() <= radius; });
}

double computeVolume(const Mask& mask) {
  return static_cast<double>(mask.count) * mask.grid.spacing().prod();
}

double computeBallVolume(double radius) {
  return 4.0 / 3.0 * pi * radius * radius * radius;
}

TEST(MaskShaping, BallGrowsByItsMargin) {
  for (const double margin : {1.5, 4.0, 9.0}) {
    const Mask grownBall = applyMargin(makeBall(10.0), margin, volume);
    // Distances are between voxel centers, so the radius is uncertain by half a voxel.
    EXPECT_GT(computeVolume(grownBall), computeBallVolume(10.0 + margin - 0.7));
    EXPECT_LT(computeVolume(grownBall), computeBallVolume(10.0 + margin + 0.5));
    EXPECT_LT(grownBall.grid.worldCenter().norm(), 1e-9);
  }
}

TEST(MaskShaping, BallShrinksByItsMargin) {
  const Mask shrunk = applyMargin(makeBall(10.0), -3.0, volume);
  EXPECT_GT(computeVolume(shrunk), computeBallVolume(10.0 - 3.0 - 1.0));
  EXPECT_LT(computeVolume(shrunk), computeBallVolume(10.0 - 3.0 + 0.7));
  EXPECT_EQ(applyMargin(makeBall(10.0), -30.0, volume).count, 0);
}

TEST(MaskShaping, LargeMarginExtendsAtMostTwoVoxelsBeyondVolume) {
  const Mask all = applyMargin(makeBall(10.0), 1000.0, volume);
  EXPECT_TRUE((all.grid.size.array() <= volume.size.array() + 4).all());
  EXPECT_EQ(all.count, all.grid.voxelCount());
}

TEST(MaskShaping, ShrinkingPreservesFocusAtVolumeFaces) {
  // The focus reaches both faces along x, so it is assumed to continue beyond them.
  const Mask slab = makeMask(makeCenteredGrid({61, 21, 21}), [](const Vec3& p) {
    return std::abs(p.y()) < 6.5 && std::abs(p.z()) < 6.5;
  });
  const Mask shrunk = applyMargin(slab, -2.0, volume);
  EXPECT_EQ(shrunk.count, 61 * 9 * 9);
}

TEST(MaskShaping, UnionCountsVoxelsOfBothMasks) {
  const auto box = [](const Vec3& lower, const Vec3& upper) {
    const Grid grid = makeCenteredGrid({40, 40, 40});
    return makeBoxMask(grid, lower, upper);
  };
  const Mask a = applyMargin(box({-10, -10, -10}, {-5, -5, -5}), 1.0, volume);
  const Mask b = box({5, 5, 5}, {9, 9, 9});
  const Mask both = uniteMasks({a, b});
  EXPECT_EQ(both.count, a.count + b.count);
  EXPECT_EQ(both.names.size(), 2U);
  EXPECT_EQ(uniteMasks({a, a}).count, a.count);
}

/// Also if their grids are cropped to them, as readers do.
TEST(MaskShaping, AdjacentMasksHaveAVoxelOrAFaceInCommon) {
  const auto makeCroppedBox = [](const Vec3& lower, const Vec3& upper) { // voxels at whole numbers
    const Size3 size = (upper - lower).array().round().cast<std::int64_t>() + 1;
    Affine indexToWorld = Affine::Identity();
    indexToWorld.translation() = lower;
    return makeBoxMask({size, indexToWorld}, lower, upper);
  };
  const Grid grid = makeCenteredGrid({41, 41, 41}); // voxels at whole numbers
  const Vec3 first(-10, -10, -10), last(-5, -6, -7);
  const auto isAdjacent = [&](const Vec3& lower, const Vec3& upper) {
    const Mask a = makeBoxMask(grid, first, last), b = makeBoxMask(grid, lower, upper);
    const Mask croppedA = makeCroppedBox(first, last), croppedB = makeCroppedBox(lower, upper);
    EXPECT_EQ(croppedB.count, b.count);
    EXPECT_EQ(croppedB.count, croppedB.grid.voxelCount());
    const bool result = areAdjacent(a, b);
    for (const auto& [one, other] : {std::pair(&a, &b), std::pair(&a, &croppedB),
                                     std::pair(&croppedA, &b), std::pair(&croppedA, &croppedB)}) {
      EXPECT_EQ(areAdjacent(*one, *other), result);
      EXPECT_EQ(areAdjacent(*other, *one), result);
    }
    return result;
  };
  EXPECT_TRUE(isAdjacent({-7, -7, -7}, {2, 2, 2}));
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 lower(-7, -7, -7), upper(2, 2, 2);
    lower[axis] = last[axis] + 1.0;
    EXPECT_TRUE(isAdjacent(lower, upper)) << "face of axis " << axis;
    Vec3 edge = lower;
    edge[(axis + 1) % 3] = last[(axis + 1) % 3] + 1.0;
    EXPECT_FALSE(isAdjacent(edge, upper)) << "edge of axis " << axis;
    lower[axis] += 1.0;
    EXPECT_FALSE(isAdjacent(lower, upper)) << "one voxel apart along axis " << axis;
    upper[axis] = 15.0;
    lower[axis] = 12.0;
    EXPECT_FALSE(isAdjacent(lower, upper)) << "far apart along axis " << axis;
  }
}

/// Step height, mm: range of distances from the visible surface's center to a sphere of `radius`.
double measureStepHeight(const Mask& mask, double radius) {
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 100, 20, 128, 128);
  const FocusDepth focus = FocusTracer(camera, volume, mask).traceDepths();
  std::vector<double> distances;
  for (std::int64_t row = 0; row < focus.depth.rows(); ++row)
    for (std::int64_t column = 0; column < focus.depth.columns(); ++column) {
      const Vec2 at = focus.depth.position(column, row);
      if (at.norm() < 0.5 * radius)
        distances.push_back(100.0 - std::sqrt(radius * radius - at.squaredNorm()) -
                            focus.depth.at(focus.depth.sample(column, row)));
    }
  const auto [least, greatest] = std::ranges::minmax(distances);
  return greatest - least;
}

TEST(MaskShaping, SmoothingRemovesStepsAndPreservesRadius) {
  const double radius = 12.0;
  const Mask steps = makeBall(radius), smooth = smoothMask(steps, 1.2, volume);
  EXPECT_EQ(smooth.maxValue, 255);
  EXPECT_GT(measureStepHeight(steps, radius), 0.5);
  EXPECT_LT(measureStepHeight(smooth, radius), 0.6 * measureStepHeight(steps, radius));
  // Smoothing shrinks a ball's radius by sigma^2 / radius.
  EXPECT_NEAR(std::cbrt(computeVolume(smooth) / computeBallVolume(1.0)),
              std::cbrt(computeVolume(steps) / computeBallVolume(1.0)) - 1.44 / radius, 0.12);
}

TEST(MaskShaping, SmoothingPreservesFlatFaces) {
  const Mask box = makeBoxMask(makeCenteredGrid({60, 60, 40}), {-20, -9, -15}, {20, 9, 15});
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 100, 20, 64, 64);
  const auto depth = [&](const Mask& mask) {
    const FocusDepth focus = FocusTracer(camera, volume, mask).traceDepths();
    return focus.depth.at(focus.depth.viewportSample(32, 32));
  };
  EXPECT_NEAR(depth(smoothMask(box, 1.0, volume)), depth(box), 0.01) << "rounding to 8 bits";
}

/// Step height, mm: range of distances from the visible surface to the plane y = slope z.
double measureSlopeStepHeight(const Mask& mask, double slope) {
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 100, 5, 128, 128);
  const FocusDepth focus = FocusTracer(camera, volume, mask).traceDepths();
  std::vector<double> distances;
  for (std::int64_t row = 0; row < focus.depth.rows(); ++row)
    for (std::int64_t column = 0; column < focus.depth.columns(); ++column) {
      const Vec2 at = focus.depth.position(column, row);
      if (at.cwiseAbs().maxCoeff() < 5.0)
        distances.push_back(
            (focus.depth.at(focus.depth.sample(column, row)) - 100.0 - slope * at.y()) /
            std::hypot(1.0, slope));
    }
  const auto [least, greatest] = std::ranges::minmax(distances);
  return greatest - least;
}

TEST(MaskShaping, ObliqueSurfaceAcrossThickSlicesIsSmooth) {
  for (const double slope : {1.0, 2.0}) { // 2 and 4 mm per slice
    const Mask steps = makeMask(makeCenteredGrid({41, 121, 21}, {0.5, 0.5, 2.0}),
                                [&](const Vec3& p) { return p.y() >= slope * p.z() + 0.1; });
    EXPECT_GT(measureSlopeStepHeight(smoothMask(steps, 0.6, volume), slope), 0.3);
    EXPECT_LT(measureSlopeStepHeight(smoothMask(interpolateSlices(steps), 0.6, volume), slope),
              0.12);
  }
}

/// Compares voxels of a smoothed mask with an explicit Gaussian sum.
TEST(MaskShaping, SmoothingEqualsSampledGaussian) {
  const Mask mask = makeMask(makeCenteredGrid({9, 12, 40}, {1.0, 0.5, 1.5}), [](const Vec3& p) {
    return p.x() + p.y() > 0.3 && std::abs(p.z() - 2.0) < 14.0;
  });
  const double sigma = 1.3;
  const Mask smooth = smoothMask(mask, sigma, volume);
  EXPECT_EQ(smooth.smoothing, sigma);
  const Vec3 spacing = mask.grid.spacing();
  const auto at = [&](const Size3& voxel) {
    const Size3 nearest = voxel.cwiseMax(0).cwiseMin((mask.grid.size.array() - 1).matrix());
    return mask.voxels[linearIndex(nearest, mask.grid.size)];
  };
  for (const Vec3& place : {Vec3(0, 0, 0), Vec3(2, 1, -20), Vec3(-4, 2.5, 15), Vec3(3, -1, 16.5)}) {
    const Size3 voxel = (mask.grid.worldToIndex * place).array().round().cast<std::int64_t>();
    double sum = 0.0, weights = 0.0;
    for (int z = -3; z <= 3; ++z)
      for (int y = -8; y <= 8; ++y)
        for (int x = -4; x <= 4; ++x) {
          const Vec3 d = Vec3(x, y, z).cwiseProduct(spacing) / sigma;
          const double weight = std::exp(-0.5 * d.squaredNorm());
          weights += weight;
          sum += weight * at(voxel + Size3(x, y, z));
        }
    const Vec3 there = smooth.grid.worldToIndex * (mask.grid.indexToWorld * voxel.cast<double>());
    const Size3 same = there.array().round().cast<std::int64_t>();
    EXPECT_NEAR(smooth.voxels[linearIndex(same, smooth.grid.size)], 255.0 * sum / weights, 1.0);
  }
}

/// Parts that smoothing would erase keep their labels, even if other parts are smoothed.
TEST(MaskShaping, AutomaticSmoothingPreservesThinParts) {
  const Mask mask = makeMask(makeCenteredGrid({41, 31, 31}), [](const Vec3& p) {
    const bool isLine = std::hypot(p.x() + 15.0, p.y()) < 0.5;
    return (isLine || (p - Vec3(5.0, 0.0, 0.0)).norm() < 6.0) && std::abs(p.z()) < 14.0;
  });
  const auto valueAt = [](const Mask& labels, const Vec3& p) {
    const Vec3 index = labels.grid.worldToIndex * p;
    return labels.voxels[linearIndex(index.array().round().cast<std::int64_t>(), labels.grid.size)];
  };
  const Mask smooth = smoothMaskAuto(mask, 1.0, volume), plain = smoothMask(mask, 1.25, volume);
  EXPECT_NEAR(smooth.smoothing, 1.25, 1e-12);
  for (const double z : {-13.0, 3.0, 13.0}) {
    EXPECT_LT(valueAt(plain, Vec3(-15.0, 0.0, z)), plain.threshold());
    EXPECT_GE(valueAt(smooth, Vec3(-15.0, 0.0, z)), smooth.threshold());
  }
  // Equal volume multiplies the odds inside : outside of all voxels of the ball by one factor.
  const auto findOdds = [](int value) { return value / (255.0 - value); };
  const Vec3 surface(11.0, 0.0, 0.0);
  const double factor = findOdds(valueAt(smooth, surface)) / findOdds(valueAt(plain, surface));
  EXPECT_GT(factor, 1.2);
  double greatest = 0.0; // difference
  for (double x = -3.0; x < 14.0; ++x)
    for (double y = -8.0; y < 9.0; ++y) {
      const Vec3 p(x, y, 2.0);
      const double odds = factor * findOdds(valueAt(plain, p));
      const double expected = std::isinf(odds) ? 255.0 : 255.0 * odds / (1.0 + odds);
      greatest = std::max(greatest, std::abs(valueAt(smooth, p) - expected));
    }
  EXPECT_LT(greatest, 2.0);
  EXPECT_NEAR(measureVolumeChange(mask, smooth, volume), 0.0, 0.002);
  const Mask flakes = makeMask(makeCenteredGrid({9, 9, 9}, {1.0, 1.0, 0.01}),
                               [](const Vec3& p) { return std::abs(p.x()) < 2.5; });
  EXPECT_EQ(smoothMaskAuto(flakes, 1.0, volume).maxValue, 1) << "unchanged";
}

TEST(MaskShaping, SmoothingHandlesKernelsOfManyVoxels) {
  const Mask mask = makeMask(makeCenteredGrid({21, 21, 21}, {1.0, 1.0, 0.02}),
                             [](const Vec3& p) { return std::abs(p.x()) < 4.5; });
  const Mask smooth = smoothMask(mask, 1.0, volume);
  const auto at = [&](int x) {
    const Vec3 index = smooth.grid.worldToIndex * Vec3(x, 0.0, 0.0);
    return smooth.voxels[linearIndex(index.array().round().cast<std::int64_t>(), smooth.grid.size)];
  };
  EXPECT_GT(at(0), 250);
  EXPECT_GT(at(4), 128);
  EXPECT_LT(at(5), 128);
}

TEST(MaskShaping, InterpolationPreservesSlicesAndVolumeOfBall) {
  const double radius = 10.0;
  for (const int axis : {0, 1, 2}) {
    Vec3 spacing = Vec3::Constant(0.5);
    Size3 size = Size3::Constant(45);
    spacing[axis] = 1.25;
    size[axis] = 19;
    const Mask ball = makeSphereMask(makeCenteredGrid(size, spacing), radius);
    const Mask fine = interpolateSlices(ball);
    Size3 fineSize = size;
    fineSize[axis] = 55;
    ASSERT_EQ(fine.grid.size, fineSize);
    EXPECT_LT(fine.grid.worldCenter().norm(), 1e-9);
    EXPECT_NEAR(computeVolume(fine) / computeBallVolume(radius), 1.0, 0.02);
    std::int64_t differing = 0;
    for (std::int64_t i = 0; i < ball.grid.voxelCount(); ++i) {
      const Size3 at{i % size.x(), i / size.x() % size.y(), i / (size.x() * size.y())};
      Size3 to = at;
      to[axis] *= 3;
      const auto number = to.x() + fineSize.x() * (to.y() + fineSize.y() * to.z());
      differing +=
          ball.voxels[static_cast<std::size_t>(i)] != fine.voxels[static_cast<std::size_t>(number)];
    }
    EXPECT_EQ(differing, 0);
  }
}

TEST(MaskShaping, NearlyCubicVoxelsAreNotInterpolated) {
  const Mask mask = makeBall(10.0);
  EXPECT_EQ(interpolateSlices(mask).voxels, mask.voxels);
}

TEST(MaskShaping, SingleMarginShrinksUnionOfSegments) {
  const Grid grid = makeCenteredGrid({40, 40, 40});
  LargeArray<std::uint8_t> labels;
  for (std::int64_t z = 0; z < 40; ++z)
    for (std::int64_t y = 0; y < 40; ++y)
      for (std::int64_t x = 0; x < 40; ++x) {
        const bool in = x >= 10 && x < 30 && y >= 10 && y < 20 && z >= 10 && z < 20;
        labels.push_back(!in ? 0 : x < 20 ? 1 : 2);
      }
  const Segmentation segmentation("test", grid, 1, labels, {{"a", "A", 1}, {"b", "B", 2}});
  const auto count = [&](const MaskShaping& shaping) {
    return segmentation.makeFocusMask({"A", "B"}, grid, shaping).count;
  };
  EXPECT_EQ(count({{-1.0}}), 18 * 8 * 8); // the margin of both
  EXPECT_EQ(count({{-1.0, -1.0}}), 2 * 8 * 8 * 8);
}

TEST(MaskShaping, MarginsApplyPerSegment) {
  const Grid grid = makeCenteredGrid({40, 40, 40});
  LargeArray<std::uint8_t> labels;
  for (std::int64_t z = 0; z < 40; ++z)
    for (std::int64_t y = 0; y < 40; ++y)
      for (std::int64_t x = 0; x < 40; ++x)
        labels.push_back(x == 10 && y == 20 && z == 20 ? 1 : x == 30 && y == 20 && z == 20 ? 2 : 0);
  const Segmentation segmentation("test", grid, 1, labels, {{"a", "A", 1}, {"b", "B", 2}});
  const auto count = [&](const MaskShaping& shaping) {
    return segmentation.makeFocusMask({"A", "B"}, grid, shaping).count;
  };
  EXPECT_EQ(count({}), 2);
  EXPECT_EQ(count({{1.0}}), 2 * 7); // a voxel and its six neighbors, twice
  EXPECT_EQ(count({{0.0, 1.0}}), 1 + 7);
  EXPECT_EQ(count({{1.5, 1.0}}), 19 + 7); // also the twelve diagonal neighbors
  EXPECT_THROW(count({{1.0, 2.0, 3.0}}), Error);
  EXPECT_THROW(count({{-1.0}}), Error) << "the focus is empty";
  EXPECT_THROW(count({{}, 5.0}), Error) << "smoothing leaves an empty focus";
}

} // namespace
} // namespace fenestra::core::MaskShapingTests
