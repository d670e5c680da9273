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
