#include "model/medium/Scattering.h"

#include "Approx.h"
#include "Histogram.h"

namespace fenestra::core::testing::ScatteringTests {
namespace {

const Vec3 incoming = Vec3(0.3, -0.5, 0.81).normalized();

ScatterSample sampleSurface(const Scattering& surface, Random& random) {
  const double choice = random.uniform();
  return surface.sample(choice, random.uniform2());
}

class HenyeyGreenstein : public ::testing::TestWithParam<double> {};

TEST_P(HenyeyGreenstein, SamplingMatchesPdf) {
  const Scattering phase(incoming, GetParam(), Rgb::Ones());
  // Peaked lobes need a finer midpoint rule.
  expectSamplingMatchesPdf([&](Random& r) { return phase.sample(0.0, r.uniform2()).outgoing; },
                           [&](const Vec3& d) { return phase.evaluate(d).pdf; }, 1.0,
                           std::abs(GetParam()) > 0.9 ? 400 : 60);
}

TEST_P(HenyeyGreenstein, MeanCosineIsG) {
  const Scattering phase(incoming, GetParam(), Rgb::Ones());
  double sum = 0.0;
  double squares = 0.0;
  constexpr int n = 400000;
  for (int i = 0; i < n; ++i) {
    Random random(3, static_cast<std::uint64_t>(i), 0);
    const double cosine = phase.sample(0.0, random.uniform2()).outgoing.dot(incoming);
    sum += cosine;
    squares += cosine * cosine;
  }
  const double mean = sum / n;
  const double error = std::sqrt((squares / n - mean * mean) / n);
  EXPECT_NEAR(mean, GetParam(), 4.5 * error + 1e-12);
}

TEST_P(HenyeyGreenstein, WeightIsTheAlbedo) {
  const Scattering phase(incoming, GetParam(), Rgb(0.9, 0.5, 0.1));
  Random random(1, 2, 3);
  const ScatterSample sample = phase.sample(0.0, random.uniform2());
  EXPECT_TRUE(isApprox(sample.weight, Rgb(0.9, 0.5, 0.1)));
  EXPECT_TRUE(
      isApprox(toColor(phase.evaluate(sample.outgoing).factor), sample.weight * sample.pdf));
}

INSTANTIATE_TEST_SUITE_P(MeanCosines, HenyeyGreenstein,
                         ::testing::Values(-0.95, -0.5, -1e-7, 0.0, 1e-9, 0.3, 0.85, 0.97));

TEST(HenyeyGreensteinExtremes, DirectionHasUnitLengthAndPdfIsFinite) {
  for (const double g : {-0.9999, 0.9999, 0.9999999}) {
    const Scattering phase(-Vec3::UnitZ(), g, Rgb::Ones());
    for (int i = 0; i < 100000; ++i) {
      Random random(8, static_cast<std::uint64_t>(i), 0);
      const ScatterSample sample = phase.sample(0.0, random.uniform2());
      ASSERT_NEAR(sample.outgoing.norm(), 1.0, 1e-12);
      ASSERT_TRUE(std::isfinite(sample.pdf));
      ASSERT_GT(sample.pdf, 0.0);
    }
  }
}

struct SurfaceCase {
  double cosine; ///< of the angle between normal and viewer
  SurfaceShading shading;
};

class Surface : public ::testing::TestWithParam<SurfaceCase> {
protected:
  Scattering surface() const {
    const Vec3 normal = Vec3(0.2, 0.4, -0.9).normalized();
    const Frame frame(normal);
    const double c = GetParam().cosine;
    const Vec3 toViewer = frame.toWorld({std::sqrt(1.0 - c * c), 0.0, c});
    return {-toViewer, -3.0 * normal, GetParam().shading, Rgb(0.9, 0.6, 0.3)};
  }
};

TEST_P(Surface, SamplingMatchesPdf) {
  const Scattering s = surface();
  // Sampled directions below the surface have pdf 0: the mass that they have in the glossy lobe is
  // missing from the pdf's integral.
  double lostMass = 0.0;
  constexpr int n = 200000;
  for (int i = 0; i < n; ++i) {
    Random random(77, static_cast<std::uint64_t>(i), 0);
    lostMass += sampleSurface(s, random).pdf > 0.0 ? 0.0 : 1.0 / n;
  }
  expectSamplingMatchesPdf(
      [&](Random& r) {
        const ScatterSample sample = sampleSurface(s, r);
        return sample.pdf > 0.0 ? sample.outgoing : Vec3(Vec3::Zero());
      },
      [&](const Vec3& d) { return s.evaluate(d).pdf; }, 1.0 - lostMass, 100);
}

TEST_P(Surface, ConservesEnergy) {
  const Scattering s = surface();
  Rgb reflected = Rgb::Zero();
  constexpr int n = 200000;
  for (int i = 0; i < n; ++i) {
    Random random(5, static_cast<std::uint64_t>(i), 0);
    reflected += sampleSurface(s, random).weight / n;
  }
  const Rgb expected = [&] { // reference: midpoint rule
    Rgb sum = Rgb::Zero();
    const int resolution = 400;
    for (int i = 0; i < resolution; ++i)
      for (int j = 0; j < resolution; ++j)
        sum += toColor(
                   s.evaluate(SphereBins::toDirection((i + 0.5) / resolution * SphereBins::rows,
                                                      (j + 0.5) / resolution * SphereBins::columns))
                       .factor) *
               (4.0 * pi / (resolution * resolution));
    return sum;
  }();
  EXPECT_LE(reflected.maxCoeff(), 1.0);
  EXPECT_TRUE(isApprox(reflected, expected, 0.01)) << reflected << "\n" << expected;
}

INSTANTIATE_TEST_SUITE_P(Lobes, Surface,
                         ::testing::Values(SurfaceCase{1.0, {0.9, 0.2, 10.0, 0.5}},
                                           SurfaceCase{0.6, {0.7, 0.3, 30.0, 0.5}},
                                           SurfaceCase{0.1, {0.0, 1.0, 4.0, 0.5}},
                                           SurfaceCase{0.3, {2.0, 1.0, 1.0, 0.5}},
                                           SurfaceCase{0.8, {1.0, 0.0, 10.0, 0.5}},
                                           SurfaceCase{1.0, SurfaceShading::makeCoated(0.2, 0.4)},
                                           SurfaceCase{0.5, SurfaceShading::makeCoated(1.0, 0.2)},
                                           SurfaceCase{0.1, SurfaceShading::makeCoated(0.7, 1.0)}));

Scattering makeSurface(double cosine, const SurfaceShading& shading, const Rgb& albedo) {
  const Vec3 toViewer(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
  return {-toViewer, -Vec3::UnitZ(), shading, albedo};
}

/// Directional albedo: the reflected fraction of a uniform environment's light.
double estimateAlbedo(const Scattering& surface) {
  double sum = 0.0;
  constexpr int n = 100000;
  for (int i = 0; i < n; ++i) {
    Random random(6, static_cast<std::uint64_t>(i), 0);
    sum += sampleSurface(surface, random).weight.maxCoeff() / n;
  }
  return sum;
}

TEST(Coat, WhiteSurfaceStaysWhite) {
  for (const double cosine : {1.0, 0.5}) {
    const double albedo =
        estimateAlbedo(makeSurface(cosine, SurfaceShading::makeCoated(0.2, 0.3), Rgb::Ones()));
    EXPECT_GT(albedo, 0.999);
    EXPECT_LE(albedo, 1.0);
    EXPECT_NEAR(
        estimateAlbedo(makeSurface(cosine, SurfaceShading::makeCoated(0.0, 0.3), Rgb::Ones())), 1.0,
        1e-9);
  }
}

TEST(Coat, IsReciprocal) {
  const SurfaceShading shading = SurfaceShading::makeCoated(0.8, 0.3);
  const Vec3 a(0.6, 0.0, 0.8), b(0.0, std::sqrt(0.99), 0.1);
  const Rgb albedo(0.9, 0.6, 0.3);
  const auto reflect = [&](const Vec3& viewer, const Vec3& to) -> Rgb {
    return toColor(Scattering(-viewer, -Vec3::UnitZ(), shading, albedo).evaluate(to).factor) /
           to.z();
  };
  const Rgb forward = reflect(a, b), backward = reflect(b, a);
  EXPECT_TRUE(isApprox(forward, backward, 1e-12)) << forward << "\n" << backward;
}

TEST(SurfaceNormal, FacesTheIncomingPath) {
  const SurfaceShading matte{1.0, 0.0, 10.0, 0.5};
  for (const Vec3& gradient : {Vec3(0, 0, 2), Vec3(0, 0, -2)}) {
    const Scattering s(Vec3(0, 0, -1), gradient, matte, Rgb::Ones());
    EXPECT_NEAR(s.evaluate(Vec3::UnitZ()).pdf, 1.0 / pi, 1e-12);
    EXPECT_EQ(s.evaluate(-Vec3::UnitZ()).pdf, 0.0);
  }
}

} // namespace
} // namespace fenestra::core::testing::ScatteringTests
