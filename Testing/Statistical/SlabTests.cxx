// A homogeneous slab against closed forms: transmittance, and diffuse reflectance of a half-space.

#include "Support.h"

#include <gtest/gtest.h>

#include <array>

namespace fenestra::testing {
namespace {

/// A slab of side x side x thickness mm, extinction 1 per mm, seen from above, z down.
TestScene slab(double side, double thickness, const Rgb& albedo, double sigma_t = 1.0) {
  const Grid grid = centredGrid({2, 2, 2}, {side / 2.0, side / 2.0, thickness / 2.0});
  TestScene scene{makeVolume(grid, [](const Vec3&) { return 1.0; }),
                  linearTransfer(sigma_t, albedo),
                  {EnvironmentLight{}},
                  {},
                  8,
                  8};
  scene.pose.position = {0.0, 0.0, thickness};
  scene.pose.target = Vec3::Zero();
  scene.pose.up = Vec3::UnitY();
  scene.pose.scale = 0.01 * side;
  return scene;
}

class SlabTransmittance : public ::testing::TestWithParam<double> {};

TEST_P(SlabTransmittance, IsExponential) {
  const double depth = GetParam();
  TestScene scene = slab(100.0, depth, Rgb::Zero());
  RenderSettings settings;
  settings.samples = 2000;
  settings.path.background.kind = Background::Kind::environment;
  const Estimate estimate = imageEstimate(scene.render(settings).film);
  const double expected = std::exp(-depth);
  // Exactly 0 or 1 a sample: the binomial error is known even where no sample passed.
  const double error = std::sqrt(expected * (1.0 - expected) / (64.0 * 2000.0));
  EXPECT_NEAR(estimate.mean, expected, 4.0 * error);
}

INSTANTIATE_TEST_SUITE_P(Depths, SlabTransmittance, ::testing::Values(0.01, 0.5, 1.0, 3.0, 6.0));

TEST(RatioTracking, ShadowThroughASlabIsExponential) {
  const double depth = 2.0;
  const TestScene scene = slab(100.0, depth, Rgb::Zero());
  const Camera camera(scene.pose, 8, 8);
  const CellRanges ranges(scene.volume, 0);
  const MajorantGrid majorants(scene.volume.grid, ranges, scene.transfer, ClipNone{});
  const auto& voxels = std::get<std::vector<float>>(scene.volume.voxels);
  // Twice the extinction as majorant, so that ratios are not all 0: a scaled grid.
  const TransferFunction doubled = scene.transfer.scaled(2.0);
  const MajorantGrid loose(scene.volume.grid, ranges, doubled, ClipNone{});
  const Medium<float> medium(scene.volume.grid, voxels, scene.transfer);
  const Clip clip;
  for (const MajorantGrid* grid : {&majorants, &loose}) {
    const Tracker<float> tracker(scene.volume.grid, medium, *grid, clip);
    Counters counters;
    double sum = 0.0;
    double squares = 0.0;
    constexpr int n = 200000;
    for (int i = 0; i < n; ++i) {
      Random random(5, static_cast<std::uint64_t>(i), 0);
      const double t = tracker.transmittance(camera.ray(4, 4), {}, random, counters);
      sum += t;
      squares += t * t;
    }
    const double mean = sum / n;
    const double error = std::sqrt((squares / n - mean * mean) / n);
    EXPECT_NEAR(mean, std::exp(-depth), 4.0 * error);
  }
}

/// Chandrasekhar's H for isotropic scattering, by iterating his integral equation
/// 1/H(mu) = sqrt(1 - w) + w/2 ∫ mu' H(mu') / (mu + mu') dmu' (Radiative Transfer, 1960, ch. V).
double chandrasekharH(double albedo, double mu) {
  constexpr int n = 400;
  std::array<double, n> h;
  h.fill(1.0);
  const auto node = [](int i) { return (i + 0.5) / n; };
  const auto apply = [&](double m) {
    double integral = 0.0;
    for (int i = 0; i < n; ++i)
      integral += node(i) * h[static_cast<std::size_t>(i)] / (m + node(i)) / n;
    return 1.0 / (std::sqrt(1.0 - albedo) + 0.5 * albedo * integral);
  };
  for (int pass = 0; pass < 300; ++pass) {
    std::array<double, n> next;
    for (int i = 0; i < n; ++i)
      next[static_cast<std::size_t>(i)] = apply(node(i));
    h = next;
  }
  return apply(mu);
}

struct HalfSpaceCase {
  double albedo, reflectance;
};

class HalfSpace : public ::testing::TestWithParam<HalfSpaceCase> {};

TEST_P(HalfSpace, ReflectsAsChandrasekharSays) {
  const auto [albedo, reflectance] = GetParam();
  EXPECT_NEAR(1.0 - std::sqrt(1.0 - albedo) * chandrasekharH(albedo, 1.0), reflectance, 2e-4);
  TestScene scene = slab(140.0, 70.0, Rgb::Constant(albedo)); // half-width 70, thickness 70
  RenderSettings settings;
  settings.samples = albedo > 0.95 ? 400 : 1000;
  const Estimate estimate = imageEstimate(scene.render(settings).film);
  EXPECT_NEAR(estimate.mean, reflectance, 4.0 * estimate.error + 5e-5); // four digits are given
  EXPECT_LT(estimate.error, 0.004);
}

INSTANTIATE_TEST_SUITE_P(Albedos, HalfSpace,
                         ::testing::Values(HalfSpaceCase{0.5, 0.1152}, HalfSpaceCase{0.9, 0.4149},
                                           HalfSpaceCase{0.99, 0.7527}));

} // namespace
} // namespace fenestra::testing
