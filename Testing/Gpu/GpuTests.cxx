// The GPU and the twin trace the same paths, operation by operation: their films and counters are
// equal, bit for bit.

#include "Gpu/GpuTesting.h"

#include <bit>
#include <set>

namespace fenestra::core::testing::GpuTests {
namespace {

class GpuBits : public GpuTest, public ::testing::WithParamInterface<const char*> {};

TEST_P(GpuBits, EqualTheTwins) {
  const GpuScene& s = findFeatureScene(GetParam());
  const twin::Result expected = renderTwin(s.scene, s.settings);
  const RenderResult result = renderOnGpu(s.scene, s.settings);
  expectIdentical(result.film, expected.film);
  expectEqualCounters(result.counters, expected.counters);
  EXPECT_GT(result.counters.lookups, 100U);
}

INSTANTIATE_TEST_SUITE_P(Scenes, GpuBits,
                         ::testing::Values("sky", "plane", "cutaway", "surface", "tint", "mixture",
                                           "hole", "unscattered"),
                         [](const auto& info) { return std::string(info.param); });

/// Every constant of the shader is 0 in a scene and not 0 in another, and has all its values.
TEST(GpuFeatures, AreAllInTheScenes) {
  constexpr std::size_t count = sizeof(gpu::Features) / sizeof(std::int32_t);
  std::array<std::set<std::int32_t>, count> values;
  std::set<std::int32_t> voxelKinds, clipKinds, componentKinds;
  for (const GpuScene& s : featureScenes()) {
    const gpu::Features features = renderTwin(s.scene, s.settings).features;
    const auto numbers = std::bit_cast<std::array<std::int32_t, count>>(features);
    for (std::size_t i = 0; i < count; ++i)
      values[i].insert(std::min(numbers[i], 1));
    voxelKinds.insert(features.voxelKind);
    clipKinds.insert(features.clipKind);
    componentKinds.insert(features.componentKind);
  }
  for (std::size_t i = 0; i < count; ++i)
    EXPECT_EQ(values[i].size(), 2U) << "constant " << i << " of Features";
  EXPECT_EQ(voxelKinds.size(), 4U);
  EXPECT_EQ(clipKinds.size(), 4U);
  EXPECT_EQ(componentKinds.size(), 3U);
}

/// One kind of light at a time: the shader has loops of its own over lists of lights.
class GpuLights : public ::testing::TestWithParam<LightFactor> {};

TEST_P(GpuLights, AreThoseOfTheSimdIntegrator) {
  Combination c = makeSimpleCombination(0, VoxelFactor::int16, GridFactor::cubes, GetParam());
  MatrixScene made = makeMatrixScene(c);
  made.settings.samples = 4;
  const Film simd = made.fenestra.render(made.settings).film,
             twin = renderTwin(made.fenestra, made.settings).film;
  Rgb sum = Rgb::Zero();
  std::size_t different = 0;
  for (std::size_t i = 0; i < simd.pixelCount(); ++i) {
    const Rgb expected = simd.pixels()[i].mean, mean = twin.pixels()[i].mean;
    sum += expected;
    different += (mean - expected).abs().maxCoeff() > 1e-4 * (1.0 + expected.maxCoeff()) ? 1 : 0;
  }
  EXPECT_GT(sum.minCoeff(), 0.01 * static_cast<double>(simd.pixelCount()));
  EXPECT_LE(different, simd.pixelCount() / 50) << "paths that rounding sends elsewhere";
}

INSTANTIATE_TEST_SUITE_P(Kinds, GpuLights,
                         ::testing::Values(LightFactor::constant, LightFactor::map,
                                           LightFactor::directional, LightFactor::rectangle,
                                           LightFactor::disk, LightFactor::sky, LightFactor::sphere,
                                           LightFactor::several));

/// Sizes of a render's parts: the device's work, and passes.
struct Slicing {
  gpu::BatchLimits limits;
  std::uint64_t passSamples;
};

class GpuSlicing : public GpuTest {};

TEST_F(GpuSlicing, ChangesNoBit) {
  const GpuScene& s = findFeatureScene("surface");
  const RenderResult once = renderOnGpu(s.scene, s.settings);
  constexpr Slicing slicings[] = {{{.threads = 64, .paths = 100, .maxSteps = 1}, 4},
                                  {{.threads = 128, .paths = 64, .maxSteps = 7}, 1},
                                  {{.threads = 64, .paths = 1024, .maxSteps = 64}, 3},
                                  {{.threads = 1024, .paths = 333, .maxSteps = 40}, 4}};
  for (const auto& [limits, passSamples] : slicings) {
    RenderSettings settings = s.settings;
    settings.batchLimits = limits;
    settings.passSamples = passSamples;
    const RenderResult result = renderOnGpu(s.scene, settings);
    expectIdentical(result.film, once.film);
    expectEqualCounters(result.counters, once.counters);
  }
}

} // namespace
} // namespace fenestra::core::testing::GpuTests
