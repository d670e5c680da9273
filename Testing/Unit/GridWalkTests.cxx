// GridWalk visits all cells of a ray in order: compared with its contract and with dense sampling.

#include "RunSettings.h"
#include "base/Random.h"
#include "model/volume/GridWalk.h"

#include <gtest/gtest.h>

#include <set>

namespace fenestra::core::GridWalkTests {
using testing::reduceSamples;

namespace {

struct WalkResult {
  std::int64_t cells = 0;
  double worstOutside = 0.0; ///< maximum distance of an interval's middle from its cell, in cells
};

/// Walks along the ray and checks the guarantees that hold for every finite ray.
WalkResult checkWalk(const Ray& ray, const Interval& range, const Size3& cells) {
  WalkResult walked;
  const Interval inside = Box{Vec3::Zero(), cells.cast<double>()}.clip(ray, range);
  double reached = inside.begin;
  Size3 before = Size3::Constant(-1);
  for (GridWalk walk(ray, range, cells); !walk.isDone(); walk.next()) {
    const Size3& c = walk.coordinates();
    const Interval interval = walk.interval();
    const bool inGrid = (c.array() >= 0).all() && (c.array() < cells.array()).all();
    EXPECT_TRUE(inGrid) << c;
    EXPECT_EQ(walk.cell(), c.x() + cells.x() * (c.y() + cells.y() * c.z()));
    EXPECT_EQ(interval.begin, reached);
    EXPECT_LE(interval.begin, interval.end);
    EXPECT_TRUE(walked.cells == 0 || (c - before).cwiseAbs().sum() == 1);
    before = c;
    reached = interval.end;
    if (std::isfinite(reached) && interval.begin < reached) {
      const Vec3 middle = ray.at(0.5 * (interval.begin + interval.end));
      const Vec3 low = c.cast<double>() - middle;
      const Vec3 high = middle - (c.cast<double>() + Vec3::Ones());
      walked.worstOutside = std::max({walked.worstOutside, low.maxCoeff(), high.maxCoeff()});
    }
    if (++walked.cells > cells.sum() || !inGrid || ::testing::Test::HasFailure()) {
      ADD_FAILURE() << "ray " << ray.origin << " | " << ray.direction;
      return walked;
    }
  }
  if (!inside.isEmpty())
    EXPECT_EQ(reached, inside.end);
  else
    EXPECT_EQ(walked.cells, 0);
  return walked;
}

double signedUniform(Random& random) {
  return 2.0 * random.uniform() - 1.0;
}

/// Coordinate that is often at a face or a corner, zero or extreme.
double makeAwkwardCoordinate(Random& random, double extent) {
  switch (random.bits() % 6) {
  case 0:
    return std::floor((extent + 1.0) * random.uniform());
  case 1:
    return std::nextafter(std::floor((extent + 1.0) * random.uniform()),
                          signedUniform(random) * 99);
  case 2:
    return extent * random.uniform();
  case 3:
    return extent * 3.0 * signedUniform(random);
  case 4:
    return std::ldexp(signedUniform(random), static_cast<int>(random.bits() % 80) - 40);
  default:
    return 0.5 * std::floor(2.0 * (extent + 1.0) * random.uniform());
  }
}

double makeAwkwardDirection(Random& random) {
  switch (random.bits() % 5) {
  case 0:
    return random.bits() % 2 ? 0.0 : -0.0;
  case 1:
    return random.bits() % 2 ? 1.0 : -1.0;
  case 2:
    return std::ldexp(signedUniform(random), -static_cast<int>(random.bits() % 1080));
  default:
    return signedUniform(random);
  }
}

TEST(GridWalk, VisitsTheCellsOfAnAxisInOrder) {
  const Ray ray{{-1.0, 0.5, 1.5}, {2.0, 0.0, 0.0}};
  GridWalk walk(ray, {}, {3, 1, 2});
  for (int i = 0; i < 3; ++i, walk.next()) {
    ASSERT_FALSE(walk.isDone());
    EXPECT_EQ(walk.cell(), 3 + i);
    EXPECT_DOUBLE_EQ(walk.interval().begin, 0.5 + 0.5 * i);
    EXPECT_DOUBLE_EQ(walk.interval().end, 1.0 + 0.5 * i);
  }
  EXPECT_TRUE(walk.isDone());
}

TEST(GridWalk, MissesAndEmptyRangesAreDoneImmediately) {
  const Size3 cells(4, 4, 4);
  EXPECT_TRUE(GridWalk({{5.0, 1.0, 1.0}, {1.0, 0.0, 0.0}}, {}, cells).isDone());
  EXPECT_TRUE(GridWalk({{-1.0, 9.0, 1.0}, {1.0, 0.1, 0.0}}, {}, cells).isDone());
  EXPECT_TRUE(GridWalk({{1.0, 1.0, 1.0}, {1.0, 0.0, 0.0}}, {2.0, 2.0}, cells).isDone());
}

TEST(GridWalk, StartOnAFaceIsInTheCellAhead) {
  const Size3 cells(4, 4, 4);
  EXPECT_EQ(GridWalk({{2.0, 0.5, 0.5}, {1.0, 0.0, 0.0}}, {}, cells).coordinates().x(), 2);
  EXPECT_EQ(GridWalk({{2.0, 0.5, 0.5}, {-1.0, 0.0, 0.0}}, {}, cells).coordinates().x(), 1);
  EXPECT_EQ(GridWalk({{4.0, 4.0, 4.0}, {-1.0, -1.0, -1.0}}, {}, cells).cell(), 63);
}

TEST(GridWalk, FollowsOuterFacesInsideTheGrid) {
  const Size3 cells(4, 5, 6);
  EXPECT_EQ(checkWalk({{4.0, 5.0, -2.0}, {0.0, 0.0, 1.0}}, {}, cells).cells, 6);
  EXPECT_EQ(checkWalk({{0.0, 9.0, 0.0}, {0.0, -1.0, 0.0}}, {}, cells).cells, 5);
}

TEST(GridWalk, RayWithoutDirectionStaysInItsCell) {
  const WalkResult walked = checkWalk({{1.5, 1.5, 1.5}, Vec3::Zero()}, {0.0, infinity}, {3, 3, 3});
  EXPECT_EQ(walked.cells, 1);
}

TEST(GridWalk, AgreesWithDenseSamplingOfTheRay) {
  Random random(1, 2, 3);
  for (int trial = 0; trial < reduceSamples(20000); ++trial) {
    const Size3 cells(1 + random.bits() % 9, 1 + random.bits() % 9, 1 + random.bits() % 9);
    const Vec3 a(9 * signedUniform(random), 9 * signedUniform(random), 9 * signedUniform(random));
    const Vec3 b(9 * random.uniform(), 9 * random.uniform(), 9 * random.uniform());
    const Ray ray{a, (b - a).normalized()};
    std::set<std::int64_t> walked;
    for (GridWalk walk(ray, {}, cells); !walk.isDone(); walk.next())
      walked.insert(walk.cell());
    for (int i = 0; i < 200; ++i) {
      const Vec3 p = ray.at(0.15 * (i + random.uniform()));
      const Size3 c = p.array().floor().cast<std::int64_t>();
      const bool inGrid = (c.array() >= 0).all() && (c.array() < cells.array()).all();
      const std::int64_t cell = c.x() + cells.x() * (c.y() + cells.y() * c.z());
      ASSERT_TRUE(!inGrid || walked.contains(cell));
    }
  }
}

TEST(GridWalk, RandomRaysTileTheirRange) {
  Random random(4, 5, 6);
  double worst = 0.0;
  for (int trial = 0; trial < reduceSamples(1000000) && !HasFailure(); ++trial) {
    const Size3 cells(1 + random.bits() % 40, 1 + random.bits() % 40, 1 + random.bits() % 40);
    const Vec3 n = cells.cast<double>();
    const Vec3 from =
        n.cwiseProduct(Vec3(2 * random.uniform(), random.uniform(), -random.uniform()));
    const Vec3 to = n.cwiseProduct(Vec3(random.uniform(), random.uniform(), random.uniform()));
    const Interval range{random.uniform(), 100.0 * random.uniform()};
    worst = std::max(worst, checkWalk({from, (to - from).normalized()}, range, cells).worstOutside);
  }
  EXPECT_LT(worst, 1e-12);
}

TEST(GridWalk, AwkwardRaysTileTheirRange) {
  Random random(7, 8, 9);
  for (int trial = 0; trial < reduceSamples(3000000) && !HasFailure(); ++trial) {
    const Size3 cells(1 + random.bits() % 12, 1 + random.bits() % 12, 1 + random.bits() % 12);
    Ray ray;
    for (int axis = 0; axis < 3; ++axis) {
      ray.origin[axis] = makeAwkwardCoordinate(random, static_cast<double>(cells[axis]));
      ray.direction[axis] = makeAwkwardDirection(random);
    }
    const double begin = random.bits() % 4 ? 0.0 : makeAwkwardCoordinate(random, 10.0);
    checkWalk(ray, {begin, random.bits() % 2 ? infinity : 20.0 * random.uniform()}, cells);
  }
}

TEST(GridWalk, RaysThroughCornersTileTheirRange) {
  Random random(13, 14, 15);
  const Size3 cells(9, 10, 11);
  for (int trial = 0; trial < reduceSamples(500000) && !HasFailure(); ++trial) {
    Vec3 from, to; // half of the corners are on the grid's surface, where the walk begins
    for (int axis = 0; axis < 3; ++axis) {
      from[axis] = 30.0 * signedUniform(random);
      to[axis] = static_cast<double>(random.bits() % static_cast<std::uint64_t>(cells[axis] + 1));
    }
    if (trial % 2)
      to[trial % 3] = 0.0;
    const Ray ray{from, (to - from).normalized()};
    EXPECT_LT(checkWalk(ray, {}, cells).worstOutside, 1e-13);
    EXPECT_LT(checkWalk(ray, {(to - from).norm(), infinity}, cells).worstOutside, 1e-13);
  }
}

TEST(GridWalk, FarOriginsKeepTheirCellsToRounding) {
  Random random(10, 11, 12);
  for (int trial = 0; trial < reduceSamples(200000) && !HasFailure(); ++trial) {
    const double far = std::pow(10.0, 8.0 * random.uniform());
    const Size3 cells(16, 16, 16);
    const Vec3 to = 16.0 * Vec3(random.uniform(), random.uniform(), random.uniform());
    const Vec3 direction =
        Vec3(signedUniform(random), signedUniform(random), signedUniform(random)).normalized();
    const WalkResult walked = checkWalk({to - far * direction, direction}, {}, cells);
    EXPECT_LT(walked.worstOutside, 1e-14 * (far + 100.0));
  }
}

} // namespace
} // namespace fenestra::core::GridWalkTests
