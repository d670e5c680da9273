#pragma once
// Scenes for tests of the GPU, and comparisons of its films.

#include "Gpu/DeviceTesting.h"
#include "Gpu/Twin.h"
#include "Statistical/Matrix.h"
#include "Unit/FilmTesting.h"
#include <gtest/gtest.h>

namespace fenestra::core::testing {

/// Skips each test where no device can be opened.
class GpuTest : public ::testing::Test {
protected:
  void SetUp() override {
    if (const std::string obstacle = findDeviceObstacle(); !obstacle.empty())
      GTEST_SKIP() << obstacle;
  }
};

inline RenderResult renderOnGpu(const TestScene& scene, RenderSettings settings) {
  settings.integrator = Integrator::gpu;
  RenderResult result = scene.render(settings);
  EXPECT_EQ(result.target, findDeviceTarget());
  EXPECT_EQ(result.gpuFailure, "");
  return result;
}

inline twin::Result renderTwin(const TestScene& scene, const RenderSettings& settings) {
  return scene.visitView([&](const SceneView& view) { return twin::render(view, settings); });
}

/// Expects equal films, as expectIdentical, where NaN equals NaN.
void expectSameBits(const Film& a, const Film& b);

inline void expectEqualCounters(const Counters& a, const Counters& b) {
  EXPECT_EQ(a.paths, b.paths);
  EXPECT_EQ(a.collisions, b.collisions);
  EXPECT_EQ(a.lookups, b.lookups);
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_EQ(a.skippedCells, b.skippedCells);
  EXPECT_EQ(a.shadowRays, b.shadowRays);
  EXPECT_EQ(a.gradients, b.gradients);
}

/// A small scene, and how it is rendered.
struct GpuScene {
  std::string name;
  TestScene scene;
  RenderSettings settings;
};

/// A combination of the matrix without clip, crop, surfaces and segments.
Combination makeSimpleCombination(int index, VoxelFactor voxels, GridFactor grid,
                                  LightFactor light);

/// Scenes that together have every feature of the shader.
const std::vector<GpuScene>& featureScenes();
const GpuScene& findFeatureScene(const std::string& name);

} // namespace fenestra::core::testing
