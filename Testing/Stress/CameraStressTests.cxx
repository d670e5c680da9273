// Cameras inside the volume, on faces and corners of voxels, with extreme angles and image sizes,
// against the chord of each ray; and the sharpest phase functions.

#include "StressSupport.h"

namespace fenestra::core::testing::CameraStressTests {
namespace {

constexpr double sigma = 0.25;

/// Absorbing volume of 6 x 5 x 4 mm in an environment of 1.
TestScene makeAbsorber(const CameraPose& pose, int width, int height) {
  return {makeVolume(makeCenteredGrid({6, 5, 4}, Vec3::Ones()), [](const Vec3&) { return 1.0; }),
          makeLinearTransfer(sigma, Rgb::Zero()),
          {EnvironmentLight{}},
          pose,
          width,
          height};
}

/// Camera ray through a raster position; rows count from the top. `scale` is half the image's
/// height, `angle` covers the full height.
Ray makeCameraRay(const CameraPose& pose, int width, int height, double column, double row) {
  const Vec3 forward = (pose.target - pose.position).normalized();
  const Vec3 right = forward.cross(pose.up).normalized();
  const Vec3 up = right.cross(forward);
  const double x = (2.0 * column - width) / height; // in half heights
  const double y = 1.0 - 2.0 * row / height;
  const Vec3 offset = x * right + y * up;
  if (pose.projection == Projection::orthographic)
    return {pose.position + pose.scale * offset, forward};
  const double slope = std::tan(0.5 * pose.angle * pi / 180.0);
  return {pose.position, (forward + slope * offset).normalized()};
}

/// Expects each pixel to equal the mean of exp(-sigma chord) over its area: the sum of z^2 (Wilson
/// and Hilferty 1931) and the sum of the differences within 4 of their standard errors. Samples are
/// 0 or 1, so the variance is known. The expected mean is computed from a raster of rays. It is
/// finer in the long version, whose errors are as small as the raster's error at the box's
/// silhouette.
void expectChords(const TestScene& scene, int samples) {
  const int subdivisions = isLongRun() ? 128 : 16;
  const RenderResult result = renderScene(scene, samples);
  double chi2 = 0.0, difference = 0.0, variance = 0.0;
  int pixels = 0;
  for (int row = 0; row < scene.height; ++row)
    for (int column = 0; column < scene.width; ++column) {
      double expected = 0.0;
      for (int i = 0; i < subdivisions * subdivisions; ++i) {
        const Ray ray = makeCameraRay(scene.pose, scene.width, scene.height,
                                      column + (i % subdivisions + 0.5) / subdivisions,
                                      row + (i / subdivisions + 0.5) / subdivisions);
        expected +=
            std::exp(-sigma * chord(scene.volume.grid, ray)) / (subdivisions * subdivisions);
      }
      const double mean = result.film.at(column, row).mean[0];
      if (expected > 1.0 - 1e-12) {
        ASSERT_EQ(mean, 1.0);
        continue;
      }
      const double v = expected * (1.0 - expected) / samples;
      chi2 += std::pow(mean - expected, 2.0) / v;
      difference += mean - expected;
      variance += v;
      ++pixels;
    }
  ASSERT_GT(pixels, 0);
  const double spread = 2.0 / (9.0 * pixels);
  EXPECT_LT((std::cbrt(chi2 / pixels) - (1.0 - spread)) / std::sqrt(spread), 4.0)
      << "mean squared z " << chi2 / pixels;
  EXPECT_LT(std::abs(difference), 4.0 * std::sqrt(variance));
}

CameraPose makePose(Projection projection, const Vec3& position, const Vec3& forward) {
  CameraPose result;
  result.projection = projection;
  result.position = position;
  result.target = position + 2.0 * forward;
  result.up = std::abs(forward.normalized().z()) > 0.9 ? Vec3(Vec3::UnitY()) : Vec3(Vec3::UnitZ());
  result.scale = 2.5;
  result.angle = 60.0;
  return result;
}

TEST(CameraInsideVolume, TransmittanceFollowsChordAhead) {
  // Voxel centers are at half-integers in x and z, at integers in y.
  const Vec3 positions[] = {{0.5, 0.0, 0.5},  {0.0, 0.0, 0.0}, {0.0, 0.5, 1.0}, {0.5, 0.5, 0.5},
                            {3.0, 0.0, 0.0},  {3.0, 2.5, 2.0}, {3.0, 2.5, 0.3}, {2.9, 2.4, 1.9},
                            {-3.0, 0.1, 0.2}, {0.0, -2.5, 0.0}};
  const Vec3 directions[] = {{1, 0, 0},  {-1, 0, 0},  {0, 1, 0}, {0, -1, 0},  {0, 0, 1},
                             {0, 0, -1}, {-1, -1, 0}, {1, 1, 1}, {-1, -1, -1}};
  for (const Projection projection : {Projection::orthographic, Projection::perspective})
    for (const Vec3& position : positions)
      for (const Vec3& direction : directions) {
        const TestScene scene = makeAbsorber(makePose(projection, position, direction), 8, 8);
        bool isLeaving = false;
        for (int axis = 0; axis < 3; ++axis)
          isLeaving = isLeaving || (std::abs(position[axis]) == Vec3(3.0, 2.5, 2.0)[axis] &&
                                    direction[axis] * position[axis] > 0.0);
        SCOPED_TRACE((std::ostringstream() << position << " | " << direction).str());
        if (isLeaving && projection == Projection::orthographic &&
            direction.cwiseAbs().sum() == 1.0)
          ASSERT_EQ(estimateMean(renderScene(scene, 4).film).mean, 1.0); // nothing ahead
        else if (!isLeaving)
          expectChords(scene, scaleSamples(200));
      }
}

TEST(CameraInsideVolume, FurnaceIsOne) {
  TestScene scene =
      makeAbsorber(makePose(Projection::perspective, {0.5, 0.5, 0.5}, {1, 1, 1}), 12, 12);
  scene.transfer = makeLinearTransfer(2.0, Rgb::Ones());
  expectRadianceOne(renderScene(scene, scaleSamples(100)));
}

TEST(FieldOfView, MillionthOfDegreeEqualsOrthographic) {
  constexpr double angle = 1e-6;
  CameraPose near = makePose(Projection::orthographic, {20.0, -30.0, 15.0}, {-20.0, 30.0, -15.0});
  near.target = Vec3::Zero();
  near.scale = 4.0;
  CameraPose far = near;
  far.projection = Projection::perspective;
  far.angle = angle;
  // At 4.6e8 mm, half the angle covers 4 mm.
  far.position = near.position.normalized() * (4.0 / std::tan(angle * pi / 360.0));
  TestScene scene = makeAbsorber(near, 16, 16);
  scene.volume = makeVolume(scene.volume.grid, [](const Vec3& p) {
    return 0.5 + 0.5 * std::sin(0.9 * p.x()) * std::cos(0.7 * p.y() + 0.3 * p.z());
  });
  scene.transfer = makeLinearTransfer(1.5, Rgb::Constant(0.8), 0.4);
  const RenderResult expected = renderScene(scene, scaleSamples(300), 1);
  scene.pose = far;
  expectSameImage(expected.film, renderScene(scene, scaleSamples(300), 2).film);
}

TEST(FieldOfView, ExtremeAnglesFollowChordAhead) {
  for (const double angle : {1e-6, 1e-3, 150.0, 179.0})
    for (const Vec3& position : {Vec3(-3.5, 0.2, 0.1), Vec3(0.1, 0.0, 0.0), Vec3(-3.0, 0.0, 0.0)}) {
      CameraPose wide = makePose(Projection::perspective, position, {1.0, 0.03, 0.02});
      wide.angle = angle;
      expectChords(makeAbsorber(wide, 16, 16), scaleSamples(400));
    }
}

TEST(ImageSize, OnePixelOrOneRowFollowsChordAhead) {
  const CameraPose outside = makePose(Projection::orthographic, {-9.0, 0.2, 0.1}, {1.0, 0.3, 0.2});
  for (const auto& [width, height] :
       {std::pair(1, 1), std::pair(1, 4096), std::pair(4096, 1), std::pair(3, 17)}) {
    CameraPose fitted = outside;
    fitted.scale = width > height ? 3.0 / 4096.0 : 2.0; // pixels are square
    expectChords(makeAbsorber(fitted, width, height),
                 scaleSamples(width * height == 1 ? 20000 : 100));
    fitted.projection = Projection::perspective;
    fitted.angle = width > height ? 0.02 : 40.0;
    expectChords(makeAbsorber(fitted, width, height),
                 scaleSamples(width * height == 1 ? 20000 : 100));
  }
}

// ---- scattering

TEST(SharpScattering, FurnaceIsOneWithBoundedNumberOfCollisions) {
  for (const double g : {-0.9999, 0.9999, -0.9999999999, 0.9999999999}) {
    TestScene scene =
        makeAbsorber(makePose(Projection::orthographic, {-9, 1, 2}, {9, -1, -2}), 12, 12);
    scene.transfer = makeLinearTransfer(1.0, Rgb::Ones(), g);
    const RenderResult result = renderScene(scene, scaleSamples(200));
    expectRadianceOne(result);
    // A one-dimensional walk: scattering is forward or backward, through 4 mm on average.
    const double collisions = static_cast<double>(result.counters.collisions) /
                              static_cast<double>(result.counters.paths);
    EXPECT_TRUE(collisions > 1.0 && collisions < 40.0) << collisions;
  }
}

TestScene makeMirrors(double power) {
  TestScene scene =
      makeAbsorber(makePose(Projection::orthographic, {-9, 1, 2}, {9, -1, -2}), 12, 12);
  scene.volume = makeVolume(scene.volume.grid, [](const Vec3& p) {
    return 0.5 + 0.5 * std::sin(2.0 * p.x()) * std::cos(1.5 * p.y() + p.z());
  });
  scene.transfer = makeLinearTransfer(20.0, Rgb::Ones());
  scene.transfer.shading = SurfaceShading{0.3, 0.7, power, 5.0}; // surfaces almost everywhere
  return scene;
}

TEST(SharpScattering, MirrorsReflectNoMoreThanArrives) {
  for (const double power : {0.0, 1e4, 1e8, 1e16, 1e300}) {
    const Estimate estimate = estimateMean(renderScene(makeMirrors(power), scaleSamples(100)).film);
    EXPECT_LT(estimate.mean, 1.0 + 4.0 * estimate.error) << power;
    EXPECT_GT(estimate.mean, 0.1) << power; // one diffuse reflection of 0.3, and the background
  }
}

TEST(SharpScattering, MirrorsConvergeWithGrowingPower) {
  const Film sharp = renderScene(makeMirrors(1e6), scaleSamples(300), 1).film; // lobes 1/1000 wide
  expectSameImage(sharp, renderScene(makeMirrors(1e16), scaleSamples(300), 2).film);
  expectSameImage(sharp, renderScene(makeMirrors(1e300), scaleSamples(300), 3).film);
}

} // namespace
} // namespace fenestra::core::testing::CameraStressTests
