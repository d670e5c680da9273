// Depth of the focus compared with planes and with dense ray marching of the same indicator.

#include "ClippingTesting.h"
#include "RunSettings.h"
#include "base/SimdTargets.h"
#include "clip/focus/CellCubic.h"
#include "clip/focus/FocusCells.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <optional>

namespace fenestra::core::FocusDepthTests {
using namespace testing_clipping;
using testing::reduceSamples;

namespace {

double interpolate(const std::array<double, 8>& v, const Vec3& p) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 8; ++i)
    sum += v[i] * (i & 1 ? p.x() : 1.0 - p.x()) * (i & 2 ? p.y() : 1.0 - p.y()) *
           (i & 4 ? p.z() : 1.0 - p.z());
  return sum;
}

/// Mask indicator at a world point, by definition.
double indicator(const Mask& mask, const Vec3& world) {
  const Vec3 index = mask.grid.worldToIndex * world;
  const Vec3 floor = index.array().floor();
  std::array<double, 8> corners{};
  for (std::int64_t i = 0; i < 8; ++i) {
    const Size3 voxel = floor.cast<std::int64_t>() + Size3(i & 1, i >> 1 & 1, i >> 2);
    if ((voxel.array() >= 0).all() && (voxel.array() < mask.grid.size.array()).all())
      corners[static_cast<std::size_t>(i)] = mask.voxels[static_cast<std::size_t>(
          voxel.x() + mask.grid.size.x() * (voxel.y() + mask.grid.size.y() * voxel.z()))];
  }
  return interpolate(corners, index - floor);
}

double findDepth(const FocusDepth& focus, const Vec2& position) {
  return focus.depth.nearestDepth(position);
}

/// Rays through and beside a mask of 3^3 voxels, in cell space and in world space.
struct RandomRays {
  FocusRays cellRays;
  std::vector<Ray> worldRays;

  RandomRays(Random& random, const FocusCells& cells) {
    while (worldRays.size() < 50) {
      const Vec3 origin = randomPoint(random, -4.0, 6.0);
      const Ray world{origin, (randomPoint(random, -0.5, 2.5) - origin).normalized()};
      const Ray ray = transformRay(cells.worldToCell(), world);
      const Interval inside = cells.box().clip(ray, {});
      for (std::size_t axis = 0; axis < 3; ++axis) {
        cellRays.origin[axis][cellRays.size] = ray.origin[static_cast<int>(axis)];
        cellRays.direction[axis][cellRays.size] = ray.direction[static_cast<int>(axis)];
      }
      cellRays.begin[cellRays.size] = inside.begin;
      cellRays.end[cellRays.size] = inside.end;
      ++cellRays.size;
      worldRays.push_back(world);
    }
  }
};

TEST(FocusCells, RayHitsThemWhereTheIndicatorFirstReachesOneHalf) {
  Random random(5, 0, 0);
  const Grid grid({3, 3, 3}, Affine::Identity());
  int hits = 0;
  for (int trial = 0; trial < reduceSamples(40); ++trial) {
    const Mask mask = makeMask(grid, [&](const Vec3&) { return random.uniform() < 0.4; });
    const FocusCells cells(mask);
    auto [rays, worldRays] = RandomRays(random, cells);
    cells.findHits(rays);
    for (std::size_t i = 0; i < rays.size; ++i) {
      const double hitT = rays.hitT[i];
      if (hitT < infinity && hitT > rays.begin[i]) {
        ++hits;
        EXPECT_NEAR(indicator(mask, worldRays[i].at(hitT)), 0.5, 1e-12);
      }
      for (double t = rays.begin[i]; t < std::min(rays.end[i], hitT - 1e-9); t += 0.01) {
        ASSERT_LT(indicator(mask, worldRays[i].at(t)), 0.5 + 1e-12);
      }
    }
  }
  EXPECT_GT(hits, reduceSamples(500));
}

/// Tolerance on a ridge along the ray, whose near end may be returned as the maximum.
constexpr double ridgeTolerance = 1.01e-4;

/// Maximum on a ray that misses a mask, by stepping.
double findMaximum(const Mask& mask, const Ray& ray, double begin, double end) {
  constexpr double step = 0.003;
  double best = 0.0, before = 0.0, here = 0.0;
  bool isOnRidge = false;
  for (double t = begin; t < end + 2.0 * step; t += step) {
    const double next = t < end ? indicator(mask, ray.at(t)) / mask.maxValue : 0.0;
    const bool isMaximum = here >= before && here >= next && here > FocusCells::captureThreshold;
    const bool isHidden = !isOnRidge && 0.5 - here >= FocusCells::replaceRatio * (0.5 - best);
    if (isMaximum && (best == 0.0 || !isHidden))
      best = std::max(best, here);
    isOnRidge = best > 0.0 && here >= best - ridgeTolerance && (isOnRidge || here == best);
    before = here;
    here = next;
  }
  return best;
}

TEST(FocusCells, MaximumOfAMissingRayEqualsDenseSampling) {
  Random random(6, 0, 0);
  const Grid grid({3, 3, 3}, Affine::Identity());
  int captured = 0, hidden = 0, mismatches = 0;
  for (const std::uint8_t maxValue : {std::uint8_t{1}, std::uint8_t{200}})
    for (int trial = 0; trial < reduceSamples(40); ++trial) {
      Mask mask = makeMask(grid, [&](const Vec3&) { return random.uniform() < 0.3; });
      mask.maxValue = maxValue;
      for (std::uint8_t& voxel : mask.voxels)
        voxel = static_cast<std::uint8_t>(maxValue == 1 ? voxel : 200.0 * random.uniform());
      const FocusCells cells(mask);
      auto [rays, worldRays] = RandomRays(random, cells);
      cells.findHitsAndMaxima(rays);
      for (std::size_t i = 0; i < rays.size; ++i) {
        if (rays.hitT[i] < infinity)
          continue;
        double maximum = 0.0;
        for (double t = rays.begin[i]; t < rays.end[i]; t += 0.003)
          maximum = std::max(maximum, indicator(mask, worldRays[i].at(t)) / maxValue);
        if (maximum <= FocusCells::captureThreshold) {
          EXPECT_LT(rays.maximum[i], FocusCells::captureThreshold + 1e-3);
          continue;
        }
        ++captured;
        hidden += maximum > rays.maximum[i] + 0.01;
        const double expected = findMaximum(mask, worldRays[i], rays.begin[i], rays.end[i]);
        if (std::abs(rays.maximum[i] - expected) > 2e-3)
          ++mismatches; // stepping can decide either way on a maximum that is barely hidden
        else if (expected == maximum) {
          EXPECT_GE(rays.maximum[i], maximum - ridgeTolerance);
        }
        const Vec3 point = worldRays[i].at(rays.maximumT[i]);
        EXPECT_NEAR(indicator(mask, point) / maxValue, rays.maximum[i], 1e-9);
        EXPECT_NEAR(cells.indicator(cells.worldToCell() * point), rays.maximum[i], 1e-9);
      }
    }
  EXPECT_GT(captured, reduceSamples(200));
  EXPECT_GT(hidden, reduceSamples(20));
  EXPECT_LT(mismatches, 3);
}

scalar::Cubic makeCubic(const std::array<double, 4>& c) {
  return {c[0], c[1], c[2], c[3]};
}
double findFirstNonNegative(const std::array<double, 4>& c) {
  return scalar::findFirstNonNegative(makeCubic(c), scalar::rootRounding);
}

TEST(CellCubic, SlopeEqualsFiniteDifference) {
  Random random(1, 0, 0);
  for (int trial = 0; trial < 10000; ++trial) {
    std::array<double, 4> c;
    for (double& coefficient : c)
      coefficient = uniform(random, -1, 1);
    const scalar::Cubic cubic = makeCubic(c);
    const double s = random.uniform();
    const double step = 1e-5;
    EXPECT_NEAR(evalSlope(cubic, s),
                (evalCubic(cubic, s + step) - evalCubic(cubic, s - step)) / (2 * step), 1e-8);
  }
}

TEST(CellCubic, FirstRootEqualsBruteForce) {
  Random random(2, 0, 0);
  int roots = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    std::array<double, 4> c = {uniform(random, -1, 0.05), uniform(random, -4, 4),
                               uniform(random, -8, 8), uniform(random, -8, 8)};
    // Every fifth is a quadratic; of these, every second is nearly linear.
    c[trial % 5 == 0 ? 3 : 0] *= trial % 5 == 0 ? 0.0 : 1.0;
    c[trial % 10 == 0 ? 2 : 0] *= trial % 10 == 0 ? 1e-18 : 1.0;
    const scalar::Cubic cubic = makeCubic(c);
    const double root = findFirstNonNegative(c);
    const int samples = 400;
    for (int i = 0; i <= samples; ++i) {
      const double s = static_cast<double>(i) / samples;
      if (s < root - 1e-9) {
        ASSERT_LT(evalCubic(cubic, s), 1e-12) << "there is a root before " << root;
      }
    }
    if (root > 0.0 && root < infinity) {
      ++roots;
      ASSERT_LE(root, 1.0);
      ASSERT_NEAR(evalCubic(cubic, root), 0.0, 1e-13);
    }
  }
  EXPECT_GT(roots, 5000);
}

TEST(CellCubic, DoubleConstantAndLinearRootsAreFound) {
  EXPECT_EQ(findFirstNonNegative({-1, 0, 0, 0}), infinity);
  EXPECT_EQ(findFirstNonNegative({0, -1, 0, 0}), 0.0);
  EXPECT_NEAR(findFirstNonNegative({-0.25, 1, 0, 0}), 0.25, 1e-15);
  EXPECT_NEAR(findFirstNonNegative({-0.25, 1, -1, 0}), 0.5, 1e-7); // a double root
  EXPECT_NEAR(findFirstNonNegative({-1, 0, 0, 1}), 1.0, 1e-15);
}

TEST(FocusDepth, BoxFacesAreAtTheVoxelFaces) {
  const Grid grid = makeCenteredGrid({40, 40, 40}, {1.0, 0.7, 1.3});
  const Mask mask = makeBoxMask(grid, {-10.1, -7.1, -13.1}, {10.1, 7.1, 13.1});
  for (const auto projection : {Projection::orthographic, Projection::perspective}) {
    const Camera camera = makeAnteriorCamera(projection, 200.0, 30.0, 64, 48);
    const FocusDepth focus = FocusTracer(camera, grid, mask).traceDepths();
    const double face = 200.0 - 0.7 * 10.0; // ten voxels to each side of the origin
    EXPECT_NEAR(findDepth(focus, {0.3, 0.3}), face, 1e-5);
    EXPECT_NEAR(findDepth(focus, {-8.0, 11.0}), face, 1e-5);
    EXPECT_EQ(findDepth(focus, {13.0, 0.0}), infinity);
  }
}

TEST(FocusDepth, RegionsCountFocusContextAndOutside) {
  const Grid grid = makeCenteredGrid({20, 20, 20});
  const Mask mask = makeBoxMask(grid, Vec3::Constant(-4), Vec3::Constant(4));
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 50.0, 20.0, 40, 40);
  const FocusDepth focus = FocusTracer(camera, grid, mask).traceDepths();
  std::array<int, 3> count{};
  for (const Region region : focus.regions)
    ++count[static_cast<std::size_t>(region)];
  EXPECT_EQ(count[static_cast<std::size_t>(Region::focus)], 8 * 8);
  EXPECT_EQ(count[static_cast<std::size_t>(Region::context)], 20 * 20 - 8 * 8);
  EXPECT_EQ(count[static_cast<std::size_t>(Region::outside)], 40 * 40 - 20 * 20);
}

/// Expects every hit at the level 0.5, and no focus in front of it.
void compareWithMarching(const Camera& camera, const Domain& volume, const Mask& mask) {
  const FocusDepth focus = FocusTracer(camera, volume, mask).traceDepths();
  const double step = 0.02;
  int hits = 0;
  for (std::int64_t row = 0; row < focus.depth.rows(); ++row)
    for (std::int64_t column = 0; column < focus.depth.columns(); ++column) {
      const Ray ray = camera.makePlaneRay(focus.depth.position(column, row));
      const Interval inside = volume.clip(transformRay(volume.grid().worldToIndex, ray));
      const double hit =
          focus.depth.at(focus.depth.sample(column, row)) / camera.depthPerLength(ray);
      if (hit < infinity) {
        ++hits;
        ASSERT_GE(hit, inside.begin - 1e-4);
        ASSERT_LE(hit, inside.end + 1e-4);
        ASSERT_GE(indicator(mask, ray.at(hit)), 0.5 - 1e-4);
        if (hit > inside.begin + 1e-4) {
          ASSERT_NEAR(indicator(mask, ray.at(hit)), 0.5, 1e-4);
        }
      }
      for (double t = inside.begin; t < std::min(inside.end, hit - 1e-4); t += step) {
        ASSERT_LT(indicator(mask, ray.at(t)), 0.5 + 1e-9);
      }
    }
  EXPECT_GT(hits, 50);
}

TEST(FocusDepth, IsTheSameInEveryInstructionSet) {
  const Grid grid = makeCenteredGrid({70, 61, 52}, {1.0, 0.7, 1.3});
  const Mask mask = makeMask(grid, [](const Vec3& p) { // two shells, one inside the other
    return std::abs(p.norm() - 18.0) < 2.0 || std::abs((p - Vec3(3, 2, 1)).norm() - 9.0) < 1.5;
  });
  CameraPose pose;
  pose.position = {40.0, -90.0, 25.0};
  pose.target = {1.0, 2.0, 3.0};
  for (const auto projection : {Projection::orthographic, Projection::perspective}) {
    pose.projection = projection;
    pose.scale = 25.0;
    const Camera camera(pose, 90, 70);
    std::optional<FocusDepth> first;
    for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS; left != 0; left &= left - 1) {
      SCOPED_TRACE(hwy::TargetName(left & -left));
      hwy::SetSupportedTargetsForTest(left & -left);
      const FocusDepth focus = FocusTracer(camera, grid, mask).traceDepths();
      if (!first)
        first = focus;
      EXPECT_EQ(focus.regions, first->regions);
      for (std::int64_t i = 0; i < focus.depth.size(); ++i)
        if (focus.regions[static_cast<std::size_t>(i)] == Region::focus) {
          ASSERT_NEAR(focus.depth.at(i), first->depth.at(i), 1e-5); // a float's last place
        }
      hwy::SetSupportedTargetsForTest(0); // all again
    }
  }
}

TEST(FocusDepth, AgreesWithMarchingInObliqueGridsAndViews) {
  Random random(3, 0, 0);
  for (int trial = 0; trial < std::max(2, reduceSamples(6)); ++trial) {
    Affine map = Affine::Identity();
    map.linear() =
        makeRotation(random.uniform() * 6, randomPoint(random, -1, 1).normalized()).linear() *
        (Mat3::Identity() + 0.2 * Mat3(randomPoint(random, -1, 1), randomPoint(random, -1, 1),
                                       randomPoint(random, -1, 1)));
    map.translation() = map.linear() * Vec3::Constant(-10.0);
    const Grid grid({21, 21, 21}, map);
    const Mask mask = makeMask(grid, [&](const Vec3& p) {
      return p.norm() < 5.0 || (p.norm() < 8.0 && random.uniform() < 0.2);
    });
    CameraPose pose;
    pose.projection = trial % 2 ? Projection::perspective : Projection::orthographic;
    pose.position = 50.0 * randomPoint(random, -1, 1).normalized();
    pose.target = Vec3::Zero();
    pose.scale = 10.0;
    compareWithMarching({pose, 24, 20}, grid, mask);
    const CropBox crop(Affine(makeRotation(0.4, randomPoint(random, -1, 1).normalized())) *
                       makeScaling(Vec3(6.0, 7.0, 5.0)));
    compareWithMarching({pose, 24, 20}, {grid, crop}, mask);
  }
}

/// Grids, crops and views of every kind: camera and volume at any position.
TEST(FocusDepth, RegionIsWhatItsRayHits) {
  Random random(4, 0, 0);
  const Grid grid = makeCenteredGrid({20, 24, 16}, {1.0, 0.8, 1.5});
  const Mask mask = makeMask(grid, [&](const Vec3& p) {
    return (p - Vec3(3, 2, -4)).norm() < 4.0 || (p + Vec3(5, 3, -2)).norm() < 1.5;
  });
  std::array<int, 3> count{};
  for (int trial = 0; trial < 60; ++trial) {
    CameraPose pose;
    pose.projection = trial % 2 ? Projection::perspective : Projection::orthographic;
    pose.position = uniform(random, 1, trial % 3 ? 80 : 15) * randomPoint(random, -1, 1);
    pose.target = randomPoint(random, -15, 15);
    pose.scale = std::pow(10.0, uniform(random, 0, 2));
    pose.angle = uniform(random, 2, 120);
    const Camera camera(pose, 1 + static_cast<int>(random.uniform() * 40), 21);
    const CropBox crop(Affine(makeTranslation(randomPoint(random, -6, 6)) *
                              makeRotation(trial, randomPoint(random, -1, 1).normalized())) *
                       makeScaling(randomPoint(random, 1, 15)));
    const Domain volume = trial % 5 < 2 ? Domain(grid, crop) : Domain(grid);
    const FocusDepth focus = FocusTracer(camera, volume, mask).traceDepths();
    const std::int64_t stride = 1 + focus.depth.rows() / 40;
    for (std::int64_t row = 0; row < focus.depth.rows(); row += stride)
      for (std::int64_t column = 0; column < focus.depth.columns(); column += stride) {
        const Ray ray = camera.makePlaneRay(focus.depth.position(column, row));
        const Interval inside = volume.clip(transformRay(grid.worldToIndex, ray));
        bool isFocus = false;
        for (double t = inside.begin; t < inside.end && !isFocus; t += 0.1)
          isFocus = indicator(mask, ray.at(t)) > 0.5 + 1e-9;
        const Region region =
            focus.regions[static_cast<std::size_t>(focus.depth.sample(column, row))];
        ASSERT_EQ(region == Region::outside, inside.isEmpty()) << trial;
        ASSERT_TRUE(!isFocus || region == Region::focus) << trial;
        ASSERT_EQ(region == Region::focus,
                  focus.depth.at(focus.depth.sample(column, row)) < infinity);
        ++count[static_cast<std::size_t>(region)];
      }
  }
  EXPECT_GT(*std::ranges::min_element(count), 500);
}

TEST(FocusDepth, RayThatStartsInsideHitsTheFocusAtZero) {
  const Grid grid = makeCenteredGrid({20, 20, 20});
  const Mask mask = makeSphereMask(grid, 6.0);
  const Camera camera = makeAnteriorCamera(Projection::perspective, 1.0, 1.0, 8, 8);
  EXPECT_EQ(findDepth(FocusTracer(camera, grid, mask).traceDepths(), {0.0, 0.0}), 0.0);
}

TEST(FocusDepth, FocusBeyondTheVolumeIsClippedAtItsFace) {
  const Grid volume = makeCenteredGrid({20, 20, 20});
  const Mask mask = makeSphereMask(makeCenteredGrid({40, 40, 40}), 15.0);
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 50.0, 8.0, 16, 16);
  EXPECT_NEAR(findDepth(FocusTracer(camera, volume, mask).traceDepths(), {0.0, 0.0}), 40.0, 1e-5);
}

TEST(FocusDepth, CropClipsTheFocusAndItsContext) {
  const Grid volume = makeCenteredGrid({40, 40, 40});
  const Mask mask = makeSphereMask(volume, 10.0);
  // The crop keeps everything behind a plane through the origin, whose depth grows 1 mm per mm to
  // the right.
  const CropBox crop(makeRotation(-pi / 4, Vec3::UnitZ()) * makeTranslation({0.0, 30.0, 0.0}) *
                     makeScaling(Vec3(60.0, 30.0, 18.0)));
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 50.0, 20.0, 40, 40);
  const FocusDepth focus = FocusTracer(camera, {volume, crop}, mask).traceDepths();
  const auto region = [&](const Vec2& at) {
    for (std::int64_t row = 0; row < focus.depth.rows(); ++row)
      for (std::int64_t column = 0; column < focus.depth.columns(); ++column)
        if ((focus.depth.position(column, row) - at).norm() < 0.1)
          return focus.regions[static_cast<std::size_t>(focus.depth.sample(column, row))];
    return Region::outside;
  };
  EXPECT_NEAR(findDepth(focus, {4.5, 0.5}), 50.0 - 4.5, 1e-5) << "hit at the crop's face";
  EXPECT_NEAR(findDepth(focus, {-4.5, 0.5}), 50.0 + 4.5, 1e-5);
  EXPECT_EQ(region({-4.5, 0.5}), Region::focus);
  EXPECT_EQ(findDepth(focus, {-8.5, 0.5}), infinity) << "the crop begins behind the sphere";
  EXPECT_EQ(region({-8.5, 0.5}), Region::context);
  EXPECT_EQ(region({0.5, 17.5}), Region::context);
  EXPECT_EQ(region({0.5, 18.5}), Region::outside) << "above the crop, inside the volume";
}

TEST(FocusDepth, MaskWithoutMarginEndsHalfAVoxelBeyondItsCenters) {
  const Grid volume = makeCenteredGrid({20, 20, 20});
  const Mask mask =
      makeMask(makeCenteredGrid({2, 1, 2}, {2, 2, 2}), [](const Vec3&) { return true; });
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 50.0, 8.0, 64, 64);
  const FocusDepth focus = FocusTracer(camera, volume, mask).traceDepths();
  EXPECT_NEAR(findDepth(focus, {0.1, 0.1}), 49.0, 1e-5);
  EXPECT_EQ(findDepth(focus, {2.2, 0.1}), infinity);
}

TEST(FocusDepth, DistantCameraKeepsThePrecision) {
  const Grid grid = makeCenteredGrid({40, 40, 40});
  const Mask mask = makeBoxMask(grid, Vec3::Constant(-10), Vec3::Constant(10));
  for (const auto projection : {Projection::orthographic, Projection::perspective}) {
    const Camera camera = makeAnteriorCamera(projection, 1e6, 30.0, 32, 32);
    EXPECT_NEAR(findDepth(FocusTracer(camera, grid, mask).traceDepths(), {1.0, 1.0}) - 1e6, -10.0,
                1e-5);
  }
}

} // namespace
} // namespace fenestra::core::FocusDepthTests
