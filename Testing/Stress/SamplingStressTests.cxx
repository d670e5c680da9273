// Sampling routines at both ends of the range of random numbers: u = 0 and the largest u below 1.

#include "Approx.h"
#include "StressSupport.h"

namespace fenestra::core::testing::SamplingStressTests {
namespace {

constexpr double ends[] = {0.0, 0x1p-53, 0.25, 0.5, 0.75, largestUniform};

std::vector<Vec2> makeCorners() {
  std::vector<Vec2> result;
  for (const double u : ends)
    for (const double v : ends)
      result.emplace_back(u, v);
  return result;
}

TEST(SelectedDraws, SelectedDrawReturnsSelectedBits) {
  for (const int draw : {1, 2, 3, 7, 200})
    for (const std::uint64_t bits : {std::uint64_t{0}, ~std::uint64_t{0}, std::uint64_t{12345}}) {
      Random random = makeRandomWithDraw(draw, bits);
      for (int i = 1; i < draw; ++i)
        random.bits();
      EXPECT_EQ(random.bits(), bits);
    }
}

TEST(RandomEnds, UniformsLieBelowOneAndExponentialsAreFinite) {
  const auto least = [] { return makeRandomWithDraw(1, 0); };
  const auto most = [] { return makeRandomWithDraw(1, ~std::uint64_t{0}); };
  EXPECT_EQ(least().uniform(), 0.0);
  EXPECT_EQ(most().uniform(), largestUniform);
  EXPECT_EQ(least().exponential(), 0.0);
  EXPECT_NEAR(most().exponential(), 53.0 * std::log(2.0), 1e-13);
  EXPECT_EQ(most().uniform2().x(), largestUniform);
}

TEST(RandomEnds, CoordinatesBeyond32BitsDoNotWrap) {
  constexpr std::uint64_t wrap = std::uint64_t{1} << 32;
  for (const std::uint64_t small : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{77}})
    for (const std::uint64_t large : {small + wrap, small + 2 * wrap, small + (wrap << 31)}) {
      const std::uint64_t first = Random(small, small, small).bits();
      EXPECT_NE(first, Random(large, small, small).bits());
      EXPECT_NE(first, Random(small, large, small).bits());
      EXPECT_NE(first, Random(small, small, large).bits());
    }
}

TEST(DirectionEnds, DirectionIsUnit) {
  for (const Vec2& u : makeCorners())
    EXPECT_NEAR(sampleUniformSphere(u).norm(), 1.0, 4e-16);
}

// ---- phase function

struct PhaseCase {
  double g;
  double precision; ///< relative error of the density: rounding of the direction / lobe width
};

class PhaseEnds : public ::testing::TestWithParam<PhaseCase> {};

/// Inverse of Henyey and Greenstein's distribution for |g|, as 1 - cos, in long double.
long double oneMinusCosine(long double g, long double u) {
  if (g == 0.0L)
    return 2.0L * u;
  const long double a = 1.0L + g - 2.0L * g * u;
  return 2.0L * u * (1.0L - g) * (1.0L - g) * (1.0L + g * (1.0L - u)) / (a * a);
}

TEST_P(PhaseEnds, DirectionIsUnitAndDensityExact) {
  const auto [g, precision] = GetParam();
  const Rgb albedo(1.0, 0.5, 0.0);
  const long double size = std::abs(static_cast<long double>(g));
  for (const Vec3& incoming : {Vec3(0, 0, -1), Vec3(-1, 0, 0), Vec3(0.48, -0.6, 0.64)})
    for (const Vec2& u : makeCorners()) {
      const ScatterSample sample = Scattering(incoming, g, albedo).sample(0.0, u);
      EXPECT_NEAR(sample.outgoing.norm(), 1.0, 1e-15);
      EXPECT_TRUE(sample.weight == albedo);
      const long double chord2 = 2.0L * oneMinusCosine(size, u.x());
      const long double d = (1.0L - size) * (1.0L - size) + size * chord2;
      const auto expected =
          static_cast<double>(0.25L / pi * (1.0L - size * size) / (d * std::sqrt(d)));
      EXPECT_NEAR(sample.pdf / expected, 1.0, precision) << "g " << g << ", u " << u;
    }
}

INSTANTIATE_TEST_SUITE_P(MeanCosines, PhaseEnds,
                         ::testing::Values(PhaseCase{-0.9999999999, 1e-4},
                                           PhaseCase{-0.9999, 1e-10}, PhaseCase{-0.9, 1e-13},
                                           PhaseCase{-1e-12, 1e-14}, PhaseCase{0.0, 1e-14},
                                           PhaseCase{1e-12, 1e-14}, PhaseCase{0.5, 1e-14},
                                           PhaseCase{0.9999, 1e-10},
                                           PhaseCase{0.9999999999, 1e-4}));

// ---- surface lobes

/// Unit direction of incidence with this cosine to the normal z, as exact as double allows.
Vec3 makeIncident(double cosine) {
  return {std::sqrt((1.0 - cosine) * (1.0 + cosine)), 0.0, -cosine};
}

TEST(SurfaceEnds, DirectionIsUnitAndWeightBounded) {
  // Lobes are sampled in proportion to the albedo and to the viewer's Fresnel term. So a weight is
  // at most the ratio of the maximum to the minimum Fresnel term, 1 / F0 = 25.
  constexpr double greatestWeight = 25.0 * (1.0 + 1e-9);
  constexpr double most = std::numeric_limits<double>::max();
  const Vec2 strengths[] = {{1, 0}, {0, 1}, {0.9, 0.2}, {0, 0}, {1e-300, 1e-300}, {1e300, 1e300}};
  int sampled = 0;
  for (const double cosine : {1.0, 0.5, 1e-3, 1e-8, 1e-17, 1e-300, 0.0})
    for (const double power : {0.0, 1e-3, 10.0, 1e4, 1e8, 1e16, 1e30, 1e300, most})
      for (const Vec2& strength : strengths)
        for (const Vec3& gradient : {Vec3(0, 0, -1), Vec3(0, 0, 1e-40), Vec3(0, 0, 1e45)}) {
          const Scattering surface(makeIncident(cosine), gradient,
                                   {strength.x(), strength.y(), power, 0.5}, Rgb(1.0, 0.3, 0.0));
          for (const double choice : {0.0, largestUniform})
            for (const Vec2& u : makeCorners()) {
              const ScatterSample sample = surface.sample(choice, u);
              ASSERT_NEAR(sample.outgoing.norm(), 1.0, 1e-12) << cosine << " " << power;
              ASSERT_TRUE(sample.pdf >= 0.0 && std::isfinite(sample.pdf)) << cosine << " " << power;
              ASSERT_TRUE((sample.weight >= 0.0).all() && (sample.weight <= greatestWeight).all())
                  << sample.weight << ", " << cosine << " " << power;
              ASSERT_TRUE(sample.pdf > 0.0 || sample.weight.maxCoeff() == 0.0);
              sampled += sample.pdf > 0.0 ? 1 : 0;
            }
        }
  EXPECT_GT(sampled, 50000) << "most samples must have a direction";
}

// ---- lights

const Grid unitGrid(Size3(2, 2, 2), Affine::Identity());

Camera makeCamera() {
  CameraPose pose;
  pose.position = {0.5, -50, 0.5};
  pose.target = {0.5, 0.5, 0.5};
  return {pose, 8, 8};
}

/// Map of 8 x 4 texels: `radiance` where `isLit(column, row)`, 0 elsewhere.
template <typename IsLit>
EnvironmentLight makeMapLight(IsLit&& isLit, float radiance = 1.0F) {
  EnvironmentLight light;
  light.map = {8, 4, {}};
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 8; ++column)
      light.map.rgb.insert(light.map.rgb.end(), 3, isLit(column, row) ? radiance : 0.0F);
  return light;
}

std::vector<EnvironmentLight> makeEnvironments() {
  constexpr float most = std::numeric_limits<float>::max();
  constexpr float least = std::numeric_limits<float>::denorm_min();
  const auto checker = [](int column, int row) { return (column + row) % 2 == 0; };
  return {EnvironmentLight{},
          makeMapLight([](int, int) { return true; }),
          makeMapLight([](int, int row) { return row == 1; }),
          makeMapLight([](int column, int row) { return column == 7 && row == 3; }),
          makeMapLight([](int column, int row) { return column == 0 && row == 0; }),
          makeMapLight(checker),
          makeMapLight(checker, most),
          makeMapLight(checker, least)};
}

TEST(EnvironmentEnds, DirectionIsUnitInOrNextToLitTexel) {
  for (const EnvironmentLight& light : makeEnvironments()) {
    const EnvironmentSampler sampler(light);
    for (const Vec2& u : makeCorners()) {
      const Vec3 direction = sampler.sample(u);
      EXPECT_NEAR(direction.norm(), 1.0, 4e-16);
      EXPECT_TRUE(sampler.pdf(direction) >= 0.0 && std::isfinite(sampler.pdf(direction)));
      // A direction on a texel's edge may be assigned to the neighbor: a lit texel must be next to
      // it.
      double greatest = 0.0;
      for (int i = 0; i < 32; ++i) { // around, above and below
        const double phi = 2.0 * pi * (i + 0.3) / 16.0;
        const Vec3 step(1e-7 * std::cos(phi), 1e-7 * std::sin(phi), i < 16 ? 1e-8 : -1e-8);
        greatest = std::max(greatest, sampler.pdf((direction + step).normalized()));
      }
      EXPECT_GT(greatest, 0.0) << u;
    }
  }
}

TEST(EnvironmentEnds, BlackMapIsNeverSampled) {
  const EnvironmentLight black = makeMapLight([](int, int) { return false; });
  const EnvironmentSampler sampler(black);
  const LightSet set({black}, unitGrid, makeCamera());
  for (const Vec2& u : makeCorners()) {
    EXPECT_NEAR(sampler.sample(u).norm(), 1.0, 4e-16);
    EXPECT_EQ(sampler.pdf(sampler.sample(u)), 0.0);
    EXPECT_FALSE(set.sample(Vec3::Zero(), 0.0, u));
  }
}

AreaLight makeAreaLight(AreaLight::Shape shape, double size) {
  AreaLight light;
  light.shape = shape;
  light.center = Vec3::Zero();
  light.normal = Vec3::UnitZ();
  light.size = Vec2::Constant(size);
  return light;
}

std::vector<std::vector<Light>> makeLightings() {
  std::vector<std::vector<Light>> result;
  for (const EnvironmentLight& light : makeEnvironments())
    result.push_back({light});
  result.push_back({DirectionalLight{}});
  for (const double size : {2.0, 1e-30, 1e30})
    for (const auto shape : {AreaLight::Shape::rectangle, AreaLight::Shape::disk})
      result.push_back({makeAreaLight(shape, size)});
  result.push_back({makeAreaLight(AreaLight::Shape::disk, 2.0), DirectionalLight{},
                    EnvironmentLight{}, makeEnvironments()[2],
                    makeAreaLight(AreaLight::Shape::rectangle, 1e-3)});
  return result;
}

TEST(LightEnds, DirectionIsUnitAndContributionFinite) {
  // Points above, in the plane of, behind and on the area lights at the origin; next to and far
  // from the lights.
  const Vec3 points[] = {{0, 0, 1},   {0.5, 0.5, 0},       {0, 0, -1},        {0, 0, 0},
                         {-1, -1, 0}, {1, 0, 1e-300},      {0, 0, 5e-324},    {1e-200, 0, 1e-200},
                         {0, 0, 1e9}, {0, 1e-160, 1e-161}, {1e6, 1e6, 1e-300}};
  int sampled = 0;
  for (const std::vector<Light>& lights : makeLightings()) {
    const LightSet set(lights, unitGrid, makeCamera());
    for (const Vec3& point : points)
      for (const double choice : {0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, largestUniform})
        for (const Vec2& u : makeCorners()) {
          const std::optional<LightSample> sample = set.sample(point, choice, u);
          if (!sample)
            continue;
          ++sampled;
          ASSERT_NEAR(sample->direction.norm(), 1.0, 1e-12) << point;
          ASSERT_GT(sample->distance, 0.0);
          ASSERT_GT(sample->pdf, 0.0);
          ASSERT_TRUE(allFinite(sample->radiance));
          // An infinite pdf (grazing, or a light without area) must give a contribution of 0.
          ASSERT_TRUE(allFinite(sample->radiance / sample->pdf)) << point;
        }
  }
  EXPECT_GT(sampled, 20000);
}

TEST(LightEnds, LightInVolumeCenterLeavesUsableProbabilities) {
  AreaLight light = makeAreaLight(AreaLight::Shape::disk, 1.0);
  light.center = unitGrid.worldCenter();
  const EnvironmentLight sky{Rgb::Ones(), {2, 1, std::vector<float>(6, 1.0F)}};
  const LightSet set({light, sky}, unitGrid, makeCamera());
  EXPECT_NEAR(set.evaluateEnvironment(Vec3::UnitX()).pdf, 0.5 * 0.25 / pi, 1e-12);
}

// ---- distances and paths: each number of their Random in turn is at an end of the range

constexpr std::uint64_t endBits[] = {0, ~std::uint64_t{0}};

Volume makeBumps() {
  return makeVolume(makeCenteredGrid({9, 8, 7}, {1.0, 1.0, 1.0}), [](const Vec3& p) {
    return 0.5 + 0.5 * std::sin(1.3 * p.x()) * std::cos(0.9 * p.y() + p.z());
  });
}

TEST(TrackingEnds, CollisionsStayInRange) {
  const Volume volume = makeBumps();
  const RayProbe<> probe(volume, makeLinearTransfer(2.0, Rgb::Ones()));
  const Interval range{1.0, 12.0};
  for (const std::uint64_t bits : endBits)
    for (int draw = 1; draw <= 40; ++draw)
      for (const Vec3& origin : {Vec3(-8, 0.3, 0.2), Vec3(-8, 0, 0), Vec3(0, 0, 0)}) {
        Counters counters;
        Random forCollision = makeRandomWithDraw(draw, bits);
        const double t = probe.tracker().sampleCollision(
            {origin, Vec3::UnitX()}, range, forCollision.uniform2(), forCollision, counters);
        EXPECT_TRUE(t == infinity || (t >= range.begin && t <= range.end)) << t;
        Random forRatio = makeRandomWithDraw(draw, bits);
        const double ratio =
            probe.tracker().transmittance({origin, Vec3::UnitX()}, range, forRatio, counters);
        EXPECT_TRUE(ratio >= 0.0 && ratio <= 1.0) << ratio;
        EXPECT_LT(counters.lookups, 1000U);
      }
}

/// Sample of one path, with its counters.
PathSample tracePath(const TestScene& scene, const PrimarySamples& numbers, Counters& counters) {
  return withIntegrator(scene, [&](const auto& estimator) {
    return *estimator.trace(0.5 * scene.width, 0.5 * scene.height, numbers, counters);
  });
}

TEST(PathEnds, RadianceIsBoundedByNumberOfCollisions) {
  for (const bool hybrid : {false, true})
    for (const double g : {-0.9999, 0.0, 0.9999}) {
      TestScene scene{
          makeBumps(), makeLinearTransfer(5.0, Rgb(1.0, 0.9, 0.0), g), {EnvironmentLight{}}, {}};
      scene.pose.position = {0.0, -20.0, 0.0};
      scene.pose.target = Vec3::Zero();
      if (hybrid)
        scene.transfer.shading = SurfaceShading{0.8, 0.2, 1e4, 0.5};
      for (const std::uint64_t bits : endBits)
        for (int draw = 1; draw <= 150; ++draw) {
          Counters counters;
          const Rgb radiance = tracePath(scene, makeSamplesWithDraw(draw, bits), counters).radiance;
          // At each collision the sampled light and the light that is hit, weighted by the balance
          // heuristic, add at most one weight each.
          const double weight = hybrid ? 25.0 : 1.0;
          const double bound = 2.0 * weight * static_cast<double>(counters.collisions + 1);
          ASSERT_TRUE((radiance >= 0.0).all() && (radiance <= bound).all())
              << radiance << ", draw " << draw << ", g " << g;
        }
    }
}

} // namespace
} // namespace fenestra::core::testing::SamplingStressTests
