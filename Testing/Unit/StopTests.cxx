// Stops a render while paths are being traced, for all kinds of media.

#include "Support.h"

#include "integrator/simd/Tracker.h"
#include "metrics/FocusMetrics.h"

#include <gtest/gtest.h>

#include <future>
#include <thread>

namespace fenestra::core::testing::StopTests {
namespace {

/// Scene with voxels of 1e8 mm whose corner cells have majorant 1 / mm, although the extinction is
/// almost 0 along nearly every ray: about 1e8 null collisions per ray.
TestScene makeEndlessScene() {
  const Grid grid = makeCenteredGrid({4, 4, 4}, Vec3::Constant(1e8));
  TestScene s{makeVolume(grid, [](const Vec3& p) { return p.isZero() ? 255.0 : 0.0; }),
              {ScalarFunction({makeKnot(0.0, 1e-12), makeKnot(250.0, 1e-12), makeKnot(255.0, 1.0)}),
               ColorFunction({{0.0, Rgb::Ones()}})},
              {EnvironmentLight{}},
              {}};
  s.pose.position = {0, -1e9, 0};
  s.pose.target = Vec3::Zero();
  s.pose.scale = 1e8;
  return s;
}

/// Calls work(scene, majorants, ray) with a ray through these cells.
template <typename Work>
void visitEndlessRay(Work&& work) {
  const TestScene s = makeEndlessScene();
  const MajorantGrid majorants(s.volume.grid, MinMaxGrid(s.volume, 0), s.transfer, s.clip);
  work(s, majorants, Ray{Vec3(-1.2e8, -1e9, -1.2e8), Vec3::UnitY()});
}

TEST(Stop, EndsTrackingWithoutCollision) {
  visitEndlessRay([](const TestScene& s, const MajorantGrid& majorants, const Ray& ray) {
    const StopFlag stop = true;
    const Medium<float> medium(s.volume.grid, std::get<LargeArray<float>>(s.volume.voxels),
                               s.transfer, nullptr);
    const Tracker<float> tracker(s.volume.grid, medium, majorants, s.clip, stop);
    Random random(1, 2, 3);
    Counters counters;
    tracker.sampleCollision(ray, {}, random.uniform2(), random, counters);
    EXPECT_EQ(counters.lookups, stopPollInterval);
    tracker.transmittance(ray, {}, random, counters);
    EXPECT_EQ(counters.lookups, 2 * stopPollInterval);
  });
}

TEST(Stop, EndsTrackingOfARayBatch) {
  visitEndlessRay([](const TestScene& s, const MajorantGrid& majorants, const Ray& ray) {
    const StopFlag stop = true;
    const Domain domain(s.volume.grid);
    const SimdTracker tracker(s.volume, domain, s.transfer, majorants, s.clip, nullptr, stop);
    const auto rays = std::make_unique<RayBatch>();
    for (std::size_t& i = rays->size; i < RayBatch::capacity; ++i) {
      setDomainRay(*rays, i, domain, ray, {});
      rays->depthBits[i] = static_cast<std::uint32_t>(i);
      rays->acceptance[i] = 0.5F;
    }
    Counters counters;
    tracker.sampleCollisions(*rays, counters);
    tracker.estimateTransmittances(*rays, counters);
    constexpr std::uint64_t maxLanes = 2 * 16; // two sets of at most 16 (AVX-512)
    EXPECT_LE(counters.lookups, 2 * stopPollInterval * maxLanes);
  });
}

/// Without the stop, each metric would take minutes.
TEST(Stop, EndsComputationOfFocusMetrics) {
  const TestScene s = makeEndlessScene();
  const Camera camera(s.pose, s.width, s.height);
  const LightSet lights(s.lights, s.volume.grid, camera);
  const MajorantGrid majorants(s.volume.grid, MinMaxGrid(s.volume, 0), s.transfer, s.clip);
  const SceneView scene{s.volume, s.transfer, majorants, lights, camera, s.clip};
  const auto pixels = static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height);
  const FocusPoints points = findFocusPoints(scene, std::vector<double>(pixels, 2e9));
  const StopFlag stop = true;
  EXPECT_GE(measureCoverage(scene, points, 1, stop), 0.0);
  measureLight(scene, scene, points, 1, stop);
}

/// A stopped path is discarded together with its tile; tiles whose paths have all ended are kept.
TEST(Stop, EndsARenderWithEndlessPaths) {
  const TestScene s = makeEndlessScene();
  const Camera camera(s.pose, s.width, s.height);
  const LightSet lights(s.lights, s.volume.grid, camera);
  const MajorantGrid majorants(s.volume.grid, MinMaxGrid(s.volume, 0), s.transfer, s.clip);
  for (const Integrator integrator : {Integrator::scalar, Integrator::simd}) {
    RenderMonitor monitor;
    RenderSettings settings;
    settings.integrator = integrator;
    auto rendering = std::async(std::launch::async, [&] {
      return render({s.volume, s.transfer, majorants, lights, camera, s.clip}, settings, monitor);
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    monitor.stop = true;
    const RenderResult result = rendering.get();
    EXPECT_EQ(result.reason, StopReason::request);
    constexpr int tile = 8; // pixels; paths in the volume's corners do not end
    std::uint64_t minSamples = std::numeric_limits<std::uint64_t>::max();
    for (int row = 0; row < s.height; ++row)
      for (int column = 0; column < s.width; ++column) {
        const std::uint64_t samples = result.film.at(column, row).samples;
        minSamples = std::min(minSamples, samples);
        EXPECT_EQ(samples, result.film.at(column / tile * tile, row / tile * tile).samples);
      }
    EXPECT_EQ(minSamples, 0U);
  }
}

} // namespace
} // namespace fenestra::core::testing::StopTests
