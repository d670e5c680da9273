// Domain of a cropped volume compared with its definition: inside both boxes.

#include "model/volume/Domain.h"

#include "base/Random.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::DomainTests {
namespace {

double uniform(Random& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

Vec3 randomPoint(Random& random, double size) {
  return {uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)};
}

/// Map that rotates, shears and scales about the origin, and sometimes mirrors.
Affine makeRandomMap(Random& random, double size) {
  Affine map = Affine::Identity();
  const Mat3 randomMatrix(randomPoint(random, 1), randomPoint(random, 1), randomPoint(random, 1));
  const Mat3 shear = Mat3::Identity() + 0.3 * randomMatrix;
  map.linear() =
      makeRotation(uniform(random, -3, 3), randomPoint(random, 1).normalized()).linear() * shear *
      Mat3::Diagonal({size, uniform(random, 0.2, 1) * size, uniform(random, 0.2, 1) * size});
  if (random.uniform() < 0.5)
    map.linear().col(0) *= -1.0;
  map.translation() = randomPoint(random, 0.5 * size);
  return map;
}

Grid makeRandomGrid(Random& random) {
  const Size3 size(5, 9, 7);
  return {size, makeRandomMap(random, 1.0) *
                    makeTranslation(-0.5 * (size.array() - 1).cast<double>().matrix())};
}

/// Distance of a world point from the domain, in units of the boxes. 0: on the surface, negative:
/// inside.
double distanceOutside(const Grid& grid, const CropBox& crop, const Vec3& world) {
  const Vec3 index = grid.worldToIndex * world;
  const Box box = grid.indexBox();
  const double beyondGrid =
      std::max((box.lower - index).maxCoeff(), (index - box.upper).maxCoeff());
  return std::max(beyondGrid, (crop.worldToBox * world).cwiseAbs().maxCoeff() - 1.0);
}

TEST(Domain, ClipIsTheIntersectionOfGridAndCrop) {
  Random random(21, 0, 0);
  int hits = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Grid grid = makeRandomGrid(random);
    const CropBox crop(makeRandomMap(random, 3.0));
    const Vec3 target = crop.boxToWorld * randomPoint(random, 1.0);
    Ray ray{randomPoint(random, 6.0), Vec3::Zero()};
    ray.direction = (target - ray.origin).normalized();
    if (trial % 3 == 0) // along an axis of the world or of a box
      ray.direction = Vec3::Unit(trial % 9 / 3);
    else if (trial % 3 == 1)
      ray.direction = (trial % 2 ? crop.boxToWorld : grid.indexToWorld).linear().col(trial % 9 / 3);
    const Interval range{uniform(random, -4.0, 4.0), uniform(random, 4.0, 20.0)};
    const Interval inside = Domain(grid, crop).clip(transformRay(grid.worldToIndex, ray), range);
    hits += inside.isEmpty() ? 0 : 1;
    for (int i = 0; i < 200; ++i) {
      const double t = range.begin + (i + 0.5) / 200.0 * (range.end - range.begin);
      const double distance = distanceOutside(grid, crop, ray.at(t));
      if (std::abs(distance) > 1e-9) {
        ASSERT_EQ(distance < 0.0, !inside.isEmpty() && t >= inside.begin && t <= inside.end)
            << "trial " << trial << " at " << t;
      }
    }
    if (inside.isEmpty())
      continue;
    for (const double end : {inside.begin, inside.end}) {
      if (end != range.begin && end != range.end) {
        ASSERT_NEAR(distanceOutside(grid, crop, ray.at(end)), 0.0, 1e-9) << "ends are exact";
      }
    }
  }
  EXPECT_GT(hits, 300);
  EXPECT_LT(hits, 1500);
}

TEST(Domain, WithoutACropEqualsTheGrid) {
  Random random(22, 0, 0);
  for (int trial = 0; trial < 200; ++trial) {
    const Grid grid = makeRandomGrid(random);
    const Ray ray = transformRay(grid.worldToIndex,
                                 {randomPoint(random, 6.0), randomPoint(random, 1.0).normalized()});
    const Interval expected = grid.indexBox().clip(ray, {0.5, 9.0});
    const Interval inside = Domain(grid).clip(ray, {0.5, 9.0});
    EXPECT_EQ(inside.begin, expected.begin);
    EXPECT_EQ(inside.end, expected.end);
  }
  EXPECT_EQ(Domain(Grid({2, 2, 2}, Affine::Identity())).indexCorners().size(), 8U);
}

TEST(Domain, RayInAFaceIsInside) {
  const Grid grid({8, 8, 8}, Affine::Identity());
  Affine half = Affine::Identity(); // [1, 3] in each axis
  half.translation() = Vec3::Constant(2.0);
  const Domain domain(grid, CropBox(half));
  for (const double face : {1.0, 3.0}) {
    const Interval interval = domain.clip({Vec3(-4, face, 2), Vec3::UnitX()});
    EXPECT_EQ(interval.begin, 5.0);
    EXPECT_EQ(interval.end, 7.0);
  }
  EXPECT_TRUE(domain.clip({Vec3(-4, std::nextafter(3.0, 4.0), 2), Vec3::UnitX()}).isEmpty());
  EXPECT_TRUE(domain.clip({Vec3(-4, 2, 2), -Vec3::UnitX()}).isEmpty()) << "behind the ray";
  EXPECT_EQ(domain.clip({Vec3(2, 2, 2), Vec3::UnitZ()}).begin, 0.0) << "the ray starts inside";
}

TEST(Domain, CornersSpanTheDomain) {
  Random random(23, 0, 0);
  int cut = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Grid grid = makeRandomGrid(random);
    const CropBox crop(trial % 4 ? makeRandomMap(random, 3.0) // else exactly the grid's box
                                 : grid.indexToWorld * makeTranslation({2, 4, 3}) *
                                       makeScaling(Vec3(2.5, 4.5, 3.5)));
    const std::vector<Vec3> corners = Domain(grid, crop).indexCorners();
    for (const Vec3& corner : corners)
      ASSERT_LT(distanceOutside(grid, crop, grid.indexToWorld * corner), 1e-7);
    std::vector<Vec3> inside;
    const Box box = grid.indexBox();
    for (int i = 0; i < 2000; ++i) {
      const Vec3 index(uniform(random, box.lower.x(), box.upper.x()),
                       uniform(random, box.lower.y(), box.upper.y()),
                       uniform(random, box.lower.z(), box.upper.z()));
      if (distanceOutside(grid, crop, grid.indexToWorld * index) < 0.0)
        inside.push_back(index);
    }
    ASSERT_FALSE(corners.empty() && !inside.empty());
    cut += !inside.empty() && inside.size() < 2000 ? 1 : 0;
    for (int i = 0; i < 20; ++i) {
      const Vec3 direction = randomPoint(random, 1.0);
      double farthest = -infinity;
      for (const Vec3& corner : corners)
        farthest = std::max(farthest, direction.dot(corner));
      for (const Vec3& point : inside)
        ASSERT_LT(direction.dot(point), farthest);
    }
  }
  EXPECT_GT(cut, 100);
}

TEST(Domain, CropOutsideTheGridIsEmpty) {
  Affine map = Affine::Identity();
  map.translation() = Vec3(20, 0, 0);
  const Domain domain(Grid({8, 8, 8}, Affine::Identity()), CropBox(map));
  EXPECT_TRUE(domain.indexCorners().empty());
  EXPECT_TRUE(domain.clip({Vec3(-4, 0, 0), Vec3::UnitX()}).isEmpty());
}

} // namespace
} // namespace fenestra::core::testing::DomainTests
