// Homogeneous slabs against closed forms: transmittance, and the reflectance of a half-space.

#include "Slab.h"

#include <array>

namespace fenestra::core::testing::SlabTests {
namespace {

class SlabTransmittance : public ::testing::TestWithParam<double> {};

TEST_P(SlabTransmittance, EqualsExpOfMinusDepth) {
  const double depth = GetParam();
  TestScene scene = makeSlab(100.0, depth, Rgb::Zero());
  RenderSettings settings;
  settings.samples = 2000;
  settings.path.background.kind = Background::Kind::environment;
  const Estimate estimate = estimateMean(scene.render(settings).film);
  const double expected = std::exp(-depth);
  // Every sample is exactly 0 or 1, so the binomial error is known even if no sample passes.
  const double error = std::sqrt(expected * (1.0 - expected) / (64.0 * 2000.0));
  EXPECT_NEAR(estimate.mean, expected, 4.0 * error);
}

INSTANTIATE_TEST_SUITE_P(Depths, SlabTransmittance, ::testing::Values(0.01, 0.5, 1.0, 3.0, 6.0));

TEST(RatioTracking, TransmittanceOfSlabIsExponential) {
  const double depth = 2.0;
  const TestScene scene = makeSlab(100.0, depth, Rgb::Zero());
  const Camera camera(scene.pose, 8, 8);
  const MinMaxGrid ranges(scene.volume, 0);
  const MajorantGrid majorants(scene.volume.grid, ranges, scene.transfer, ClipNone{});
  const auto& voxels = std::get<LargeArray<float>>(scene.volume.voxels);
  // A grid with twice the majorant, so that not all ratios are 0.
  const TransferFunction doubledTransfer = scene.transfer.withDensity(2.0);
  const MajorantGrid loose(scene.volume.grid, ranges, doubledTransfer, ClipNone{});
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
      const double t = tracker.transmittance(camera.makeRay(4, 4), {}, random, counters);
      sum += t;
      squares += t * t;
    }
    const double mean = sum / n;
    const double error = std::sqrt((squares / n - mean * mean) / n);
    EXPECT_NEAR(mean, std::exp(-depth), 4.0 * error);
  }
}

/// Chandrasekhar's H for isotropic scattering of albedo w, by iteration of his integral equation
/// 1/H(mu) = sqrt(1 - w) + w/2 ∫ mu' H(mu') / (mu + mu') dmu' (Radiative Transfer, 1960, ch. V).
class ChandrasekharH {
public:
  explicit ChandrasekharH(double albedo) : m_albedo(albedo) {
    m_h.fill(1.0);
    for (int pass = 0; pass < 300; ++pass) {
      std::array<double, nodes> next;
      for (int i = 0; i < nodes; ++i)
        next[static_cast<std::size_t>(i)] = (*this)(node(i));
      m_h = next;
    }
  }

  double operator()(double mu) const {
    double integral = 0.0;
    for (int i = 0; i < nodes; ++i)
      integral += node(i) * m_h[static_cast<std::size_t>(i)] / (mu + node(i)) / nodes;
    return 1.0 / (std::sqrt(1.0 - m_albedo) + 0.5 * m_albedo * integral);
  }

private:
  static constexpr int nodes = 400;
  static double node(int i) { return (i + 0.5) / nodes; }

  double m_albedo;
  std::array<double, nodes> m_h;
};

struct HalfSpaceCase {
  double albedo, reflectance;
};

class HalfSpace : public ::testing::TestWithParam<HalfSpaceCase> {};

TEST_P(HalfSpace, ReflectanceEqualsChandrasekharsValue) {
  const auto [albedo, reflectance] = GetParam();
  EXPECT_NEAR(1.0 - std::sqrt(1.0 - albedo) * ChandrasekharH(albedo)(1.0), reflectance, 2e-4);
  TestScene scene = makeSlab(140.0, 70.0, Rgb::Constant(albedo)); // half-width 70, thickness 70
  RenderSettings settings;
  settings.samples = albedo > 0.95 ? 400 : 1000;
  const Estimate estimate = estimateMean(scene.render(settings).film);
  EXPECT_NEAR(estimate.mean, reflectance, 4.0 * estimate.error + 5e-5); // four known digits
  EXPECT_LT(estimate.error, 0.004);
}

INSTANTIATE_TEST_SUITE_P(Albedos, HalfSpace,
                         ::testing::Values(HalfSpaceCase{0.5, 0.1152}, HalfSpaceCase{0.9, 0.4149},
                                           HalfSpaceCase{0.99, 0.7527}));

/// Optical thickness that replaces a half-space. Less than exp(-2 · 0.17 · 60) of the light returns
/// from below 60 free paths; 0.17 per free path is the slowest decay at albedo 0.99.
constexpr double halfSpaceDepth = 60.0;
const Rgb halfSpaceAlbedo(0.5, 0.9, 0.99);
constexpr double relativeErrorOfH = 2e-4; ///< the reflectances above have four digits

std::array<ChandrasekharH, 3> makeHalfSpaceH() {
  return {ChandrasekharH(halfSpaceAlbedo[0]), ChandrasekharH(halfSpaceAlbedo[1]),
          ChandrasekharH(halfSpaceAlbedo[2])};
}

/// Reflectance under a constant environment of 1 at an angle: 1 - sqrt(1 - w) H(mu), by reciprocity
/// with the albedo of a half-space for parallel light.
TEST(HalfSpace, EnvironmentReflectanceEqualsClosedFormAtAnyAngle) {
  const std::array<ChandrasekharH, 3> h = makeHalfSpaceH();
  std::uint64_t seed = 20;
  for (const double mu : {0.7, 0.2}) {
    SCOPED_TRACE(mu);
    TestScene scene = makeWideSlab(halfSpaceDepth, halfSpaceAlbedo);
    aimCamera(scene, downwardDirection(mu));
    Rgb expected;
    for (int c = 0; c < 3; ++c)
      expected[c] = 1.0 - std::sqrt(1.0 - halfSpaceAlbedo[c]) * h[static_cast<std::size_t>(c)](mu);
    expectMean(renderMean(scene, 600, seed++), expected, 0.01, relativeErrorOfH);
  }
}

/// Law of diffuse reflection (Chandrasekhar, ch. III and V): under parallel light of irradiance F
/// on a plane that faces the light, I(mu) = w F / (4 pi) mu0 / (mu + mu0) H(mu) H(mu0).
TEST(HalfSpace, ParallelLightFollowsLawOfDiffuseReflection) {
  const std::array<ChandrasekharH, 3> h = makeHalfSpaceH();
  std::uint64_t seed = 30;
  for (const double mu0 : {1.0, 0.4})
    for (const double mu : {0.9, 0.25}) {
      SCOPED_TRACE(std::to_string(mu0) + " " + std::to_string(mu));
      TestScene scene = makeWideSlab(halfSpaceDepth, halfSpaceAlbedo);
      scene.lights = {DirectionalLight{.direction = downwardDirection(mu0, 2.0),
                                       .irradiance = Rgb::Constant(pi)}};
      aimCamera(scene, downwardDirection(mu));
      Rgb expected;
      for (int c = 0; c < 3; ++c)
        expected[c] = 0.25 * halfSpaceAlbedo[c] * mu0 / (mu + mu0) *
                      h[static_cast<std::size_t>(c)](mu) * h[static_cast<std::size_t>(c)](mu0);
      expectMean(renderMean(scene, 600, seed++), expected, 0.01, relativeErrorOfH);
    }
}

} // namespace
} // namespace fenestra::core::testing::SlabTests
