// Mixtures: weighted extinctions, sampling of components, and equal images from both integrators.

#include "model/medium/Mixture.h"

#include "LabelWeightsTesting.h"
#include "denoise/features/FeatureBuffers.h"

#include <gtest/gtest.h>

#include <map>

namespace fenestra::core::testing::MixtureTests {
namespace {

Component makeComponent(double extinction, const Rgb& albedo, double g = 0.0) {
  return {makeLinearTransfer(extinction, albedo, g)};
}

/// Weight of component 1: x / 8 along a row of nine voxels, 0.5 mm apart; component 0 has the rest.
Mixture makeRampMixture() {
  const auto value = [](const Size3& voxel) {
    return std::lround(255.0 * static_cast<double>(voxel.x()) / 8.0);
  };
  const auto weights = std::make_shared<const LabelWeights>(
      makeLabelWeights({{makeMask({0, 0, 0}, {9, 2, 2}, value), 1, 1}}));
  return {weights, {makeComponent(1.0, Rgb::Ones()), makeComponent(3.0, Rgb::Ones())}};
}

std::map<int, double> listParts(const MixtureField& field, const MixturePoint& point) {
  std::map<int, double> parts;
  field.forEachPart(point, [&](const MixturePart& p) { parts[p.component] += p.extinction; });
  return parts;
}

TEST(Mixture, PartsAreWeightedExtinctions) {
  Mixture mixture = makeRampMixture();
  const MixtureField field(mixture, mixture.weights->grid());
  const MixturePoint point{Vec3(2.0, 0.5, 0.5), 0.5, 1.0};
  const double weight = 64.0 / 255.0; // 2 / 8 in 8 bits
  const std::map<int, double> parts = listParts(field, point);
  EXPECT_NEAR(parts.at(0), 0.5 * (1.0 - weight), 1e-12);
  EXPECT_NEAR(parts.at(1), 1.5 * weight, 1e-12);
  EXPECT_NEAR(field.extinction(point), parts.at(0) + parts.at(1), 1e-12);

  mixture.components[1].isClipped = false;
  const MixtureField unclipped(mixture, mixture.weights->grid());
  EXPECT_TRUE(unclipped.hasUnclipped());
  EXPECT_FALSE(field.hasUnclipped());
  EXPECT_NEAR(unclipped.extinction({point.index, 0.5, 0.25}), 0.25 * parts.at(0) + parts.at(1),
              1e-12);
  EXPECT_EQ(listParts(unclipped, {point.index, 0.5, 0.0}).count(0), 0U)
      << "empty parts are skipped";
}

TEST(Mixture, ComponentsAreSampledByExtinction) {
  const Mixture mixture = makeRampMixture();
  const MixtureField field(mixture, mixture.weights->grid());
  const MixturePoint point{Vec3(3.0, 0.5, 0.5), 0.5, 1.0};
  Random random(5, 0, 0);
  constexpr int samples = 40000;
  int second = 0;
  for (int i = 0; i < samples; ++i)
    second += field.sampleComponent(point, random);
  const double expected = listParts(field, point).at(1) / field.extinction(point);
  const double error = std::sqrt(expected * (1.0 - expected) / samples);
  EXPECT_NEAR(second / double{samples}, expected, 4.0 * error);
  EXPECT_GT(expected, 0.62) << "label weights alone would give 3/8";

  Random single(5, 0, 0), unused(5, 0, 0);
  EXPECT_EQ(field.sampleComponent({Vec3(8.0, 0.0, 0.0), 0.5, 1.0}, single), 1);
  EXPECT_EQ(field.sampleComponent({Vec3(3.0, 0.5, 0.5), 0.0, 1.0}, single), 0) << "no extinction";
  EXPECT_EQ(single.bits(), unused.bits()) << "a single component needs no random number";
}

TEST(Mixture, WeightGradientsAreInWorldSpace) {
  const Mixture mixture = makeRampMixture();
  const MixtureField field(mixture, mixture.weights->grid());
  const Vec3 gradient = field.weightGradient(1, Vec3(4.0, 0.5, 0.5));
  EXPECT_LT((gradient - Vec3(0.25, 0.0, 0.0)).norm(), 1e-2) << "1/8 per voxel of 0.5 mm";
  EXPECT_LT((field.weightGradient(0, Vec3(4.0, 0.5, 0.5)) + gradient).norm(), 1e-12);
}

/// Dense medium of seven components that differ in every property; two are not clipped.
TestScene makeMixtureScene(bool isHybrid) {
  TestScene scene = makePartsScene();
  if (isHybrid)
    scene.transfer.shading = SurfaceShading{};
  Mixture mixture{std::make_shared<const LabelWeights>(makeLabelWeights(makeRandomParts(12))), {}};
  for (int i = 0; i <= 6; ++i) {
    Component component = makeComponent(0.2 + 0.3 * i, Rgb(0.15 * i, 0.5, 0.9 - 0.1 * i),
                                        i < 4 ? 0.0 : 0.15 * i - 0.9);
    component.transfer.extinction =
        ScalarFunction({makeKnot(0.25, 0.1 * i), makeKnot(0.4 + 0.01 * i, 0.2 + 0.3 * i)});
    component.isClipped = i % 3 != 2;
    if (isHybrid)
      component.transfer.shading = SurfaceShading::makeCoated(0.1 * i, 0.2 + 0.1 * i);
    mixture.components.push_back(component);
  }
  scene.mixture = std::move(mixture);
  const Vec3 center = scene.volume.grid.worldCenter();
  const Camera camera(scene.pose, scene.width, scene.height);
  scene.clip = ClipPlane{camera, center, Vec3(0.3, -1.0, 0.2).normalized(), {0.0, 3.0}};
  return scene;
}

constexpr double filmSamples = 64.0; ///< samples per pixel of renderFilm

/// Mean depth of the first collisions, mm.
double computeMeanDepth(const Film& film) {
  double sum = 0.0, count = 0.0;
  for (const PixelSums& pixel : film.pixels()) {
    sum += pixel.depth;
    count += static_cast<double>(pixel.collidedSamples);
  }
  return sum / count;
}

TEST(Mixture, SimdMatchesScalarIntegrator) {
  for (const bool isHybrid : {false, true}) {
    const TestScene scene = makeMixtureScene(isHybrid);
    scene.visitView([](const SceneView& all) { ASSERT_TRUE(canUseSimd(all)); });
    const Film simd = renderFilm(scene, Integrator::simd);
    const Film scalar = renderFilm(scene, Integrator::scalar);
    const auto albedo = [](const PixelSums& pixel) { return Rgb(pixel.albedo / filmSamples); };
    EXPECT_LT(computeRmsDifference(simd, scalar, albedo), 0.04) << isHybrid;
    EXPECT_NEAR(computeMeanDepth(simd), computeMeanDepth(scalar), 0.1) << isHybrid;
    const Estimate a = estimateMean(simd), b = estimateMean(scalar);
    EXPECT_LT(std::abs(a.mean - b.mean), 4.0 * std::hypot(a.error, b.error)) << isHybrid;
  }
}

TEST(Mixture, SimdFeaturesMatchScalarFeatures) {
  makeMixtureScene(true).visitView([](const SceneView& scene) {
    const FeatureBuffers simd = computeFeatures(scene), scalar = computeScalarFeatures(scene);
    double albedo = 0.0, hit = 0.0;
    for (std::size_t i = 0; i < simd.hit.size(); ++i) {
      hit += std::pow(static_cast<double>(simd.hit[i] - scalar.hit[i]), 2.0);
      for (std::size_t c = 0; c < 3; ++c)
        albedo += std::pow(static_cast<double>(simd.albedo[c][i] - scalar.albedo[c][i]), 2.0);
    }
    const auto n = static_cast<double>(simd.hit.size());
    EXPECT_LT(std::sqrt(albedo / (3.0 * n)), 0.02);
    EXPECT_LT(std::sqrt(hit / n), 0.02);
  });
}

/// Only the unclipped components are visible if the clip plane removes everything else.
TEST(Mixture, ClipPreservesUnclippedComponents) {
  TestScene scene = makeMixtureScene(false);
  const Vec3 center = scene.volume.grid.worldCenter();
  const Camera camera(scene.pose, scene.width, scene.height);
  const auto countVisible = [&](Integrator integrator) {
    const Film film = renderFilm(scene, integrator);
    double sum = 0.0;
    for (const PixelSums& pixel : film.pixels())
      sum += static_cast<double>(pixel.collidedSamples);
    return sum / filmSamples;
  };
  scene.clip = ClipPlane{camera, center - 100.0 * Vec3::UnitY(), Vec3(0.0, 1.0, 0.0)};
  for (const Integrator integrator : {Integrator::simd, Integrator::scalar})
    EXPECT_GT(countVisible(integrator), 5.0) << "pixels";
  for (Component& component : scene.mixture->components)
    component.isClipped = true;
  for (const Integrator integrator : {Integrator::simd, Integrator::scalar})
    EXPECT_EQ(countVisible(integrator), 0.0);
}

TEST(Mixture, InterfaceSurfacesRequireScalarIntegrator) {
  TestScene scene = makeMixtureScene(true);
  scene.mixture->components[3].interfaceWeight = 0.5;
  scene.visitView([](const SceneView& all) { EXPECT_FALSE(canUseSimd(all)); });
}

} // namespace
} // namespace fenestra::core::testing::MixtureTests
