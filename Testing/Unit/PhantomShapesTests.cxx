#include "phantoms/Anatomy.h"
#include "phantoms/Noise.h"
#include "phantoms/Shapes.h"

#include "Approx.h"
#include <gtest/gtest.h>

#include <numeric>
#include <thread>

namespace fenestra::core::PhantomShapesTests {

TEST(PhantomShapes, BlendsEqualSharpOperationsAwayFromEdge) {
  EXPECT_DOUBLE_EQ(smoothUnion(1.0, 5.0, 2.0), 1.0);
  EXPECT_DOUBLE_EQ(smoothIntersection(1.0, 5.0, 2.0), 5.0);
  EXPECT_DOUBLE_EQ(smoothDifference(-6.0, 3.0, 2.0), -3.0);
  EXPECT_DOUBLE_EQ(smoothUnion(1.0, 1.0, 2.0), 0.5); // largest at the edge: width / 4
}

TEST(PhantomShapes, TubeDistanceIsAxisDistanceMinusRadius) {
  const Solid solid = makeTube({{{0, 0, -10}, 2.0}, {{0, 0, 0}, 2.0}, {{0, 0, 10}, 2.0}});
  EXPECT_NEAR(solid.distance({5, 0, 1}), 3.0, 1e-12);
  EXPECT_NEAR(solid.distance({0, 0, 0.3}), -2.0, 1e-12);
  EXPECT_NEAR(solid.distance({0, 0, 14}), 2.0, 1e-12);
  EXPECT_TRUE(isApprox(solid.box.upper, Vec3(2, 2, 12)));
}

TEST(PhantomShapes, BandIsStretchedInWidthButNotInThickness) {
  const Solid band = makeTube({{{0, 0, 0}, 1.5}, {{0, 0, 20}, 1.5}}, {4, 1, 1});
  EXPECT_NEAR(band.distance({0, 1.5, 10}), 0.0, 1e-12);
  EXPECT_NEAR(band.distance({6, 0, 10}), 0.0, 1e-12);
}

TEST(PhantomShapes, LoftOfEqualCirclesIsCylinder) {
  const Solid cylinder =
      makeLoft({{-20, {1, 2}, {5, 5}}, {0, {1, 2}, {5, 5}}, {20, {1, 2}, {5, 5}}}, 0.0, 1.0);
  EXPECT_NEAR(cylinder.distance({9, 2, 3}), 3.0, 1e-9);
  EXPECT_NEAR(cylinder.distance({1, 5, -3}), -2.0, 1e-9);
  EXPECT_NEAR(cylinder.distance({1, 2.5, 24}), 4.0, 1e-9);
}

TEST(PhantomShapes, LoftPassesThroughSections) {
  const std::vector<LoftSection> sections = {
      {-10, {0, 0}, {4, 6}}, {0, {2, 1}, {7, 5}}, {15, {3, -1}, {5, 3}}, {30, {0, 0}, {2, 2}}};
  const Solid solid = makeLoft(sections, 0.6, 1.0);
  for (std::size_t i = 1; i + 1 < sections.size(); ++i) {
    const LoftSection& s = sections[i];
    EXPECT_NEAR(solid.distance({s.center.x() + s.radii.x(), s.center.y(), s.z}), 0.0, 1e-9);
    EXPECT_NEAR(solid.distance({s.center.x(), s.center.y() - s.radii.y(), s.z}), 0.0, 1e-9);
  }
}

TEST(PhantomShapes, BlockIsRotatedBoxWithRoundEdges) {
  // The block's axes are x, z and y of the world.
  const Solid solid =
      placeSolid(toShape({1, 2, 3}, Vec3::UnitY(), Vec3::UnitZ()), makeBlock({4, 5, 6}, 2.0));
  EXPECT_NEAR(solid.distance({1, 2, 3}), -4.0, 1e-12);
  EXPECT_NEAR(solid.distance({8, 2, 3}), 3.0, 1e-12);
  EXPECT_NEAR(solid.distance({1, 2, 9}), 1.0, 1e-12);
  EXPECT_NEAR(solid.distance({1, 10, 3}), 2.0, 1e-12);
  EXPECT_NEAR(solid.distance({5, 8, 8}), std::sqrt(12.0) - 2.0, 1e-12) << "corner";
  EXPECT_TRUE(isApprox(solid.box.lower, Vec3(-3, -4, -2)));
  EXPECT_TRUE(isApprox(solid.box.upper, Vec3(5, 8, 8)));
}

TEST(PhantomShapes, PlacedLoftFollowsAxis) {
  const Solid upright = makeLoft({{0, {0, 0}, {2, 3}}, {10, {0, 0}, {2, 3}}}, 0.0, 1.0);
  const Solid solid = placeSolid(toShape({0, 5, 0}, Vec3::UnitY(), Vec3::UnitZ()), upright);
  EXPECT_NEAR(solid.distance({2, 10, 0}), 0.0, 1e-9);
  EXPECT_NEAR(solid.distance({0, 10, 3}), 0.0, 1e-9);
  EXPECT_NEAR(solid.distance({0, 17, 0}), 2.0, 1e-9);
  EXPECT_TRUE(contains(solid.box, {2, 15, 3}));
}

TEST(PhantomAnatomy, PartsAreCombinedInOrder) {
  const Solid solid = Anatomy::parse(R"([
    {"name": "Ball", "ellipsoid": [[0, 0, 0], [5, 5, 5]]},
    {"name": "Two bars", "tube": [[4, 0, -9, 1], [4, 0, 9, 1]], "paired": true, "unite": 0.5},
    {"name": "Hole", "tube": [[0, 0, -9, 2], [0, 0, 9, 2]], "cut": 0.5},
    {"name": "Upper half", "above": 1, "intersect": 0.5}])");
  EXPECT_GT(solid.distance({0, 0, 3}), 1.0) << "in the hole";
  EXPECT_LT(solid.distance({0, 3, 3}), 0.0) << "in the ball";
  EXPECT_LT(solid.distance({4, 0, 8}), 0.0);
  EXPECT_LT(solid.distance({-4, 0, 8}), 0.0) << "in the mirrored bar";
  EXPECT_GT(solid.distance({0, 3, -3}), 1.0) << "below";
}

TEST(PhantomAnatomy, PartHasItsOwnFrame) {
  const Solid solid = Anatomy::parse(R"({"loft": [[0, 0, 0, 2, 3], [10, 0, 0, 2, 3]],
    "squareness": 0, "cap": 1, "frame": [[0, 5, 0], [0, 1, 0], [0, 0, 1]]})");
  EXPECT_NEAR(solid.distance({2, 10, 0}), 0.0, 1e-9);
  EXPECT_NEAR(solid.distance({0, 17, 0}), 2.0, 1e-9);
}

TEST(PhantomNoise, NormalNoiseHasNormalMoments) {
  constexpr int n = 100000;
  double mean = 0.0, square = 0.0, within = 0.0;
  for (std::uint64_t i = 0; i < n; ++i) {
    const double x = normalNoise(i);
    mean += x / n;
    square += x * x / n;
    within += (std::abs(x) < 1.0) / static_cast<double>(n);
  }
  EXPECT_NEAR(mean, 0.0, 0.015);
  EXPECT_NEAR(square, 1.0, 0.02);
  EXPECT_NEAR(within, 0.6827, 0.007);
}

TEST(PhantomNoise, ValueNoiseIsContinuousAndBounded) {
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p(0.37 * i - 300.0, -0.21 * i, 0.11 * i);
    const double value = valueNoise(p, 5);
    EXPECT_LE(std::abs(value), 1.0);
    EXPECT_EQ(value, valueNoise(p, 5));
    EXPECT_NEAR(value, valueNoise(p + Vec3::Constant(1e-6), 5), 2e-5);
  }
  EXPECT_NE(valueNoise({0.5, 0.5, 0.5}, 1), valueNoise({0.5, 0.5, 0.5}, 2));
}

// Threads keep lattice cells by field; 512 seeds apart, fields share their place.
TEST(PhantomNoise, ValuesDoNotDependOnThreadsAndEarlierPoints) {
  constexpr std::size_t n = 300000;
  const auto noise = [](std::size_t i) {
    const double x = 0.013 * static_cast<double>(i % 1009);
    return valueNoise({x, 0.7 * x, -x}, 5 + 512 * (i / 8 % 3));
  };
  std::vector<double> forward(n), apart(n);
  for (std::size_t i = 0; i < n; ++i)
    forward[i] = noise(i);
  const auto fill = [&](std::size_t thread) {
    for (std::size_t i = n; i-- > 0;)
      if (i * 4 / n == thread)
        apart[i] = noise(i);
  };
  {
    std::vector<std::jthread> threads;
    for (std::size_t thread = 0; thread < 4; ++thread)
      threads.emplace_back(fill, thread);
  }
  EXPECT_EQ(forward, apart);
}

TEST(PhantomNoise, RicianMomentsMatchPublishedValues) {
  constexpr int n = 200000;
  constexpr double sigma = 11.0;
  double air = 0.0, muscle = 0.0, square = 0.0;
  for (std::uint64_t i = 0; i < n; ++i) {
    air += ricianNoise(0.0, sigma, i) / n;
    const double m = ricianNoise(350.0, sigma, i);
    muscle += m / n;
    square += m * m / n;
  }
  // Gudbjartsson and Patz 1995: Rayleigh distribution at zero signal, nearly normal at high signal.
  EXPECT_NEAR(air, sigma * std::sqrt(pi / 2.0), 0.1);
  EXPECT_NEAR(muscle, std::sqrt(350.0 * 350.0 + sigma * sigma), 0.15);
  EXPECT_NEAR(std::sqrt(square - muscle * muscle), sigma, 0.1);
}

} // namespace fenestra::core::PhantomShapesTests
