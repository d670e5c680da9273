#pragma once
// Compares the standard errors that images estimate with the spread of images over many seeds.

#include "Support.h"

namespace fenestra::core::testing {

/// Sum over pixels of the estimated variance / sum of the variance over seeds, with its standard
/// error: 1 if images estimate their error correctly.
struct ErrorRatio {
  double ratio = 0.0, error = 0.0;
  double variance = 0.0; ///< over seeds, mean over pixels
};

/// Ratio in the green channel, whose noise should be similar everywhere. `settings.seed` is the
/// first seed.
inline ErrorRatio measureErrorRatio(const TestScene& scene, RenderSettings settings, int seeds) {
  struct Pixel {
    double mean = 0.0, m2 = 0.0, estimated = 0.0;
  };
  std::vector<Pixel> pixels(static_cast<std::size_t>(scene.width * scene.height));
  for (int n = 1; n <= seeds; ++n, ++settings.seed) {
    const Film film = scene.render(settings).film;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      Pixel& pixel = pixels[i];
      const PixelSums& sums = film.pixels()[i];
      const double before = sums.mean[1] - pixel.mean;
      pixel.mean += before / n;
      pixel.m2 += before * (sums.mean[1] - pixel.mean) / (seeds - 1.0);
      pixel.estimated += std::pow(sums.standardError()[1], 2.0) / seeds;
    }
  }
  double estimatedSum = 0.0, measuredSum = 0.0, squares = 0.0;
  for (const Pixel& pixel : pixels) {
    estimatedSum += pixel.estimated;
    measuredSum += pixel.m2;
  }
  const double ratio = estimatedSum / measuredSum;
  for (const Pixel& pixel : pixels)
    squares += std::pow(pixel.estimated - ratio * pixel.m2, 2.0);
  return {ratio, std::sqrt(squares) / measuredSum,
          measuredSum / static_cast<double>(pixels.size())};
}

/// Fog between the camera and an environment: the first collision and the first direction cause
/// most of the noise.
inline TestScene makeFogScene() {
  const Grid grid = makeCenteredGrid({16, 16, 16}, {1.0, 1.0, 1.0});
  const Vec3 center(7.5, 7.5, 7.5);
  TestScene scene{makeVolume(grid,
                             [&](const Vec3& p) {
                               return std::max(0.0, 1.0 - 0.02 * (p - center).squaredNorm()) *
                                      (0.7 + 0.3 * std::sin(p.x()) * std::cos(p.z()));
                             }),
                  makeLinearTransfer(0.5, Rgb(0.6, 0.6, 0.9), 0.3),
                  {},
                  {},
                  16,
                  16};
  scene.lights = {EnvironmentLight{.radiance = Rgb::Constant(0.2)},
                  DirectionalLight{.direction = Vec3(0.0, 0.6, -0.8), .irradiance = Rgb::Ones()},
                  AreaLight{.center = {0, 0, 12},
                            .normal = -Vec3::UnitZ(),
                            .size = {12, 12},
                            .radiance = Rgb::Constant(3.0)}};
  scene.pose.position = {0, -40, 0};
  scene.pose.target = Vec3::Zero();
  scene.pose.scale = 6.0;
  return scene;
}

} // namespace fenestra::core::testing
