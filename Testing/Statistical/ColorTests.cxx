// A thick medium in an environment of 1, seen from the front, must have the requested color.

#include "Slab.h"

#include "model/medium/Reflectance.h"
#include "scene/SegmentTint.h"

namespace fenestra::core::testing::ColorTests {
namespace {

/// Thickness in free paths that replaces a half-space; grows with the transport mean free path.
double halfSpaceThickness(double g) {
  return 300.0 / (1.0 - g);
}

/// Bounds of expectMean(): largest standard error of a render, and error of toAlbedo(), relative.
constexpr double maxRelativeError = 0.02, albedoError = 0.03;

class RenderedColor : public ::testing::TestWithParam<double> {};

TEST_P(RenderedColor, VolumeShadingMatches) {
  const double g = GetParam();
  for (const Rgb& color : {Rgb(0.05, 0.1, 0.2), Rgb(0.35, 0.5, 0.65), Rgb(0.8, 0.9, 0.05)}) {
    TestScene scene = makeWideSlab(halfSpaceThickness(g), toAlbedo(color, g));
    scene.transfer.g = g;
    expectMean(renderMean(scene, 400, 41), color, maxRelativeError, albedoError);
  }
}

/// Slab that is completely one segment of `color` and mean cosine g, in a volume of another g.
TestScene makeMaterialSlab(const Rgb& color, double g) {
  TestScene scene = makeWideSlab(halfSpaceThickness(g), Rgb::Constant(0.5));
  scene.transfer.g = 0.3;
  TintPlan plan{{}, std::vector<SegmentMedium>(2), {}, {}};
  Material& material = plan.components[1].material;
  material.kind = MaterialKind::medium;
  material.color = ColorFunction({{0.0, color}});
  material.extinction = ScalarFunction({makeKnot(0.0, 0.5)});
  material.g = g;
  plan.components[1].density = 2.0;
  const Mask all{scene.volume.grid, std::vector<std::uint8_t>(8, 1), 8, {}};
  const auto weights = std::make_shared<const LabelWeights>(makeLabelWeights({{all, 10, 1}}));
  const Tint tint = buildTint(std::make_shared<const TintPlan>(plan), weights, scene.transfer.g);
  scene.mixture = buildMixture(plan, tint, scene.transfer);
  return scene;
}

TEST_P(RenderedColor, SegmentMatches) {
  for (const Rgb& color : {Rgb(0.05, 0.1, 0.2), Rgb(0.35, 0.5, 0.65), Rgb(0.8, 0.9, 0.05)})
    expectMean(renderMean(makeMaterialSlab(color, GetParam()), 100, 45), color,
               2.0 * maxRelativeError, albedoError);
}

INSTANTIATE_TEST_SUITE_P(Anisotropies, RenderedColor, ::testing::Values(0.0, 0.5, 0.9));

/// Medium of `color` below air, with a surface of hybrid shading: the scalar goes from 0 to 1
/// within `ramp` mm.
TestScene makeStepScene(const Rgb& color, double ramp, const SurfaceShading& shading) {
  const Grid grid = makeCenteredGrid({2, 2, 400}, {10000.0, 10000.0, ramp});
  TestScene scene = makeWideSlab(400.0 * ramp, Rgb::Zero());
  scene.volume = makeVolume(grid, [](const Vec3& index) { return index.z() < 396.0 ? 1.0 : 0.0; });
  scene.transfer = {ScalarFunction({makeKnot(0.0, 0.0), makeKnot(1.0, 3.0)}),
                    ColorFunction({{0.0, toAlbedo(color, 0.0)}}),
                    {},
                    0.0,
                    shading};
  return scene;
}

TEST(RenderedColor, HybridShadingNearlyMatches) {
  const SurfaceShading skin = SurfaceShading::makeCoated(0.2, 0.4);
  for (const double ramp : {1.0, 3.0})
    for (const Rgb& color : {Rgb(0.05, 0.1, 0.2), Rgb(0.35, 0.5, 0.65), Rgb(0.8, 0.9, 0.05)}) {
      const RgbEstimate estimate = renderMean(makeStepScene(color, ramp, skin), 400, 43);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(estimate.mean[c], color[c],
                    4.0 * estimate.error[c] + std::max(0.015, 0.1 * color[c]))
            << "ramp " << ramp << ", channel " << c;
    }
}

/// Diffuse 1 without a coat: surfaces lose no energy.
TEST(Furnace, WhiteSurfaceHasRadianceOne) {
  TestScene scene = makeStepScene(Rgb::Ones(), 0.5, SurfaceShading::makeCoated(0.0, 0.4));
  scene.transfer.albedo = ColorFunction({{0.0, Rgb::Ones()}});
  const RgbEstimate estimate = renderMean(scene, 400, 47);
  EXPECT_NEAR(estimate.mean[0], 1.0, 4.0 * estimate.error[0] + 1e-6); // SIMD code uses float
  EXPECT_LT(estimate.error[0], 0.01);
}

/// Coat and base together reflect all light except a few thousandths, in both integrators.
TEST(Furnace, CoatedWhiteSurfaceHasNearlyRadianceOne) {
  TestScene scene = makeStepScene(Rgb::Ones(), 0.5, SurfaceShading::makeCoated(0.5, 0.4));
  scene.transfer.albedo = ColorFunction({{0.0, Rgb::Ones()}});
  for (const Integrator integrator : {Integrator::simd, Integrator::scalar}) {
    RenderSettings settings;
    settings.samples = 40;
    settings.integrator = integrator;
    const RgbEstimate estimate = estimateRgb(scene.render(settings).film);
    EXPECT_GT(estimate.mean[0], 0.985);
    EXPECT_LE(estimate.mean[0], 1.0 + 4.0 * estimate.error[0]);
  }
}

} // namespace
} // namespace fenestra::core::testing::ColorTests
