#include "model/medium/Tint.h"

#include "SharesTesting.h"
#include "transport/render/ExpectedFlight.h"

#include <gtest/gtest.h>

#include <map>

namespace fenestra::testing::SharesTests {
namespace {

using ByComponent = std::map<int, double>;
ByComponent sharesAt(const Shares& shares, const Vec3& world) {
  ByComponent sums;
  shares.at(shares.grid().worldToIndex * world,
            [&](std::uint8_t component, double share) { sums[component] += share; });
  return sums;
}

/// Shares at a voxel's centre by the definition, 0 to 1, not rounded.
ByComponent definedAt(const std::vector<Shares::Part>& parts, const Vec3& world) {
  ByComponent shares;
  double left = 1.0;
  for (int priority = 2; priority >= 0; --priority) {
    const auto indicator = [&](const Shares::Part& part) {
      const Vec3 index = part.mask.grid.worldToIndex * world;
      const Size3 voxel = index.array().round().cast<std::int64_t>();
      const bool inside =
          (voxel.array() >= 0).all() && (voxel.array() < part.mask.grid.size.array()).all();
      return inside && part.priority == priority
                 ? part.mask.voxels[numberOf(voxel, part.mask.grid.size)] / 255.0
                 : 0.0;
    };
    double sum = 0.0;
    for (const Shares::Part& part : parts)
      sum += indicator(part);
    for (const Shares::Part& part : parts)
      shares[part.component] += indicator(part) * (sum > left ? left / sum : 1.0);
    left -= std::min(left, sum);
  }
  shares[0] += left;
  return shares;
}

/// Calls visit(world point) for voxel centres of a grid, its outermost too.
template <typename Visit>
void forVoxels(const Grid& grid, const Visit& visit) {
  for (std::int64_t z = 0; z < grid.size.z(); ++z)
    for (std::int64_t y = 0; y < grid.size.y(); ++y)
      for (std::int64_t x = 0; x < grid.size.x(); ++x)
        visit(grid.indexToWorld * Size3(x, y, z).cast<double>());
}

TEST(Shares, AreThoseOfTheDefinitionAtVoxels) {
  const std::vector<Shares::Part> parts = randomParts(12);
  const Shares shares = sharesOf(parts);
  forVoxels(shares.grid(), [&](const Vec3& at) {
    ByComponent found = sharesAt(shares, at), defined = definedAt(parts, at);
    double sum = 0.0;
    for (const auto& [component, share] : found)
      sum += share;
    ASSERT_NEAR(sum, 1.0, 1e-12);
    for (const auto& [component, share] : defined)
      ASSERT_NEAR(found[component], share, 2.5 / 255.0) << component; // others' rounding, too
  });
  const auto last = [](const Shares::Plane& plane) { return plane.isLast != 0; };
  EXPECT_FALSE(std::ranges::all_of(shares.planes(), last)); // some bricks have two planes
}

TEST(Shares, AreTrilinearBetweenVoxelsAndAcrossBricks) {
  const Shares shares = sharesOf(randomParts(12));
  const Grid& grid = shares.grid();
  for (int i = 0; i < 2000; ++i) {
    Random random(9, static_cast<std::uint64_t>(i), 0);
    const Vec3 last = (grid.size.array() - 1).cast<double>();
    const Vec3 index =
        last.cwiseProduct(Vec3(random.uniform(), random.uniform(), random.uniform()));
    const Vec3 low = index.array().floor().min(last.array() - 1.0), f = index - low;
    ByComponent mean;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
      const double weight =
          (step.array() * f.array() + (1.0 - step.array()) * (1.0 - f.array())).prod();
      for (const auto& [component, share] : sharesAt(shares, grid.indexToWorld * (low + step)))
        mean[component] += weight * share;
    }
    ByComponent found = sharesAt(shares, grid.indexToWorld * index);
    for (const auto& [component, share] : mean)
      ASSERT_NEAR(found[component], share, 1e-12);
  }
}

TEST(Shares, DoNotDependOnTheOrderOfParts) {
  std::vector<Shares::Part> parts = randomParts(6); // of six components
  const Shares shares = sharesOf(parts);
  std::ranges::reverse(parts);
  const Shares reversed = sharesOf(parts);
  forVoxels(shares.grid(),
            [&](const Vec3& at) { ASSERT_EQ(sharesAt(shares, at), sharesAt(reversed, at)); });
}

TEST(Shares, WhatPlanesLeaveIsNothingWhereOthersHaveAll) {
  const auto some = [](const Size3& v) { return (37 * v.x() + 91 * v.y() + 53 * v.z()) % 256; };
  const Size3 first(0, 0, 0), size(12, 9, 9);
  const auto partOf = [&](std::uint8_t component, const auto& value) {
    return Shares::Part{maskOf(first, size, value), 1, component};
  };
  const Shares shares =
      sharesOf({partOf(1, [&](const Size3& v) { return v.x() < 8 ? some(v) : 0; }),
                partOf(2, [&](const Size3& v) { return v.x() < 8 ? 255 - some(v) : 0; }),
                partOf(3, [](const Size3& v) { return v.x() < 8 ? 0 : 255; })});
  Random random(3, 0, 0);
  for (int i = 0; i < 2000; ++i) { // in bricks that have all three
    const Vec3 at(4.0 + 3.0 * random.uniform(), 8.0 * random.uniform(), 8.0 * random.uniform());
    shares.at(at, [&](std::uint8_t component, double) { ASSERT_LT(component, 3); });
  }
  EXPECT_EQ(sharesAt(shares, shares.grid().indexToWorld * Vec3(8, 3, 3)), (ByComponent{{3, 1.0}}));
}

TEST(Shares, BricksOfOneComponentArePure) {
  const auto inside = [](const Size3&) { return 255; };
  const Shares shares = sharesOf({{maskOf({0, 0, 0}, {33, 9, 9}, inside), 1, 3}});
  EXPECT_EQ(shares.pureFraction(), 1.0);
  EXPECT_EQ(shares.bricks(), std::vector<std::int32_t>(8 * 2 * 2, 3));
  EXPECT_TRUE(shares.planes().empty());
}

TEST(Shares, MixedBricksOfTwoComponentsTakeOnePlane) {
  const auto half = [](const Size3& voxel) { return voxel.x() < 6 ? 255 : 0; };
  const Shares shares = sharesOf({{maskOf({0, 0, 0}, {13, 5, 5}, half), 1, 1}});
  EXPECT_EQ(shares.bricks(), (std::vector<std::int32_t>{1, ~0, 0}));
  EXPECT_EQ(shares.bytes(), 3 * sizeof(std::int32_t) + 128);
}

/// Components that differ in colour; two of them have the matter's own.
TestScene tintedScene() {
  TestScene scene = sceneOfParts();
  scene.tint = Tint{std::make_shared<const Shares>(sharesOf(randomParts(12))), {std::nullopt}};
  for (int i = 1; i <= 6; ++i)
    scene.tint->albedo.push_back(
        ColorFunction({{0.2, Rgb(0.15 * i, 0.5, 0.9 - 0.1 * i)}, {0.6, Rgb(0.9, 0.1 * i, 0.2)}}));
  scene.tint->albedo[2] = std::nullopt;
  return scene;
}

Film rendered(TestScene scene, bool isTinted, Integrator transport) {
  if (!isTinted)
    scene.tint.reset();
  return rendered(scene, transport);
}

TEST(Tint, LanesAreTheScalarEstimator) {
  const TestScene scene = tintedScene();
  const Film lanes = rendered(scene, true, Integrator::simd);
  const Film scalar = rendered(scene, true, Integrator::scalar);
  const Film plain = rendered(scene, false, Integrator::scalar);
  const auto albedo = [](const PixelSums& pixel) { return Rgb(pixel.albedo / 64.0); };
  const auto radiance = [](const PixelSums& pixel) { return pixel.mean; };
  EXPECT_LT(apart(simd, scalar, albedo), 0.02);
  EXPECT_LT(apart(simd, scalar, radiance), 0.05);
  EXPECT_GT(apart(plain, scalar, albedo), 0.03);
}

TEST(Tint, MarchInLanesIsTheReadableOne) {
  tintedScene().with([](const RenderScene& scene) {
    ASSERT_TRUE(lanesServe(scene));
    const FeatureBuffers lanes = computeFeatures(scene), readable = computeScalarFeatures(scene);
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < lanes.hit.size(); ++i)
        sum += std::pow(static_cast<double>(lanes.albedo[c][i] - readable.albedo[c][i]), 2.0);
    EXPECT_LT(std::sqrt(sum / (3.0 * static_cast<double>(simd.hit.size()))), 0.02);
  });
}

TEST(Tint, ChangesNothingButColour) {
  const TestScene scene = tintedScene();
  for (const Integrator transport : {Integrator::simd, Integrator::scalar}) {
    const Film plain = rendered(scene, false, transport), tinted = rendered(scene, true, transport);
    for (std::size_t i = 0; i < plain.pixelCount(); ++i) {
      const PixelSums &a = plain.pixels()[i], &b = tinted.pixels()[i];
      ASSERT_EQ(a.alpha, b.alpha);
      ASSERT_EQ(a.depth, b.depth);
      ASSERT_EQ(a.collided, b.collided);
      ASSERT_TRUE(a.normal == b.normal);
    }
    EXPECT_GT(apart(plain, tinted, [](const PixelSums& pixel) { return pixel.albedo; }), 1.0);
  }
}

} // namespace
} // namespace fenestra::testing::SharesTests
