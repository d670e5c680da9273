// Coverage of the focus, and stopping during a long path.

#include "Support.h"

#include "metrics/FocusMetrics.h"

#include <gtest/gtest.h>

#include <thread>

namespace fenestra::core::testing::CoverageTests {
namespace {

/// Cube of 20 mm around the origin, extinction 0.1 per mm, seen from anterior. In every pixel the
/// focus is 5 mm behind the cube's face.
struct Cube {
  TestScene scene{
      makeVolume(makeCenteredGrid({10, 10, 10}, {2.0, 2.0, 2.0}), [](const Vec3&) { return 1.0; }),
      makeLinearTransfer(0.1, Rgb::Ones()),
      {EnvironmentLight{}},
      {},
      16,
      16};
  static constexpr double focusDepth = 95.0;

  Cube() {
    scene.pose.position = {0, 100, 0};
    scene.pose.target = Vec3::Zero();
    scene.pose.scale = 8.0;
  }

  double computeCoverage(const Vec3& origin, const Vec3& normal) const {
    const Camera camera(scene.pose, scene.width, scene.height);
    return computeCoverage(ClipPlane{camera, origin, normal});
  }

  double computeCoverage(const Clip& clip) const {
    const Camera camera(scene.pose, scene.width, scene.height);
    const LightSet lights(scene.lights, scene.volume.grid, camera);
    const MinMaxGrid ranges(scene.volume, 0);
    const MajorantGrid majorants(scene.volume.grid, ranges, scene.transfer, clip);
    const SceneView clipped{scene.volume, scene.transfer, majorants, lights, camera, clip};
    return measureCoverage(clipped, findFocusPoints(clipped, std::vector<double>(256, focusDepth)),
                           1);
  }
};

TEST(FocusCoverage, EqualsTheTransmittanceToTheFocus) {
  // Mean of 256 estimates of exp(-0.5), each 0 or 1.
  EXPECT_NEAR(Cube().computeCoverage(ClipNone{}), std::exp(-0.5), 4.0 * std::sqrt(0.25 / 256.0));
}

TEST(FocusCoverage, IsOneIfAPlaneClipsUpToTheFocus) {
  EXPECT_DOUBLE_EQ(Cube().computeCoverage(Vec3(0, 5.0, 0), Vec3::UnitY()), 1.0);
}

TEST(FocusCoverage, IsZeroIfTheFocusIsClipped) {
  const Cube cube;
  EXPECT_EQ(cube.computeCoverage(Vec3(0, 3.0, 0), Vec3::UnitY()), 0.0) << "clipped from in front";
  EXPECT_EQ(cube.computeCoverage(Vec3(0, 8.0, 0), -Vec3::UnitY()), 0.0) << "clipped from behind";
  EXPECT_EQ(cube.computeCoverage(Vec3(-50, 0, 0), Vec3::UnitX()), 0.0)
      << "the plane removes everything";
}

TEST(Render, StopsDuringALongPath) {
  TestScene scene = Cube().scene;
  scene.transfer = makeLinearTransfer(20000.0, Rgb::Ones()); // no absorption, hardly any escape
  const Camera camera(scene.pose, scene.width, scene.height);
  const LightSet lights(scene.lights, scene.volume.grid, camera);
  const MinMaxGrid ranges(scene.volume, 0);
  const MajorantGrid majorants(scene.volume.grid, ranges, scene.transfer, scene.clip);
  RenderMonitor monitor;
  std::thread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    monitor.stop = true;
  });
  const RenderResult result =
      render({scene.volume, scene.transfer, majorants, lights, camera, scene.clip}, {}, monitor);
  stopper.join();
  EXPECT_EQ(result.reason, StopReason::request);
  std::uint64_t samples = 0;
  for (const PixelSums& pixel : result.film.pixels())
    samples += pixel.samples;
  EXPECT_LT(samples, 64U * 256U) << "abandoned paths are not counted";
}

} // namespace
} // namespace fenestra::core::testing::CoverageTests
