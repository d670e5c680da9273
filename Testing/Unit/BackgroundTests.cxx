// Background where camera rays hit nothing.

#include "Support.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::BackgroundTests {
namespace {

/// Renders 4 x 8 pixels of a volume without scattering in front of a background.
Film renderEmptyScene(const Background& background, double sigma_t = 0.0, int threads = 0) {
  TestScene scene{
      makeVolume(makeCenteredGrid({4, 4, 4}, {1.0, 1.0, 1.0}), [](const Vec3&) { return 1.0; }),
      makeLinearTransfer(sigma_t, Rgb::Zero()),
      {},
      {},
      4,
      8};
  scene.pose.position = {0, -100, 0};
  scene.pose.target = Vec3::Zero();
  scene.pose.scale = 1.0;
  RenderSettings settings;
  settings.samples = 50;
  settings.threads = threads;
  settings.path.background = background;
  return scene.render(settings).film;
}

TEST(Background, GradientIsLinearInDisplayValues) {
  const Rgb bottom(0.756863, 0.764706, 0.909804); // Slicer's defaults
  const Rgb top(0.454902, 0.470588, 0.745098);
  const Film film = renderEmptyScene(Background::makeGradient(bottom, top));
  for (int row = 0; row < 8; ++row)
    for (int column = 0; column < 4; ++column) {
      const PixelSums& pixel = film.at(column, row);
      const double height = (7.5 - row) / 8.0; // row 0 is at the top
      const Rgb encoded = (1.0 - height) * bottom + height * top;
      const Rgb expected =
          ((encoded + 0.055) / 1.055).unaryExpr([](double v) { return std::pow(v, 2.4); });
      EXPECT_LT((pixel.mean - expected).abs().maxCoeff(), 1e-12) << "row " << row;
      EXPECT_EQ(pixel.standardError().maxCoeff(), 0.0) << "a background has no noise";
      EXPECT_EQ(pixel.alpha, 1.0) << "sum over the single sample of a deterministic pixel";
    }
}

TEST(Background, SkyVariesWithinEachPixel) {
  TestScene scene{
      makeVolume(makeCenteredGrid({4, 4, 4}, {1.0, 1.0, 1.0}), [](const Vec3&) { return 0.0; }),
      makeLinearTransfer(0.0, Rgb::Zero()),
      {SkyLight{Rgb(1, 2, 3), Rgb(0.5, 0.5, 0.5), Rgb(3, 2, 1)}},
      {},
      1,
      2};
  scene.pose.projection = Projection::perspective;
  scene.pose.position = {0, -100, 0};
  scene.pose.target = Vec3::Zero();
  scene.pose.angle = 90.0;
  RenderSettings settings;
  settings.samples = 4000;
  settings.path.background.kind = Background::Kind::environment;
  const Film film = scene.render(settings).film;
  // Mean over a pixel of the cosine to the camera's up vector, y / sqrt(1 + x^2 + y^2), for x from
  // -1/2 to 1/2 and y from 0 to 1: int sqrt(2 + x^2) - sqrt(1 + x^2) dx.
  const auto integral = [](double a) {
    const double half = 0.5;
    return half * std::sqrt(a + half * half) + a * std::asinh(half / std::sqrt(a));
  };
  const double cosine = integral(2.0) - integral(1.0);
  EXPECT_NEAR(film.at(0, 0).mean[2], 0.5 + 2.5 * cosine, 4.0 * film.at(0, 0).standardError()[2]);
  EXPECT_NEAR(film.at(0, 1).mean[0], 0.5 + 2.5 * cosine, 4.0 * film.at(0, 1).standardError()[0]);
  EXPECT_GT(film.at(0, 0).standardError()[2], 0.0) << "the sky varies within the pixel";
}

TEST(Background, EqualColorsGiveAConstantBackground) {
  const Background background = Background::makeGradient(Rgb(0.5, 0.2, 1.0), Rgb(0.5, 0.2, 1.0));
  EXPECT_EQ(background.kind, Background::Kind::color);
  EXPECT_NEAR(background.color[0], 0.21404114, 1e-8);
  EXPECT_NEAR(background.color[2], 1.0, 1e-15);
  EXPECT_EQ((renderEmptyScene(background).at(0, 0).mean - background.color).abs().maxCoeff(), 0.0);
}

TEST(Background, DarkGradientIsLighterAtTheTop) {
  const Background background = Background::makeDarkGradient();
  EXPECT_LT((background.evaluate(1.0) - Rgb(0.060, 0.066, 0.078)).abs().maxCoeff(), 1e-12);
  EXPECT_LT((background.evaluate(0.0) - Rgb(0.012, 0.013, 0.016)).abs().maxCoeff(), 1e-12);
  const Film film = renderEmptyScene(background);
  for (int row = 1; row < 8; ++row)
    EXPECT_TRUE((film.at(0, row).mean < film.at(0, row - 1).mean).all()) << "row " << row;
}

TEST(Background, IsVisibleThroughTheVolumeForAnyNumberOfThreads) {
  const Background background = Background::makeGradient(Rgb(0.1, 0.2, 0.3), Rgb(0.9, 0.8, 0.7));
  const Film one = renderEmptyScene(background, 0.3, 1);
  const Film two = renderEmptyScene(background, 0.3, 2);
  for (std::size_t i = 0; i < one.pixelCount(); ++i) {
    EXPECT_TRUE(one.pixels()[i].mean == two.pixels()[i].mean);
    // Black medium, 4 mm thick: some paths collide in it, the others see the full background.
    const Rgb behind = background.evaluate((7.5 - static_cast<double>(i / 4)) / 8.0);
    const double fraction = one.pixels()[i].mean[0] / behind[0];
    EXPECT_NEAR(fraction, std::exp(-1.2), 5.0 * std::sqrt(0.25 / 50.0));
    EXPECT_LT((one.pixels()[i].mean - fraction * behind).abs().maxCoeff(), 1e-12);
  }
}

} // namespace
} // namespace fenestra::core::testing::BackgroundTests
