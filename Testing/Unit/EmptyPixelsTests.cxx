// Pixels that provably hit nothing get one sample; other pixels do not.

#include "Support.h"
#include "integrator/render/EmptyPixels.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::EmptyPixelsTests {
namespace {

/// Small opaque ball off the center of an empty box, rotated against the view.
TestScene makeBallScene(Projection projection, double distance) {
  Affine map = Affine::Identity();
  map.linear() = makeRotation(0.4, Vec3(1, 2, 3).normalized()).linear() * 1.5;
  const Vec3 middle(30.0, 22.0, 12.0);
  TestScene scene{makeVolume(Grid({40, 36, 32}, map),
                             [&](const Vec3& p) { return (p - middle).norm() < 5.0 ? 1.0 : 0.0; }),
                  makeLinearTransfer(2.0, Rgb::Constant(0.7)),
                  {EnvironmentLight{}},
                  {},
                  64,
                  48};
  scene.pose.projection = projection;
  scene.pose.target = scene.volume.grid.worldCenter();
  scene.pose.position = scene.pose.target + Vec3(0.0, distance, 0.0);
  scene.pose.scale = 30.0;
  return scene;
}

struct View {
  const char* name;
  Projection projection;
  double distance; ///< mm from the volume's center
};

class EmptyPixelsViews : public ::testing::TestWithParam<View> {};

TEST_P(EmptyPixelsViews, NoSampleHitsInADeterministicPixel) {
  const TestScene scene = makeBallScene(GetParam().projection, GetParam().distance);
  RenderSettings settings;
  settings.samples = 64;
  const Film film = scene.render(settings).film;
  TestScene mapped = scene; // the environment varies: no pixel is deterministic
  mapped.lights = {EnvironmentLight{Rgb::Ones(), {2, 1, {1, 1, 1, 2, 2, 2}}}};
  settings.path.background.kind = Background::Kind::environment;
  settings.samples = 256;
  const Film all = mapped.render(settings).film;
  std::size_t deterministic = 0, missed = 0;
  for (std::size_t i = 0; i < film.pixelCount(); ++i) {
    const PixelSums& pixel = film.pixels()[i];
    EXPECT_EQ(all.pixels()[i].samples, 256U);
    EXPECT_EQ(pixel.samples, pixel.isDeterministic ? 1U : 64U);
    EXPECT_TRUE(!pixel.isDeterministic || all.pixels()[i].collidedSamples == 0) << "pixel " << i;
    deterministic += pixel.isDeterministic ? 1 : 0;
    missed += all.pixels()[i].collidedSamples == 0 ? 1 : 0;
  }
  EXPECT_EQ(film.sampleCounts().deterministicPixels, deterministic);
  EXPECT_EQ(film.sampleCounts().min, 64U);
  if (GetParam().distance > 50.0) {
    EXPECT_GT(static_cast<double>(deterministic), 0.8 * static_cast<double>(missed))
        << "of " << missed;
  }
}

INSTANTIATE_TEST_SUITE_P(Views, EmptyPixelsViews,
                         ::testing::Values(View{"Orthographic", Projection::orthographic, 100.0},
                                           View{"Perspective", Projection::perspective, 100.0},
                                           View{"FromInside", Projection::perspective, 3.0}),
                         [](const auto& info) { return info.param.name; });

TEST(EmptyPixels, OccupiedImageOfOneColumnHasNone) {
  TestScene scene = makeBallScene(Projection::orthographic, 100.0);
  scene.transfer = makeLinearTransfer(0.0, Rgb::Constant(0.7));
  scene.transfer.extinction = ScalarFunction({makeKnot(0.0, 1.0)});
  scene.pose.scale = 5.0;
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(1, 5), std::pair(5, 1)}) {
    scene.width = width;
    scene.height = height;
    EXPECT_EQ(scene.render({}).film.sampleCounts().deterministicPixels, 0U)
        << width << "x" << height;
  }
}

TEST(EmptyPixels, DefaultHasNone) {
  EXPECT_FALSE(EmptyPixels().contains(0, 0));
}

TEST(EmptyPixels, ImageThatHitsNothingHasOnlyEmptyPixels) {
  TestScene scene = makeBallScene(Projection::orthographic, 100.0);
  scene.transfer = makeLinearTransfer(0.0, Rgb::Constant(0.7));
  RenderSettings settings;
  settings.noise = 0.1;
  const RenderResult result = scene.render(settings);
  EXPECT_EQ(result.film.sampleCounts().deterministicPixels, result.film.pixelCount());
  EXPECT_EQ(result.film.sampleCounts().max, 1U);
  EXPECT_EQ(result.film.noise(), 0.0);
}

} // namespace
} // namespace fenestra::core::testing::EmptyPixelsTests
