// --view auto: scores of bodies with closed forms, and stability of the chosen view.

#include "scene/AutomaticView.h"

#include "Support.h"
#include "base/Random.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace fenestra::core::testing::AutomaticViewTests {
namespace {

/// Cube of 60 mm filled with a transparent context.
class AutomaticView : public ::testing::Test {
protected:
  const Grid grid = makeCenteredGrid({30, 30, 30}, {2.0, 2.0, 2.0});
  const TransferFunction transfer = makeLinearTransfer(0.01, Rgb::Constant(0.8));
  Volume volume = makeVolume(grid, [](const Vec3&) { return 1.0; });

  /// Mask of 1 mm voxels in the cube whose centers satisfy the predicate.
  template <typename Predicate>
  static Mask makeFocus(const Predicate& predicate) {
    Mask mask;
    mask.grid = makeCenteredGrid({60, 60, 60}, {1.0, 1.0, 1.0});
    mask.names = {"A"};
    for (std::int64_t z = 0; z < 60; ++z)
      for (std::int64_t y = 0; y < 60; ++y)
        for (std::int64_t x = 0; x < 60; ++x) {
          const Vec3 center = mask.grid.indexToWorld * Size3(x, y, z).cast<double>();
          mask.voxels.push_back(predicate(center) ? 1 : 0);
        }
    return mask;
  }

  ViewScorer makeScorer(const Mask& focus) const { return {volume, grid, transfer, focus}; }
  ViewDirection findView(const Mask& focus) const { return findBestView(makeScorer(focus)); }
};

double angleInDegrees(const Vec3& a, const Vec3& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * 180.0 / pi;
}

/// True in three ellipsoids of different sizes, like a bone with its processes.
bool isInLump(const Vec3& p) {
  const auto inside = [&](const Vec3& center, const Vec3& radii) {
    return (p - center).cwiseQuotient(radii).squaredNorm() <= 1.0;
  };
  return inside({2, 8, -3}, {12, 5, 9}) || inside({-8, 12, 4}, {5, 4, 11}) ||
         inside({9, 4, 8}, {4, 7, 4});
}

TEST_F(AutomaticView, ScoreOfABallEqualsClosedForm) {
  constexpr double radius = 15.0, edge = 60.0, disk = pi * radius * radius;
  constexpr std::size_t rays = 16384;
  const Mask ball = makeFocus([](const Vec3& p) { return p.norm() <= radius; });
  const ViewScorer score = makeScorer(ball);
  // A surface removes the context in front of the ball's near half. Beside the ball, it removes the
  // context in front of the plane at that half's mean depth.
  const double inFront = disk * (edge / 2.0 - 2.0 / 3.0 * radius);
  const double beside = (edge * edge - disk) * (edge / 2.0 - 2.0 / 3.0 * radius);
  const double context = std::pow(edge, 3.0) - 4.0 / 3.0 * disk * radius;
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)}) {
    const ViewScore result = score(axis, rays);
    EXPECT_NEAR(result.area, disk, 0.02 * disk) << "voxels have a rough outline";
    EXPECT_NEAR(result.removedFraction, (inFront + beside) / context, 0.01);
  }
  // Preferences (AutomaticView.h): anterior 1.05, posterior 0.95, superior 0.9.
  const double front = score(Vec3::UnitY(), rays).score;
  EXPECT_NEAR(score(-Vec3::UnitY(), rays).score, front * 0.95 / 1.05, 0.01 * front);
  EXPECT_NEAR(score(Vec3::UnitZ(), rays).score, front * 0.9 / 1.05, 0.01 * front);
}

TEST_F(AutomaticView, SlabIsShownFromTheNearestFace) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const Mask slab = makeFocus([&](const Vec3& p) {
        const double height = side * p[axis];
        return height > 20.0 && height < 24.0 && (p - p[axis] * Vec3::Unit(axis)).norm() < 15.0;
      });
      const ViewDirection view = findView(slab);
      EXPECT_LT(angleInDegrees(view.fromTarget, side * Vec3::Unit(axis)), 8.0)
          << "axis " << axis << ", side " << side << ": " << view.fromTarget;
      EXPECT_EQ(view.up, axis == 2 ? Vec3::UnitY() : Vec3::UnitZ());
      EXPECT_NEAR(view.fromTarget.norm(), 1.0, 1e-12);
    }
}

TEST_F(AutomaticView, DiskIsShownFaceOnFromTheCustomarySide) {
  for (const Vec3& normal : {Vec3(0, 1, 0), Vec3(1, 2, 0.5), Vec3(-2, 1, 1), Vec3(1, 1, -1)}) {
    const Vec3 unit = normal.normalized();
    const Mask disk = makeFocus([&](const Vec3& p) {
      return std::abs(p.dot(unit)) < 2.0 && (p - p.dot(unit) * unit).norm() < 20.0;
    });
    EXPECT_LT(angleInDegrees(findView(disk).fromTarget, unit), 10.0) << normal;
  }
}

TEST_F(AutomaticView, ViewThroughAirIsPreferredToTissue) {
  volume = makeVolume(grid, [](const Vec3& index) { return index.y() > 14.5 ? 1.0 : 0.0; });
  const Mask ball = makeFocus([](const Vec3& p) { return p.norm() <= 10.0; });
  EXPECT_LT(findView(ball).fromTarget.y(), -0.7)
      << "from posterior, although anterior is customary";
}

TEST_F(AutomaticView, ViewMovesLittleForASimilarFocus) {
  const Vec3 reference = findView(makeFocus(isInLump)).fromTarget;
  const auto angle = [&](const auto& predicate) {
    return angleInDegrees(reference, findView(makeFocus(predicate)).fromTarget);
  };
  EXPECT_LT(angle([](const Vec3& p) { return isInLump(p + Vec3(0.4, -0.3, 0.3)); }), 3.0)
      << "moved";
  EXPECT_LT(angle([](const Vec3& p) { return isInLump(1.07 * p); }), 3.0) << "smaller";
  EXPECT_LT(angle([](const Vec3& p) {
              return isInLump(p) || isInLump(p + Vec3::UnitX()) || isInLump(p - Vec3::UnitY());
            }),
            4.0)
      << "dilated";
  EXPECT_LT(angle([](const Vec3& p) {
              const Vec3 voxel = p + Vec3::Constant(29.5);
              const double number = voxel.x() + 60.0 * voxel.y() + 3600.0 * voxel.z();
              const auto noise = static_cast<std::uint64_t>(number + 0.5);
              return isInLump(p) && mixBits(noise) % 20 != 0;
            }),
            4.0)
      << "with holes";
  EXPECT_LT(
      angle([](const Vec3& p) { return isInLump(Vec3((p.array() / 2.0).floor() * 2.0 + 1.0)); }),
      12.0)
      << "at half the resolution, parts 8 mm wide";
}

TEST_F(AutomaticView, ViewIsTheSameForAnyNumberOfThreads) {
  const Mask lump = makeFocus(isInLump);
  const Vec3 expected = findView(lump).fromTarget;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(findView(lump).fromTarget, expected);
}

TEST_F(AutomaticView, EmptyFocusIsShownFromAnterior) {
  Mask emptyMask;
  emptyMask.grid = makeCenteredGrid({3, 3, 3}, {1.0, 1.0, 1.0});
  emptyMask.voxels.assign(27, 0);
  EXPECT_EQ(findView(emptyMask).fromTarget, Vec3::UnitY());
}

} // namespace
} // namespace fenestra::core::testing::AutomaticViewTests
