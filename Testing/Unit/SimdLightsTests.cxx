// SIMD light sampling and evaluation against scalar code on each instruction set: sampled
// directions, their densities, and the radiance along escaping rays.

#include "EachInstructionSet.h"
#include "Histogram.h"

#include "integrator/simd/PathSteps.h"

#include <memory>

namespace fenestra::core::testing::SimdLightsTests {
namespace {

EnvironmentMap makeRandomMap(int width, int height, std::uint64_t seed) {
  EnvironmentMap map{width, height, {}};
  for (int i = 0; i < width * height; ++i) {
    Random random(seed, static_cast<std::uint64_t>(i), 0);
    const float value = i % 11 == 3 ? 0.0F : i == 40 ? 20.0F : static_cast<float>(random.uniform());
    map.rgb.insert(map.rgb.end(), {value, 0.5F * value, 0.1F * value});
  }
  return map;
}

/// Map with one bright texel.
EnvironmentMap makeLamp(int width, int height, int litTexel) {
  EnvironmentMap map{width, height,
                     std::vector<float>(static_cast<std::size_t>(3 * width * height))};
  map.rgb[static_cast<std::size_t>(3 * litTexel)] = 3.0F;
  return map;
}

struct LightCase {
  const char* name;
  std::vector<Light> lights;
};

std::vector<LightCase> makeLightCases() {
  const SkyLight sky{Rgb(0.3, 0.2, 0.1), Rgb::Ones(), Rgb::Zero(), Vec3::UnitX(),
                     LightFrame::world};
  return {
      {"one map", {EnvironmentLight{Rgb(0.5, 1.0, 2.0), makeRandomMap(12, 6, 9)}}},
      {"odd numbers of texels", {EnvironmentLight{Rgb::Ones(), makeRandomMap(7, 5, 8)}}},
      {"one texel", {EnvironmentLight{Rgb::Ones(), makeRandomMap(1, 1, 5)}}},
      {"more columns than 256", {EnvironmentLight{Rgb::Ones(), makeRandomMap(600, 3, 4)}}},
      {"lamp at the north pole", {EnvironmentLight{Rgb::Ones(), makeLamp(16, 12, 5)}}},
      {"lamp at the south pole", {EnvironmentLight{Rgb::Ones(), makeLamp(16, 12, 16 * 11 + 2)}}},
      {"two maps, a constant, a sky, a black map",
       {EnvironmentLight{Rgb(0.2, 0.3, 0.4), {}},
        EnvironmentLight{Rgb::Ones(), makeRandomMap(12, 6, 3)},
        EnvironmentLight{Rgb::Ones(), EnvironmentMap{2, 1, std::vector<float>(6, 0.0F)}}, sky,
        EnvironmentLight{Rgb(2.0, 0.0, 1.0), makeLamp(16, 12, 70)}}},
  };
}

/// Thin medium of 1 mm voxels around the origin, with index axes along RAS; albedo 1, isotropic.
struct Fog {
  static Volume makeVolume() {
    Affine toWorld = Affine::Identity();
    toWorld.translation() = Vec3::Constant(-3.5);
    Volume result{Grid(Size3(8, 8, 8), toWorld), LargeArray<float>(512, 1.0F), 0.0, 0.0, "", {}};
    computeRange(result);
    return result;
  }

  Volume volume = makeVolume();
  TransferFunction transfer{
      ScalarFunction({{0.0, ScalarFunction::Value(0.0)}, {1.0, ScalarFunction::Value(0.1)}}),
      ColorFunction({{0.0, Rgb::Ones()}})};
  Domain domain{volume.grid, std::nullopt};
  MajorantGrid majorants{volume.grid, MinMaxGrid(volume, 0), transfer, ClipNone{}};
  Clip clip = ClipNone{};
  SimdTracker tracker{volume, domain, transfer, majorants, clip};
  static constexpr std::uint64_t maxBounces = 100;
  static constexpr bool normalsWanted = false;
  LightSet lights;
  SimdShading events;

  explicit Fog(const std::vector<Light>& lightList)
      : lights(lightList, volume.grid, makeCamera()),
        events(volume.grid, transfer, lights, maxBounces, normalsWanted) {}

  static Camera makeCamera() {
    CameraPose pose;
    pose.position = {0, -50, 0};
    return {pose, 8, 8};
  }
};

/// Light sample of a scattering in the fog. `estimate`: per channel, radiance times phase function
/// over the sum of the densities of light and phase function sampling.
struct ShadowSample {
  Vec3 direction;
  Rgb estimate;
};

/// Sets path i to a vertex at the center of the fog.
void setPath(PathBatch& paths, std::size_t i, const Vec3& direction, const Vec2& scattered,
             std::uint64_t key) {
  paths.rays.set(i, {Vec3::Constant(3.5), direction}, 9.0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    paths.direction[axis][i] = static_cast<float>(direction[static_cast<int>(axis)]);
    paths.throughput[axis][i] = 1.0F;
    paths.radiance[axis][i] = 0.0F;
  }
  const Vec2 choices = Random(key).uniform2();
  for (std::size_t axis = 0; axis < 2; ++axis) {
    paths.uDirection[axis][i] = static_cast<float>(scattered[static_cast<int>(axis)]);
    paths.uChoices[axis][i] = static_cast<float>(choices[static_cast<int>(axis)]);
  }
  paths.bounces[i] = 0;
  paths.key[i] = static_cast<std::uint32_t>(key);
  paths.counter[i] = static_cast<std::uint32_t>(key >> 32);
}

/// Light samples of paths that scatter at the origin; omits paths without one.
std::vector<ShadowSample> sampleLights(const Fog& fog, std::uint64_t seed, std::size_t count) {
  const auto paths = std::make_unique<PathBatch>();
  const auto lights = std::make_unique<ShadowBatch>();
  std::vector<ShadowSample> all;
  for (std::size_t from = 0; from < count; from += RayBatch::capacity) {
    paths->rays.size = std::min(RayBatch::capacity, count - from);
    for (std::size_t i = 0; i < paths->rays.size; ++i) {
      Random random(seed, from + i, 0);
      const Vec2 scattered = random.uniform2();
      setPath(*paths, i, Vec3::UnitX(), scattered, random.bits());
      paths->rays.result[i] = 0.0F;
      paths->rays.scalar[i] = 1.0F;
    }
    Counters counters;
    scatterPaths(fog.tracker.medium(), fog.events, *paths, *lights, counters);
    for (std::size_t i = 0; i < lights->rays.size; ++i) {
      ShadowSample s;
      for (int axis = 0; axis < 3; ++axis) {
        s.direction[axis] = static_cast<double>(lights->rays.direction[std::size_t(axis)][i]);
        s.estimate[axis] = static_cast<double>(lights->radiance[std::size_t(axis)][i]);
      }
      all.push_back(s);
    }
  }
  return all;
}

/// Light that rays, scattered with density 1 / 4 pi, receive from outside the fog.
std::vector<Rgb> collectEmitted(const Fog& fog, const std::vector<Vec3>& directions) {
  const auto paths = std::make_unique<PathBatch>();
  const auto lights = std::make_unique<ShadowBatch>();
  std::vector<Rgb> all;
  for (std::size_t from = 0; from < directions.size(); from += RayBatch::capacity) {
    paths->rays.size = std::min(RayBatch::capacity, directions.size() - from);
    for (std::size_t i = 0; i < paths->rays.size; ++i) {
      setPath(*paths, i, directions[from + i], Vec2::Zero(), i);
      paths->bounces[i] = 1;
      paths->scatterPdf[i] = static_cast<float>(0.25 / pi);
      paths->rays.result[i] = std::numeric_limits<float>::infinity();
    }
    Counters counters;
    scatterPaths(fog.tracker.medium(), fog.events, *paths, *lights, counters);
    for (std::size_t i = 0; i < paths->rays.size; ++i)
      all.emplace_back(paths->radiance[0][i], paths->radiance[1][i], paths->radiance[2][i]);
  }
  return all;
}

/// Estimate of the scalar lights for a scattering with density 1 / 4 pi in that direction. It is
/// the same for light sampling and for phase function sampling.
Rgb computeExpected(const LightSet& lights, const Vec3& direction) {
  const EmitterHit hit = lights.evaluateEnvironment(direction);
  return hit.radiance * (0.25 / pi / (0.25 / pi + hit.pdf));
}

bool isNear(const Rgb& a, const Rgb& b) {
  return ((a - b).abs() <= 2e-5 * (1e-3 + a.abs() + b.abs())).all();
}

/// Number of directions in which values differ from the scalar lights. Only directions at texel
/// edges should differ.
template <typename Values, typename DirectionOf, typename ValueOf>
std::size_t countMismatches(const Fog& fog, const Values& values, DirectionOf&& getDirection,
                            ValueOf&& getValue) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    count += isNear(getValue(i), computeExpected(fog.lights, getDirection(i).normalized())) ? 0 : 1;
  return count;
}

class SimdLights : public InstructionSetTest {};

/// Chi-squared test of two histograms with equal sample counts, as a z-score.
double compareHistograms(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> mean(a.size()),
      deviating(a.size()); // (deviating - mean)^2 / mean = (a - b)^2 / (a + b)
  for (std::size_t i = 0; i < a.size(); ++i) {
    mean[i] = 0.5 * (a[i] + b[i]);
    deviating[i] = mean[i] + std::sqrt(0.5) * (a[i] - b[i]);
  }
  return chiSquaredZScore(deviating, mean);
}

TEST_P(SimdLights, SampledDirectionsMatchTheScalarLights) {
  for (const LightCase& s : makeLightCases()) {
    SCOPED_TRACE(s.name);
    const Fog fog(s.lights);
    constexpr std::size_t count = 200000;
    const std::vector<ShadowSample> all = sampleLights(fog, 31, count);
    std::vector<double> simd(SphereBins::count, 0.0), scalar(SphereBins::count, 0.0);
    for (const ShadowSample& sample : all)
      simd[static_cast<std::size_t>(SphereBins::index(sample.direction))] += 1.0;
    for (std::size_t i = 0; i < count; ++i) {
      Random random(32, i, 0);
      if (const auto sample = fog.lights.sample(Vec3::Zero(), random))
        scalar[static_cast<std::size_t>(SphereBins::index(sample->direction))] += 1.0;
    }
    EXPECT_LT(compareHistograms(simd, scalar), 4.5);
    const std::size_t deviating = countMismatches(
        fog, all, [&](std::size_t i) { return all[i].direction; },
        [&](std::size_t i) { return all[i].estimate; });
    EXPECT_LT(deviating, count / 10000) << "different radiance or density";
  }
}

TEST_P(SimdLights, MeanOfRadianceOverDensityIsTheIntegral) {
  for (const LightCase& s : makeLightCases()) {
    SCOPED_TRACE(s.name);
    const Fog fog(s.lights);
    // Light and phase function sampling, weighted (MIS), together estimate the mean radiance.
    constexpr std::size_t count = 200000;
    std::vector<Vec3> directions;
    for (std::size_t i = 0; i < count; ++i) {
      Random random(7, i, 0);
      directions.push_back(sampleUniformSphere(random.uniform2()));
    }
    Rgb sum = Rgb::Zero(), squares = Rgb::Zero(), expected = fog.lights.tables().constant;
    for (const ShadowSample& sample : sampleLights(fog, 8, count)) {
      sum += sample.estimate;
      squares += sample.estimate.square();
    }
    for (const Rgb& sample : collectEmitted(fog, directions)) {
      sum += sample;
      squares += sample.square();
    }
    for (const PlacedEnvironment& each : fog.lights.environments())
      if (!each.sampler.isConstant())
        expected += each.sampler.mean();
    for (const auto& sky : fog.lights.tables().skies) // linear in the cosine
      expected += sky.middle + 0.25 * (sky.toTop + sky.toBottom);
    const Rgb maxStandardError = squares.sqrt() / count; // at least the standard error
    EXPECT_TRUE(((sum / count - expected).abs() <= 4.5 * maxStandardError).all())
        << sum[0] / count << " instead of " << expected[0];
  }
}

TEST_P(SimdLights, EscapingRaysMatchTheScalarLights) {
  std::vector<Vec3> directions = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}};
  for (std::size_t i = 0; i < 100000; ++i) {
    Random random(6, i, 0);
    directions.push_back(sampleUniformSphere(random.uniform2()));
  }
  for (const LightCase& s : makeLightCases()) {
    SCOPED_TRACE(s.name);
    const Fog fog(s.lights);
    const std::vector<Rgb> emitted = collectEmitted(fog, directions);
    const std::size_t deviating = countMismatches(
        fog, emitted, [&](std::size_t i) { return directions[i]; },
        [&](std::size_t i) { return emitted[i]; });
    EXPECT_LT(deviating, directions.size() / 2000);
    EXPECT_TRUE(isNear(emitted[0], computeExpected(fog.lights, directions[0]))) << "north pole";
    EXPECT_TRUE(isNear(emitted[1], computeExpected(fog.lights, directions[1]))) << "south pole";
  }
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, SimdLights, ::testing::Values(0, 1, 2, 3),
                         [](const auto& info) { return "Set" + std::to_string(info.param); });

/// Probability of each bin in a table, in units of 2^-32.
std::vector<std::uint64_t> toProbabilities(const AliasTables& tables) {
  const auto full = static_cast<std::uint64_t>(tables.thresholdRange());
  std::vector<std::uint64_t> units(tables.size(), 0);
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const auto threshold = static_cast<std::uint64_t>(tables.slots[i].threshold);
    units[i] += threshold;
    units[static_cast<std::size_t>(tables.slots[i].alias)] += full - threshold;
  }
  return units;
}

TEST(AliasTables, SampleBinsWithExactProbabilities) {
  for (const std::size_t bins : {1U, 2U, 255U, 256U, 257U, 5000U}) {
    std::vector<double> sums{0.0};
    for (std::size_t i = 0; i < bins; ++i) {
      Random random(2, i, 0);
      const double weight = bins > 1 && i % 5 == 1 ? 0.0 : std::pow(random.uniform(), 8.0);
      sums.push_back(sums.back() + weight);
    }
    for (double& sum : sums)
      sum /= sums.back();
    AliasTables tables(bins);
    tables.append(sums);
    const std::vector<std::uint64_t> units = toProbabilities(tables);
    for (std::size_t i = 0; i < units.size(); ++i) {
      const double probability = i < bins ? sums[i + 1] - sums[i] : 0.0;
      ASSERT_NEAR(static_cast<double>(units[i]), 0x1p32 * probability, 1.0) << bins << ", " << i;
      ASSERT_TRUE(probability > 0.0 || units[i] == 0U) << "sampled a bin of probability 0";
    }
  }
}

} // namespace
} // namespace fenestra::core::testing::SimdLightsTests
