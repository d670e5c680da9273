// Extreme scenes: the GPU and the twin handle them alike, bit for bit, and both end.

#include "Gpu/GpuTesting.h"

namespace fenestra::core::testing::GpuStressTests {
namespace {

/// Float voxels lit by a sky and a sun, with surfaces, so that all scenes have the same pipeline.
template <typename Function>
TestScene makeScene(const Size3& size, double extinction, Function&& value) {
  TestScene scene{makeVolume<float>(makeCenteredGrid(size, Vec3::Ones()), value),
                  makeLinearTransfer(extinction, Rgb(0.9, 0.8, 0.7), 0.4),
                  {EnvironmentLight{}, DirectionalLight{}},
                  {}};
  scene.transfer.shading = SurfaceShading{};
  scene.pose.position = {0.0, -60.0, 10.0};
  scene.pose.target = Vec3::Zero();
  scene.pose.scale = 7.0;
  return scene;
}

double makeWaves(const Vec3& p) {
  return 0.5 + 0.5 * std::sin(p.x()) * std::cos(p.y() + p.z());
}

const Size3 cube(10, 10, 10);

/// The film of the GPU, which is the twin's.
Film expectTwin(const TestScene& scene) {
  RenderSettings settings;
  settings.samples = 4;
  settings.path.bounces = 1000; // also ends paths that nothing absorbs
  const twin::Result expected = renderTwin(scene, settings);
  const RenderResult result = renderOnGpu(scene, settings);
  expectSameBits(result.film, expected.film);
  expectEqualCounters(result.counters, expected.counters);
  return result.film;
}

double sumRadiance(const Film& film) {
  double sum = 0.0;
  for (const PixelSums& pixel : film.pixels())
    sum += pixel.mean.sum();
  return sum;
}

class GpuStress : public GpuTest {};

TEST_F(GpuStress, NotANumber) {
  for (const float odd :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity(), std::numeric_limits<float>::max(),
        std::numeric_limits<float>::denorm_min()}) {
    SCOPED_TRACE(odd);
    expectTwin(makeScene(cube, 1.0, [&](const Vec3& p) {
      const bool isOdd = std::fmod(p.x() + 3.0 * p.y() + 5.0 * p.z(), 7.0) == 0.0;
      return isOdd ? static_cast<double>(odd) : makeWaves(p);
    }));
  }
}

TEST_F(GpuStress, NoExtinction) {
  const Film film = expectTwin(makeScene(cube, 0.0, makeWaves));
  for (const PixelSums& pixel : film.pixels())
    EXPECT_EQ(pixel.collidedSamples, 0U);
}

TEST_F(GpuStress, TinyAndHugeExtinction) {
  for (const double extinction : {1e-30, 1e-8, 1e3, 5e3})
    expectTwin(makeScene(cube, extinction, makeWaves));
}

TEST_F(GpuStress, ExtinctionBeyondFloatNeedsTheCpu) {
  RenderSettings settings;
  settings.integrator = Integrator::gpu;
  makeScene(cube, 1e6, makeWaves).visitView([&](const SceneView& scene) {
    EXPECT_EQ(findGpuObstacle(scene), "the scene needs double precision");
  });
}

TEST_F(GpuStress, OneSlice) {
  for (const Size3& size : {Size3(16, 16, 1), Size3(16, 1, 16), Size3(2, 2, 1), Size3(64, 1, 1)})
    EXPECT_GT(sumRadiance(expectTwin(makeScene(size, 1.0, makeWaves))), 0.0);
}

/// Camera rays along faces of voxels, within rounding, and along the volume's own faces.
TEST_F(GpuStress, GrazingRays) {
  for (const double height : {0.0, 1.0, 5.0, 4.99999999, 5.00000001, -5.0}) {
    TestScene scene = makeScene(cube, 1.0, makeWaves);
    scene.pose.position = {0.0, -60.0, height};
    scene.pose.target = {0.0, 0.0, height};
    scene.pose.scale = 1e-6;
    expectTwin(scene);
  }
}

TEST_F(GpuStress, FarCameras) {
  for (const double distance : {1e3, 1e6, 1e9}) {
    TestScene scene = makeScene(cube, 1.0, makeWaves);
    scene.pose.position = {0.0, -distance, 0.1 * distance};
    EXPECT_GT(sumRadiance(expectTwin(scene)), 0.0);
  }
}

} // namespace
} // namespace fenestra::core::testing::GpuStressTests
