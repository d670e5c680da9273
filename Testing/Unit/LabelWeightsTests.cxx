#include "model/medium/Tint.h"

#include "LabelWeightsTesting.h"
#include "denoise/features/FeatureBuffers.h"

#include <gtest/gtest.h>

#include <map>

namespace fenestra::core::testing::LabelWeightsTests {
namespace {

using WeightMap = std::map<int, double>;
WeightMap getWeights(const LabelWeights& weights, const Vec3& world) {
  WeightMap sums;
  weights.forEachWeight(
      weights.grid().worldToIndex * world,
      [&](std::uint8_t component, double labelWeight) { sums[component] += labelWeight; });
  return sums;
}

/// Weights (0 to 1, not rounded) at a voxel center, computed from the definition.
WeightMap computeExpected(const std::vector<LabelWeights::Part>& parts, const Vec3& world) {
  WeightMap weights;
  double remaining = 1.0;
  for (int priority = 2; priority >= 0; --priority) {
    const auto indicator = [&](const LabelWeights::Part& part) {
      const Vec3 index = part.mask.grid.worldToIndex * world;
      const Size3 voxel = index.array().round().cast<std::int64_t>();
      const bool inside =
          (voxel.array() >= 0).all() && (voxel.array() < part.mask.grid.size.array()).all();
      return inside && part.priority == priority
                 ? part.mask.voxels[linearIndex(voxel, part.mask.grid.size)] / 255.0
                 : 0.0;
    };
    double sum = 0.0;
    for (const LabelWeights::Part& part : parts)
      sum += indicator(part);
    for (const LabelWeights::Part& part : parts)
      weights[part.component] += indicator(part) * (sum > remaining ? remaining / sum : 1.0);
    remaining -= std::min(remaining, sum);
  }
  weights[0] += remaining;
  return weights;
}

/// Calls visit(world point) for all voxel centers of a grid, including the outermost.
template <typename Visit>
void forEachVoxel(const Grid& grid, const Visit& visit) {
  for (std::int64_t z = 0; z < grid.size.z(); ++z)
    for (std::int64_t y = 0; y < grid.size.y(); ++y)
      for (std::int64_t x = 0; x < grid.size.x(); ++x)
        visit(grid.indexToWorld * Size3(x, y, z).cast<double>());
}

TEST(LabelWeights, MatchTheDefinitionAtVoxels) {
  const std::vector<LabelWeights::Part> parts = makeRandomParts(12);
  const LabelWeights weights = makeLabelWeights(parts);
  forEachVoxel(weights.grid(), [&](const Vec3& at) {
    WeightMap found = getWeights(weights, at), defined = computeExpected(parts, at);
    double sum = 0.0;
    for (const auto& [component, labelWeight] : found)
      sum += labelWeight;
    ASSERT_NEAR(sum, 1.0, 1e-12);
    for (const auto& [component, labelWeight] : defined)
      ASSERT_NEAR(found[component], labelWeight, 2.5 / 255.0)
          << component; // rounding of all weights
  });
  const auto last = [](const LabelWeights::Plane& plane) { return plane.isLast != 0; };
  EXPECT_FALSE(std::ranges::all_of(weights.planes(), last)); // some bricks have two planes
}

TEST(LabelWeights, AreTrilinearBetweenVoxelsAndAcrossBricks) {
  const LabelWeights weights = makeLabelWeights(makeRandomParts(12));
  const Grid& grid = weights.grid();
  for (int i = 0; i < 2000; ++i) {
    Random random(9, static_cast<std::uint64_t>(i), 0);
    const Vec3 last = (grid.size.array() - 1).cast<double>();
    const Vec3 index =
        last.cwiseProduct(Vec3(random.uniform(), random.uniform(), random.uniform()));
    const Vec3 low = index.array().floor().min(last.array() - 1.0), f = index - low;
    WeightMap mean;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
      const double weight =
          (step.array() * f.array() + (1.0 - step.array()) * (1.0 - f.array())).prod();
      for (const auto& [component, labelWeight] :
           getWeights(weights, grid.indexToWorld * (low + step)))
        mean[component] += weight * labelWeight;
    }
    WeightMap found = getWeights(weights, grid.indexToWorld * index);
    for (const auto& [component, labelWeight] : mean)
      ASSERT_NEAR(found[component], labelWeight, 1e-12);
  }
}

TEST(LabelWeights, DoNotDependOnTheOrderOfParts) {
  std::vector<LabelWeights::Part> parts = makeRandomParts(6); // of six components
  const LabelWeights weights = makeLabelWeights(parts);
  std::ranges::reverse(parts);
  const LabelWeights reversed = makeLabelWeights(parts);
  forEachVoxel(weights.grid(), [&](const Vec3& at) {
    ASSERT_EQ(getWeights(weights, at), getWeights(reversed, at));
  });
}

TEST(LabelWeights, RemainderIsZeroWhereThePlanesSumToOne) {
  const auto pattern = [](const Size3& v) { return (37 * v.x() + 91 * v.y() + 53 * v.z()) % 256; };
  const Size3 first(0, 0, 0), size(12, 9, 9);
  const auto makePart = [&](std::uint8_t component, const auto& value) {
    return LabelWeights::Part{makeMask(first, size, value), 1, component};
  };
  const LabelWeights weights = makeLabelWeights(
      {makePart(1, [&](const Size3& v) { return v.x() < 8 ? pattern(v) : 0; }),
       makePart(2, [&](const Size3& v) { return v.x() < 8 ? 255 - pattern(v) : 0; }),
       makePart(3, [](const Size3& v) { return v.x() < 8 ? 0 : 255; })});
  Random random(3, 0, 0);
  for (int i = 0; i < 2000; ++i) { // in bricks with all three components
    const Vec3 at(4.0 + 3.0 * random.uniform(), 8.0 * random.uniform(), 8.0 * random.uniform());
    weights.forEachWeight(at, [&](std::uint8_t component, double) { ASSERT_LT(component, 3); });
  }
  EXPECT_EQ(getWeights(weights, weights.grid().indexToWorld * Vec3(8, 3, 3)),
            (WeightMap{{3, 1.0}}));
}

TEST(LabelWeights, BricksOfOneComponentArePure) {
  const auto inside = [](const Size3&) { return 255; };
  const LabelWeights weights = makeLabelWeights({{makeMask({0, 0, 0}, {33, 9, 9}, inside), 1, 3}});
  EXPECT_EQ(weights.pureFraction(), 1.0);
  EXPECT_EQ(weights.bricks(), std::vector<std::int32_t>(8 * 2 * 2, 3));
  EXPECT_TRUE(weights.planes().empty());
}

TEST(LabelWeights, BricksOfTwoComponentsNeedOnePlane) {
  const auto half = [](const Size3& voxel) { return voxel.x() < 6 ? 255 : 0; };
  const LabelWeights weights = makeLabelWeights({{makeMask({0, 0, 0}, {13, 5, 5}, half), 1, 1}});
  EXPECT_EQ(weights.bricks(), (std::vector<std::int32_t>{1, ~0, 0}));
  EXPECT_EQ(weights.bytes(), 3 * sizeof(std::int32_t) + 128);
}

/// Components of different colors, except two with the medium's own.
TestScene makeTintedScene() {
  TestScene scene = makePartsScene();
  scene.tint = Tint{std::make_shared<const LabelWeights>(makeLabelWeights(makeRandomParts(12))),
                    {std::nullopt}};
  for (int i = 1; i <= 6; ++i)
    scene.tint->albedo.push_back(
        ColorFunction({{0.2, Rgb(0.15 * i, 0.5, 0.9 - 0.1 * i)}, {0.6, Rgb(0.9, 0.1 * i, 0.2)}}));
  scene.tint->albedo[2] = std::nullopt;
  return scene;
}

Film renderFilm(TestScene scene, bool isTinted, Integrator integrator) {
  if (!isTinted)
    scene.tint.reset();
  return renderFilm(scene, integrator);
}

TEST(Tint, SimdEqualsScalarIntegrator) {
  const TestScene scene = makeTintedScene();
  const Film simd = renderFilm(scene, true, Integrator::simd);
  const Film scalar = renderFilm(scene, true, Integrator::scalar);
  const Film untinted = renderFilm(scene, false, Integrator::scalar);
  const auto albedo = [](const PixelSums& pixel) { return Rgb(pixel.albedo / 64.0); };
  const auto radiance = [](const PixelSums& pixel) { return pixel.mean; };
  EXPECT_LT(computeRmsDifference(simd, scalar, albedo), 0.02);
  EXPECT_LT(computeRmsDifference(simd, scalar, radiance), 0.05);
  EXPECT_GT(computeRmsDifference(untinted, scalar, albedo), 0.03);
}

TEST(Tint, SimdFeaturesEqualScalarFeatures) {
  makeTintedScene().visitView([](const SceneView& scene) {
    ASSERT_TRUE(canUseSimd(scene));
    const FeatureBuffers simd = computeFeatures(scene), scalar = computeScalarFeatures(scene);
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < simd.hit.size(); ++i)
        sum += std::pow(static_cast<double>(simd.albedo[c][i] - scalar.albedo[c][i]), 2.0);
    EXPECT_LT(std::sqrt(sum / (3.0 * static_cast<double>(simd.hit.size()))), 0.02);
  });
}

TEST(Tint, ChangesOnlyColors) {
  const TestScene scene = makeTintedScene();
  for (const Integrator integrator : {Integrator::simd, Integrator::scalar}) {
    const Film untinted = renderFilm(scene, false, integrator),
               tinted = renderFilm(scene, true, integrator);
    for (std::size_t i = 0; i < untinted.pixelCount(); ++i) {
      const PixelSums &a = untinted.pixels()[i], &b = tinted.pixels()[i];
      ASSERT_EQ(a.alpha, b.alpha);
      ASSERT_EQ(a.depth, b.depth);
      ASSERT_EQ(a.collidedSamples, b.collidedSamples);
      ASSERT_TRUE(a.normal == b.normal);
    }
    EXPECT_GT(
        computeRmsDifference(untinted, tinted, [](const PixelSums& pixel) { return pixel.albedo; }),
        1.0);
  }
}

} // namespace
} // namespace fenestra::core::testing::LabelWeightsTests
