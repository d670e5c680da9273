// Furnace test: a medium of albedo 1 in a constant environment of 1 has radiance 1 everywhere, for
// every medium, projection, clip and crop. A sky of one color equals a constant environment.

#include "Support.h"

#include "clip/surface/ClippingSurface.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::FurnaceTests {
namespace {

enum class MediumKind { homogeneous, heterogeneous, spikes };
enum class ClipKind { none, plane, cutaway, surface };

using Case = std::tuple<MediumKind, Projection, ClipKind, double, bool>; ///< last: g, isCropped

Volume makeMediumVolume(MediumKind kind) {
  const Grid grid = makeCenteredGrid({20, 24, 18}, {1.0, 0.8, 1.3});
  return makeVolume(grid, [kind](const Vec3& p) {
    if (kind == MediumKind::homogeneous)
      return 1.0;
    return 0.5 + 0.5 * std::sin(0.9 * p.x()) * std::cos(0.7 * p.y() + 0.3 * p.z());
  });
}

/// Non-monotone extinction: 0 at the lower end of the range, dense in thin bands.
TransferFunction makeSpikes() {
  return {ScalarFunction({makeKnot(0.0, 0.0), makeKnot(0.45, 0.0), makeKnot(0.5, 4.0),
                          makeKnot(0.55, 0.0), makeKnot(0.9, 0.0), makeKnot(0.9, 1.5),
                          makeKnot(1.0, 0.2)}),
          ColorFunction({{0.0, Rgb::Ones()}})};
}

/// Off-center ball of radius 4 mm.
Mask makeBallMask() {
  const Grid grid = makeCenteredGrid({16, 16, 16}, {1.0, 1.0, 1.0});
  Mask mask{grid, {}, 0, {"ball"}};
  for (int k = 0; k < 16; ++k)
    for (int j = 0; j < 16; ++j)
      for (int i = 0; i < 16; ++i) {
        const Vec3 p = grid.indexToWorld * Vec3(i, j, k) - Vec3(1.0, -1.0, 0.5);
        mask.voxels.push_back(p.norm() < 4.0 ? 1 : 0);
        mask.count += mask.voxels.back();
      }
  return mask;
}

/// Rotated crop box that cuts the ball and two of the volume's corners.
CropBox makeRotatedCrop() {
  return CropBox(makeTranslation({0.5, -2.0, 1.0}) *
                 makeRotation(0.5, Vec3(1.0, 1.0, -2.0).normalized()) *
                 makeScaling(Vec3(7.0, 5.0, 12.0)));
}

Clip makeClip(ClipKind kind, const Camera& camera, const Domain& volume) {
  switch (kind) {
  case ClipKind::none:
    return ClipNone{};
  case ClipKind::plane:
    return ClipPlane{camera, Vec3(0.0, -2.0, 0.0), Vec3(0.2, 1.0, 0.1).normalized()};
  case ClipKind::cutaway:
    return buildClippingSurface(camera, volume, makeBallMask(), {SurfaceMode::cutaway, 50, 0.5})
        .clip;
  case ClipKind::surface:
    return buildClippingSurface(camera, volume, makeBallMask(), {SurfaceMode::surface, 50, 0.5})
        .clip;
  }
  return {};
}

class Furnace : public ::testing::TestWithParam<Case> {};

TEST_P(Furnace, RadianceIsOne) {
  const auto [mediumKind, projection, clipKind, g, isCropped] = GetParam();
  TestScene scene{makeMediumVolume(mediumKind),
                  mediumKind == MediumKind::spikes ? makeSpikes()
                                                   : makeLinearTransfer(0.4, Rgb::Ones()),
                  {EnvironmentLight{}},
                  {},
                  24,
                  24};
  scene.transfer.g = g;
  scene.pose.projection = projection;
  scene.pose.position = {5.0, 40.0, 12.0};
  scene.pose.target = Vec3::Zero();
  scene.pose.scale = 12.0;
  if (isCropped)
    scene.crop = makeRotatedCrop();
  scene.clip = makeClip(clipKind, Camera(scene.pose, scene.width, scene.height),
                        Domain(scene.volume.grid, scene.crop));

  RenderSettings settings;
  settings.samples = 64;
  settings.seed = 11;
  settings.path.background.kind = Background::Kind::environment;
  const RenderResult result = scene.render(settings);
  const Estimate estimate = estimateMean(result.film);
  EXPECT_GT(result.counters.collisions, 10000U) << "the medium must have an effect";
  EXPECT_NEAR(estimate.mean, 1.0, 4.0 * estimate.error);
  EXPECT_LT(estimate.error, 0.02);
}

INSTANTIATE_TEST_SUITE_P(
    Everywhere, Furnace,
    ::testing::Combine(
        ::testing::Values(MediumKind::homogeneous, MediumKind::heterogeneous, MediumKind::spikes),
        ::testing::Values(Projection::orthographic, Projection::perspective),
        ::testing::Values(ClipKind::none, ClipKind::plane, ClipKind::cutaway, ClipKind::surface),
        ::testing::Values(0.0, 0.7), ::testing::Values(false)));

INSTANTIATE_TEST_SUITE_P(Cropped, Furnace,
                         ::testing::Combine(::testing::Values(MediumKind::heterogeneous),
                                            ::testing::Values(Projection::orthographic,
                                                              Projection::perspective),
                                            ::testing::Values(ClipKind::none, ClipKind::plane,
                                                              ClipKind::cutaway, ClipKind::surface),
                                            ::testing::Values(0.7), ::testing::Values(true)));

TEST(SingleColorSky, EqualsConstantEnvironment) {
  const Rgb color(0.9, 0.6, 0.3);
  TestScene scene{makeMediumVolume(MediumKind::heterogeneous),
                  makeLinearTransfer(0.4, Rgb(0.9, 0.7, 0.5)),
                  {EnvironmentLight{color, {}}},
                  {}};
  scene.pose.position = {5.0, 40.0, 12.0};
  scene.pose.target = Vec3::Zero();
  scene.pose.scale = 12.0;
  RenderSettings settings;
  settings.samples = 256;
  settings.path.background.kind = Background::Kind::environment;
  for (const Integrator integrator : {Integrator::simd, Integrator::scalar}) {
    settings.integrator = integrator;
    settings.seed = 21;
    scene.lights = {EnvironmentLight{color, {}}};
    const Estimate constant = estimateMean(scene.render(settings).film);
    settings.seed = 22;
    scene.lights = {SkyLight{color, color, color}};
    const Estimate sky = estimateMean(scene.render(settings).film);
    EXPECT_NEAR(sky.mean, constant.mean, 4.0 * std::hypot(sky.error, constant.error));
    EXPECT_LT(sky.error, 0.005 * constant.mean);
  }
}

} // namespace
} // namespace fenestra::core::testing::FurnaceTests
