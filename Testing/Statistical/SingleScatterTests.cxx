// Single scattering in a homogeneous slab under parallel light, against the closed form. T is the
// thickness in free paths, w the albedo, F the irradiance on a plane that faces the light, mu and
// mu0 the view's and the light's cosines to the slab's normal, and p the phase function:
//   reflected:   I(mu) = w p F mu0 / (mu + mu0) (1 - exp(-T / mu - T / mu0))
//   transmitted: I(mu) = w p F mu0 / (mu - mu0) (exp(-T / mu) - exp(-T / mu0))
// (Chandrasekhar, Radiative Transfer, 1960, ch. IX: the first of successive scatterings).

#include "Slab.h"

namespace fenestra::core::testing::SingleScatterTests {
namespace {

/// Henyey and Greenstein 1941, per steradian; `cosine`: of the angle between the directions of
/// travel before and after scattering.
double henyeyGreenstein(double g, double cosine) {
  return (1.0 - g * g) / (4.0 * pi * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
}

class SingleScatter : public ::testing::TestWithParam<double> {};

TEST_P(SingleScatter, RadianceEqualsClosedForm) {
  const double g = GetParam();
  const double thickness = 1.5;
  const Rgb albedo(1.0, 0.6, 0.2);
  const Rgb irradiance(1.0, 2.0, 3.0);
  TestScene scene = makeWideSlab(thickness, albedo);
  scene.transfer.g = g;
  std::uint64_t seed = 5300 + static_cast<std::uint64_t>(100.0 * (g + 1.0));
  for (const double mu0 : {1.0, 0.5})
    for (const double mu : {0.95, 0.3})
      for (const double azimuth : {0.0, 2.0})
        for (const bool isFromBelow : {false, true}) {
          SCOPED_TRACE(std::to_string(mu0) + " " + std::to_string(mu) + " " +
                       std::to_string(azimuth) + (isFromBelow ? " transmitted" : " reflected"));
          const Vec3 lightDirection = downwardDirection(mu0);
          const Vec3 viewDirection = downwardDirection(isFromBelow ? -mu : mu, azimuth);
          scene.lights = {DirectionalLight{.direction = lightDirection, .irradiance = irradiance}};
          aimCamera(scene, viewDirection);
          const double layer =
              isFromBelow
                  ? mu0 / (mu - mu0) * (std::exp(-thickness / mu) - std::exp(-thickness / mu0))
                  : mu0 / (mu + mu0) * -std::expm1(-thickness / mu - thickness / mu0);
          const Rgb expected = albedo * irradiance *
                               (henyeyGreenstein(g, lightDirection.dot(-viewDirection)) * layer);
          expectMean(renderMean(scene, 1500, seed++, /*bounces*/ 1), expected, 0.012);
        }
}

/// Mean of an image of one radiance, and its standard error.
RgbEstimate averagePixels(const Film& film) {
  Rgb sum = Rgb::Zero(), squares = Rgb::Zero();
  for (const PixelSums& pixel : film.pixels()) {
    sum += pixel.mean;
    squares += pixel.mean.square();
  }
  const auto count = static_cast<double>(film.pixelCount());
  const Rgb mean = sum / count;
  return {mean, ((squares / count - mean.square()) / (count - 1.0)).sqrt()};
}

/// Each collision samples one of three lights, stratified over blocks of eight samples: their sum
/// must be right with complete and with incomplete blocks.
TEST(SingleScatterOfLights, StratifiedLightsAddUp) {
  const double thickness = 1.5;
  const Rgb albedo(1.0, 0.6, 0.2);
  TestScene scene = makeWideSlab(thickness, albedo);
  scene.width = scene.height = 128;
  aimCamera(scene, downwardDirection(0.95, 1.0));
  Rgb expected = Rgb::Zero();
  for (const double mu0 : {1.0, 0.5, 0.2}) {
    const Rgb irradiance(0.5, 1.5 - mu0, 2.0 * mu0);
    scene.lights.push_back(
        DirectionalLight{.direction = downwardDirection(mu0), .irradiance = irradiance});
    const double layer = mu0 / (0.95 + mu0) * -std::expm1(-thickness / 0.95 - thickness / mu0);
    expected += albedo * irradiance * (0.25 / pi * layer);
  }
  scene.lights.erase(scene.lights.begin()); // the slab's default environment
  for (const Integrator integrator : {Integrator::simd, Integrator::scalar})
    for (const std::uint64_t samples : {1U, 3U, 16U}) {
      SCOPED_TRACE(std::to_string(samples));
      RenderSettings settings;
      settings.integrator = integrator;
      settings.samples = samples;
      settings.seed = shiftSeed(5900 + samples);
      settings.path.bounces = 1;
      expectMean(averagePixels(scene.render(settings).film), expected, 0.03);
    }
}

INSTANTIATE_TEST_SUITE_P(Anisotropies, SingleScatter, ::testing::Values(-0.9, 0.0, 0.5, 0.9));

} // namespace
} // namespace fenestra::core::testing::SingleScatterTests
