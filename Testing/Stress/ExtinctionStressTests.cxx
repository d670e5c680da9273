// Extinctions from 1e-8 to 1e8 per mm in one volume, against closed forms and against the same
// scene in another unit of length. Also bounds the work in the worst case.

#include "StressSupport.h"

#include "integrator/simd/Tracker.h"

namespace fenestra::core::testing::ExtinctionStressTests {
namespace {

constexpr double thinnest = 1e-8; // per mm
constexpr double densest = 1e8;

/// Extinction thinnest * 10^(16 s / last) over s in [0, last], as a table of `knots` pieces.
TransferFunction makeLogarithmicRamp(double last, int knots, const Rgb& albedo) {
  std::vector<ScalarFunction::Knot> table;
  for (int i = 0; i <= knots; ++i)
    table.push_back(makeKnot(last * i / knots, thinnest * std::pow(10.0, 16.0 * i / knots)));
  return {ScalarFunction(std::move(table)), ColorFunction({{0.0, albedo}})};
}

/// Integral of a table over [from, to] within its knots, no two of which coincide.
double integrate(const ScalarFunction& f, double from, double to) {
  std::vector<double> ends = {from, to};
  for (const auto& k : f.knots())
    if (k.position > from && k.position < to)
      ends.push_back(k.position);
  std::sort(ends.begin(), ends.end());
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    sum += 0.5 * (f(ends[i]).value() + f(ends[i + 1]).value()) * (ends[i + 1] - ends[i]);
  return sum;
}

/// Layers along z with scalars 0, 1, 2, ...; `across` mm wide.
Volume makeLayers(int count, double spacing, double across) {
  return makeVolume(makeCenteredGrid({2, 2, count}, {across / 2.0, across / 2.0, spacing}),
                    [](const Vec3& p) { return p.z(); });
}

// ---- along one ray

struct RampCase {
  double begin; ///< scalar at the ray's start
  double depth; ///< optical depth to the ray's end
};

class LogarithmicRamp : public ::testing::TestWithParam<RampCase> {};

TEST_P(LogarithmicRamp, TransmittanceEqualsExpOfIntegral) {
  const auto [begin, depth] = GetParam();
  constexpr double spacing = 0.002;
  const Volume volume = makeLayers(9, spacing, 0.1); // two decades per voxel
  const RayProbe<> probe(volume, makeLogarithmicRamp(8.0, 96, Rgb::Zero()));
  const ScalarFunction& extinction = probe.medium().transfer().extinction;
  double end = begin;
  for (double step = 8.0; step > 1e-13; step *= 0.5)
    if (end + step <= 8.0 && spacing * integrate(extinction, begin, end + step) <= depth)
      end += step;
  const double expected = std::exp(-spacing * integrate(extinction, begin, end));
  ASSERT_NEAR(expected, std::exp(-depth), 1e-3);

  const auto place = [&](double s) { return Vec3(0.01, -0.02, spacing * (s - 4.0)); };
  const Interval range{0.0, spacing * (end - begin)};
  probe.expectTransmittance({place(begin), Vec3::UnitZ()}, range, expected, scaleSamples(4000));
  probe.expectTransmittance({place(end), -Vec3::UnitZ()}, range, expected, scaleSamples(4000));
}

INSTANTIATE_TEST_SUITE_P(LaneIntervals, LogarithmicRamp,
                         ::testing::Values(RampCase{0.0, 0.1}, RampCase{0.0, 1.0},
                                           RampCase{0.0, 3.0}, RampCase{2.0, 1.0},
                                           RampCase{4.0, 0.5}, RampCase{5.0, 2.0},
                                           RampCase{6.0, 1.0}, RampCase{7.0, 0.2},
                                           RampCase{7.0, 3.0}, RampCase{7.9, 1.0}));

TEST(NullCollisions, ThinMediumUnderLargeMajorantIsClear) {
  // Optical depth 1.6e-10 under a majorant of 1e8: the ratio may miss that depth, plus roundoff.
  const Volume volume = makeVolume(makeCenteredGrid({8, 8, 8}, Vec3::Constant(0.002)),
                                   [](const Vec3& p) { return p.x(); });
  const RayProbe<> probe(volume, {ScalarFunction({makeKnot(0.0, thinnest), makeKnot(0.0, thinnest),
                                                  makeKnot(0.4, thinnest), makeKnot(0.5, densest)}),
                                  ColorFunction({{0.0, Rgb::Zero()}})});
  // Within a quarter voxel of the lower face, where the field is clamped to 0.
  const Ray ray{{-0.0075, 0.0, -1.0}, Vec3::UnitZ()};
  const double tentative = densest * 0.016;
  for (int i = 0; i < scaleSamples(4); ++i) {
    Counters counters;
    Random random(3, static_cast<std::uint64_t>(i), 0);
    const double ratio = probe.tracker().transmittance(ray, {}, random, counters);
    EXPECT_NEAR(ratio, 1.0 - 1.6e-10, 2e-10);
    EXPECT_NEAR(static_cast<double>(counters.lookups), tentative, 6.0 * std::sqrt(tentative));
    Random again(4, static_cast<std::uint64_t>(i), 0);
    EXPECT_EQ(probe.tracker().sampleCollision(ray, {}, again.uniform2(), again, counters),
              infinity);
  }
}

// ---- half-spaces: every opaque layered medium of one albedo reflects like Chandrasekhar's
// half-space, for any profile

struct Profile {
  const char* name;
  TransferFunction (*transfer)(const Rgb& albedo);
};

constexpr int depthVoxels = 33;
constexpr double opaqueExtinction = 1e6; ///< 1e8 next to clear voxels: a minute of null collisions

TransferFunction makeDense(const Rgb& albedo) {
  return {ScalarFunction({makeKnot(0.0, densest)}), ColorFunction({{0.0, albedo}})};
}
TransferFunction makeSmooth(const Rgb& albedo) {
  return makeLogarithmicRamp(depthVoxels - 1, 400, albedo);
}
TransferFunction makeStepped(const Rgb& albedo) {
  return {ScalarFunction({makeKnot(0.0, thinnest), makeKnot(20.3, thinnest),
                          makeKnot(20.3, opaqueExtinction)}),
          ColorFunction({{0.0, albedo}})};
}
/// Three thin layers of optical depth 0.3 to 0.6 between clear layers, then an opaque layer.
TransferFunction makeStriped(const Rgb& albedo) {
  return {
      ScalarFunction({makeKnot(0.0, thinnest), makeKnot(10.0, thinnest), makeKnot(10.0, 2000.0),
                      makeKnot(10.4, 2000.0), makeKnot(10.4, thinnest), makeKnot(20.0, thinnest),
                      makeKnot(20.0, 30000.0), makeKnot(20.04, 30000.0), makeKnot(20.04, thinnest),
                      makeKnot(25.0, thinnest), makeKnot(26.0, 1200.0), makeKnot(27.0, thinnest),
                      makeKnot(30.0, thinnest), makeKnot(30.0, 1e5)}),
      ColorFunction({{0.0, albedo}})};
}

/// Maximum optical depth that the SIMD tracker supports, from clear to opaque.
constexpr double maxSimdDepth = 1.6e5;
TransferFunction makeDeep(const Rgb& albedo) {
  return {ScalarFunction({makeKnot(0.0, 0.0), makeKnot(depthVoxels - 1, maxSimdDepth)}),
          ColorFunction({{0.0, albedo}})};
}

using ReflectanceCase = std::tuple<Profile, std::pair<double, double>>; ///< albedo, reflectance
class HalfSpaceProfile : public ::testing::TestWithParam<ReflectanceCase> {};

TEST_P(HalfSpaceProfile, ReflectanceEqualsChandrasekharsValue) {
  const auto& [profile, pair] = GetParam();
  const auto [albedo, reflectance] = pair;
  TestScene scene{makeLayers(depthVoxels, 0.0005, 0.4), // 0.0165 mm deep: no loss at the sides
                  profile.transfer(Rgb::Constant(albedo)), {EnvironmentLight{}}, {}, 8, 8};
  scene.pose.position = {0.0, 0.0, -1.0}; // the thin end faces the camera
  scene.pose.target = Vec3::Zero();
  scene.pose.up = Vec3::UnitY();
  scene.pose.scale = 0.001;
  const RenderResult result = renderScene(scene, scaleSamples(250));
  const Estimate estimate = estimateMean(result.film);
  EXPECT_NEAR(estimate.mean, reflectance, 4.0 * estimate.error + 5e-5); // four known digits
  EXPECT_LT(estimate.error, relaxError(0.005));
  RecordProperty("lookupsPerPath", std::to_string(result.counters.lookups / result.counters.paths));
}

INSTANTIATE_TEST_SUITE_P(
    Profiles, HalfSpaceProfile,
    ::testing::Combine(::testing::Values(Profile{"dense", makeDense}, Profile{"smooth", makeSmooth},
                                         Profile{"stepped", makeStepped},
                                         Profile{"striped", makeStriped},
                                         Profile{"deep", makeDeep}),
                       ::testing::Values(std::pair(0.5, 0.1152), std::pair(0.9, 0.4149))),
    [](const auto& info) {
      return std::string(std::get<0>(info.param).name) +
             (std::get<1>(info.param).first == 0.5 ? "Dark" : "Bright");
    });

TEST(HalfSpace, SimdTrackerSupportsDepthsUpToItsLimit) {
  const Volume volume = makeLayers(depthVoxels, 0.0005, 0.4);
  EXPECT_TRUE(SimdTracker::isSupported(volume, makeDeep(Rgb::Ones())));
  EXPECT_FALSE(SimdTracker::isSupported(volume, makeDeep(Rgb::Ones()).withDensity(1.2)));
  EXPECT_FALSE(SimdTracker::isSupported(volume, makeStepped(Rgb::Ones())));
}

// ---- images

/// 8^3 voxels, alternating 0 and 1.
Volume makeCheckerboard(double spacing) {
  return makeVolume(makeCenteredGrid({8, 8, 8}, Vec3::Constant(spacing)),
                    [](const Vec3& p) { return std::fmod(p.x() + p.y() + p.z(), 2.0); });
}

Volume makeDiagonalRamp(double spacing) {
  return makeVolume(makeCenteredGrid({8, 8, 8}, Vec3::Constant(spacing)),
                    [](const Vec3& p) { return (p.x() + p.y() + p.z()) / 21.0; });
}

TransferFunction makeContrast(double high, const Rgb& albedo) {
  return {ScalarFunction({makeKnot(0.5, thinnest), makeKnot(0.5, high)}),
          ColorFunction({{0.0, albedo}})};
}

/// Scene seen from a corner.
TestScene makeCornerScene(Volume volume, const TransferFunction& transfer) {
  const double radius = volume.grid.boundingRadius();
  TestScene scene{std::move(volume), transfer, {EnvironmentLight{}}, {}, 8, 8};
  scene.pose.position = radius * Vec3(2.0, -3.0, 1.5);
  scene.pose.target = Vec3::Zero();
  scene.pose.scale = radius;
  return scene;
}

TEST(ExtremeContrast, FurnaceIsOneWithoutAbsorption) {
  for (const double high : {1.0, 1e3, 5e4}) { // optical depth <= 800
    const TestScene scene =
        makeCornerScene(makeCheckerboard(0.002), makeContrast(high, Rgb::Ones()));
    expectRadianceOne(renderScene(scene, scaleSamples(high > 1e4 ? 32 : 128)));
  }
}

using SceneMaker = TestScene (*)(double unit);

/// Scenes with lengths multiplied and extinctions divided by `unit`. Powers of two change no bit.
TestScene makeRampScene(double unit) {
  return makeCornerScene(makeDiagonalRamp(0.002 * unit),
                         makeLogarithmicRamp(1.0, 64, Rgb(0.9, 0.5, 0.0)).withDensity(1.0 / unit));
}
TestScene makeCheckerScene(double unit) {
  return makeCornerScene(makeCheckerboard(0.002 * unit),
                         makeContrast(densest, Rgb(0.9, 0.5, 0.0)).withDensity(1.0 / unit));
}
TestScene makeHomogeneousScene(double unit) {
  return makeCornerScene(makeVolume(makeCenteredGrid({8, 8, 8}, Vec3::Constant(unit)),
                                    [](const Vec3&) { return 1.0; }),
                         makeLinearTransfer(0.3 / unit, Rgb(1.0, 0.9, 0.5)));
}

TEST(UnitOfLength, PowerOfTwoKeepsEveryBitOfImage) {
  struct Case {
    SceneMaker make;
    double unit;
    int samples;
  };
  for (const auto& [make, unit, samples] :
       {Case{makeRampScene, 0x1p10, 4}, Case{makeCheckerScene, 0x1p10, 1},
        Case{makeHomogeneousScene, 0x1p26, 64}, Case{makeHomogeneousScene, 0x1p-26, 64}}) {
    TestScene scene = make(1.0);
    scene.transfer.g = 0.3;
    const RenderResult usual = renderScene(scene, scaleSamples(samples));
    TestScene other = make(unit);
    other.transfer.g = 0.3;
    const RenderResult scaled = renderScene(other, scaleSamples(samples));
    expectEqualBits(usual.film, scaled.film);
    EXPECT_EQ(usual.counters.lookups, scaled.counters.lookups);
    const Estimate estimate = estimateMean(usual.film);
    EXPECT_TRUE(estimate.mean > 0.0 && estimate.mean < 1.0) << estimate.mean;
  }
}

TEST(ExtremeContrast, NumberOfCollisionsIsBounded) {
  // A crossing ray has (majorant x length) tentative collisions on average; Poisson-distributed.
  const double crossing = densest * 0.016 * std::sqrt(3.0);
  const auto maximum = static_cast<std::uint64_t>(crossing + 6.0 * std::sqrt(crossing));
  for (const TestScene& scene : {makeRampScene(1.0), makeCheckerScene(1.0)}) {
    const RayProbe<> probe(scene.volume, scene.transfer);
    const Camera camera(scene.pose, 8, 8);
    std::uint64_t worst = 0;
    for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(scaleSamples(64)); ++i) {
      Random random(9, i, 0);
      Counters counters;
      const Ray ray = camera.makeRay(8.0 * random.uniform(), 8.0 * random.uniform());
      probe.tracker().transmittance(ray, {}, random, counters);
      worst = std::max(worst, counters.lookups);
    }
    EXPECT_LE(worst, maximum);
    RecordProperty("worstLookupsOfARay", std::to_string(worst));
    std::cout << "maximum null collisions of a ray: " << worst
              << ", mean per path: " << renderScene(scene, 1).counters.lookups / 64 << '\n';
  }
}

// Distances at which a free path is shorter than the spacing of doubles at the volume.
TEST(FarCamera, TransmittanceDoesNotDependOnDistance) {
  const Volume volume = makeVolume(makeCenteredGrid({8, 8, 8}, Vec3::Constant(20.0)),
                                   [](const Vec3& p) { return p.x() < 4.0 ? 0.0 : 1.0; });
  // Thin where the ray passes, but with a majorant 10 000 times as high.
  const RayProbe<> probe(volume, {ScalarFunction({makeKnot(0.4, 0.005), makeKnot(0.5, 50.0)}),
                                  ColorFunction({{0.0, Rgb::Zero()}})});
  const double crossing = 160.0 * 50.0;
  for (const double distance : {1e9, 1e12, 1e15}) {
    const int n = scaleSamples(400);
    const Counters counters =
        probe.expectTransmittance({{-15.0, 0.0, -distance}, Vec3::UnitZ()}, {}, std::exp(-0.8), n);
    EXPECT_LT(static_cast<double>(counters.lookups),
              2.0 * n * (crossing + 6.0 * std::sqrt(crossing)));
  }
}

} // namespace
} // namespace fenestra::core::testing::ExtinctionStressTests
