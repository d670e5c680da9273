// Transmittance and free paths in heterogeneous media against exact optical depths.

#include "LineIntegral.h"
#include "RgbEstimate.h"
#include "Significance.h"
#include "base/InstructionSets.h"

#include "clip/surface/ClippingSurface.h"
#include "integrator/simd/Tracker.h"

namespace fenestra::core::testing::TransmittanceTests {
namespace {

struct Subject {
  const char* name;
  Volume volume;
  TransferFunction transfer;
};

TransferFunction makeTransfer(const std::vector<std::pair<double, double>>& knots) {
  std::vector<ScalarFunction::Knot> list;
  for (const auto& [scalar, sigma_t] : knots)
    list.push_back({scalar, ScalarFunction::Value(sigma_t)});
  return {ScalarFunction(list), ColorFunction({{0.0, Rgb::Ones()}})};
}

/// Voxels sampled uniformly from [0, greatest].
template <typename Voxel = float>
Volume makeNoise(const Size3& size, const Vec3& spacing, double greatest = 1.0) {
  Random random(77, static_cast<std::uint64_t>(size.prod()), 0);
  return makeVolume<Voxel>(makeCenteredGrid(size, spacing),
                           [&](const Vec3&) { return greatest * random.uniform(); });
}

/// Scalar equal to the index along x, 0 to 5; extinction proportional to the scalar.
constexpr double rampSlope = 0.12;
Volume makeRamp() {
  return makeVolume(makeCenteredGrid({6, 4, 5}, {1.3, 0.7, 0.9}),
                    [](const Vec3& p) { return p.x(); });
}

/// Rotated grid of unequal spacing.
Volume rotateGrid(Volume volume) {
  const Affine rotation(makeRotation(0.7, Vec3(1.0, 2.0, -0.5).normalized()));
  volume.grid = Grid(volume.grid.size, rotation * volume.grid.indexToWorld);
  return volume;
}

/// A linear ramp; one trilinear cell; a spike inside the range, with 0 on both sides; steps, in 8
/// bits; all kinds of knots, so dense that little light passes.
std::vector<Subject> makeSubjects() {
  return {
      {"ramp", makeRamp(), makeTransfer({{0.0, 0.0}, {5.0, 5.0 * rampSlope}})},
      {"cell", rotateGrid(makeNoise({2, 2, 2}, {2.0, 1.5, 2.5})),
       makeTransfer({{0.0, 0.0}, {1.0, 1.5}})},
      {"spike", rotateGrid(makeNoise({5, 6, 4}, {0.9, 0.8, 1.1})),
       makeTransfer({{0.0, 0.0}, {0.4, 0.0}, {0.5, 6.0}, {0.53, 0.0}, {1.0, 0.0}})},
      {"steps", makeNoise<std::uint8_t>({5, 5, 5}, {1.0, 1.0, 1.0}, 255.0),
       makeTransfer({{60.0, 0.4}, {60.0, 0.05}, {140.0, 0.3}, {140.0, 2.0}, {200.0, 0.0}})},
      {"dense", rotateGrid(makeNoise({6, 5, 7}, {0.5, 1.0, 0.7})),
       makeTransfer({{0.1, 0.2}, {0.3, 3.0}, {0.35, 0.1}, {0.6, 0.8}, {0.6, 2.5}, {0.9, 0.4}})}};
}

Subject makeSubject(int index) {
  return std::move(makeSubjects()[static_cast<std::size_t>(index)]);
}

/// Ray toward a point inside, from a point outside or inside.
Ray randomRay(const Volume& volume, Random& random) {
  const auto inside = [&] {
    const Box box = volume.grid.indexBox();
    const Vec3 u(random.uniform(), random.uniform(), random.uniform());
    return Vec3(volume.grid.indexToWorld * (box.lower + u.cwiseProduct(box.upper - box.lower)));
  };
  const Vec3 target = inside();
  const Vec3 origin =
      random.uniform() < 0.3 ? inside() : Vec3(20.0 * sampleUniformSphere(random.uniform2()));
  return {origin, (target - origin).normalized()};
}

// ---- the line integral
// -------------------------------------------------------------------------

TEST(LineIntegral, LinearRampEqualsClosedForm) {
  const Subject ramp = makeSubject(0);
  const LineIntegral integral(ramp.volume, ramp.transfer);
  // Antiderivative of clamp(x, 0, 5): x is clamped in the outer half voxels.
  const auto antiderivative = [](double x) {
    return x < 0.0 ? 0.0 : x < 5.0 ? 0.5 * x * x : 12.5 + 5.0 * (x - 5.0);
  };
  for (std::uint64_t i = 0; i < 10000; ++i) {
    Random random(3, i, 0);
    const Ray ray = randomRay(ramp.volume, random);
    const Interval range = integral.boxInterval(ray);
    const double from = (ramp.volume.grid.worldToIndex * ray.at(range.begin)).x();
    const double to = (ramp.volume.grid.worldToIndex * ray.at(range.end)).x();
    const double expected = rampSlope * (range.end - range.begin) *
                            (antiderivative(to) - antiderivative(from)) / (to - from);
    EXPECT_NEAR(integral.opticalDepth(ray), expected, 1e-9);
  }
}

/// Reference: midpoint rule with Medium's own extinction.
TEST(LineIntegral, EqualsMidpointRuleWithSmallSteps) {
  for (int index = 0; index < 5; ++index) {
    const Subject s = makeSubject(index);
    const LineIntegral integral(s.volume, s.transfer);
    std::visit(
        [&](const auto& voxels) {
          const Medium medium(s.volume.grid, voxels, s.transfer);
          for (std::uint64_t i = 0; i < 50; ++i) {
            Random random(4, i, 0);
            const Ray ray = randomRay(s.volume, random);
            const Interval range = integral.boxInterval(ray);
            constexpr int steps = 20000;
            const double step = (range.end - range.begin) / steps;
            double sum = 0.0;
            for (int n = 0; n < steps; ++n)
              sum += step * medium.extinction(s.volume.grid.worldToIndex *
                                              ray.at(range.begin + (n + 0.5) * step));
            // The error per discontinuity of the table is at most its height times half a step.
            EXPECT_NEAR(integral.opticalDepth(ray), sum, 2e-3) << s.name;
          }
        },
        s.volume.voxels);
  }
}

// ---- the tracker
// ---------------------------------------------------------------------------------

/// Sums of differences from expected values and of their squares, binned by expected value.
class Differences {
public:
  void add(double estimate, double expected) {
    Bin& bin = m_bins[expected < 0.03 ? 0 : expected < 0.2 ? 1 : 2];
    const double difference = estimate - expected;
    bin.count += 1.0;
    bin.expected += expected;
    bin.sum += difference;
    bin.squares += difference * difference;
  }

  /// Expects sums within 4 standard errors in every bin whose relative standard error is below 2
  /// percent.
  void expectUnbiased(const std::string& what) const {
    int sharpBins = 0;
    for (const Bin& bin : m_bins) {
      if (!(std::sqrt(bin.squares) < 0.02 * bin.expected))
        continue;
      ++sharpBins;
      EXPECT_NEAR(bin.sum / std::sqrt(bin.squares), 0.0, 4.0)
          << what << ": " << bin.count << " rays, mean transmittance " << bin.expected / bin.count
          << ", relative error " << std::sqrt(bin.squares) / bin.expected;
    }
    EXPECT_GT(sharpBins, 0) << what;
  }

private:
  struct Bin {
    double count = 0.0, expected = 0.0, sum = 0.0, squares = 0.0;
  };
  Bin m_bins[3];
};

/// Ray with its own random numbers.
struct TestRay {
  Ray ray;
  Interval range;
  Random random;
};

/// Uniform interface of both trackers; results are in the order of the rays.
class TrackerAdapter {
public:
  virtual ~TrackerAdapter() = default;
  virtual std::vector<double> collisions(const std::vector<TestRay>& testRays) const = 0;
  virtual std::vector<double> transmittances(const std::vector<TestRay>& testRays) const = 0;
};

template <typename Voxel>
class ScalarAdapter : public TrackerAdapter {
public:
  ScalarAdapter(const Subject& s, const LargeArray<Voxel>& voxels, const MajorantGrid& majorants,
                const Clip& clip)
      : m_medium(s.volume.grid, voxels, s.transfer),
        m_clip(clip),
        m_tracker(s.volume.grid, m_medium, majorants, m_clip) {}

  std::vector<double> collisions(const std::vector<TestRay>& testRays) const override {
    return traceEach(testRays, [this](TestRay& t, Counters& counters) {
      return m_tracker.sampleCollision(t.ray, t.range, t.random.uniform2(), t.random, counters);
    });
  }
  std::vector<double> transmittances(const std::vector<TestRay>& testRays) const override {
    return traceEach(testRays, [this](TestRay& t, Counters& counters) {
      return m_tracker.transmittance(t.ray, t.range, t.random, counters);
    });
  }

private:
  template <typename Method>
  std::vector<double> traceEach(const std::vector<TestRay>& testRays, Method&& method) const {
    std::vector<double> results;
    Counters counters;
    for (TestRay t : testRays)
      results.push_back(method(t, counters));
    return results;
  }

  Medium<Voxel> m_medium;
  Clip m_clip;
  Tracker<Voxel> m_tracker;
};

class SimdAdapter : public TrackerAdapter {
public:
  SimdAdapter(const Subject& s, const MajorantGrid& majorants, const Clip& clip)
      : m_domain(s.volume.grid),
        m_clip(clip),
        m_tracker(s.volume, m_domain, s.transfer, majorants, m_clip) {}

  std::vector<double> collisions(const std::vector<TestRay>& testRays) const override {
    return traceBatches(testRays, &SimdTracker::sampleCollisions);
  }
  std::vector<double> transmittances(const std::vector<TestRay>& testRays) const override {
    return traceBatches(testRays, &SimdTracker::estimateTransmittances);
  }

private:
  std::vector<double> traceBatches(const std::vector<TestRay>& testRays,
                                   void (SimdTracker::*method)(RayBatch&, Counters&) const) const {
    std::vector<double> results, begins;
    Counters counters;
    RayBatch rays;
    const auto flush = [&] {
      (m_tracker.*method)(rays, counters);
      for (std::size_t i = 0; i < rays.size; ++i)
        results.push_back(static_cast<double>(rays.result[i]) +
                          (method == &SimdTracker::sampleCollisions ? begins[i] : 0.0));
      rays.size = 0;
      begins.clear();
    };
    for (TestRay t : testRays) {
      rays.depthBits[rays.size] = static_cast<std::uint32_t>(t.random.bits() >> 32);
      rays.acceptance[rays.size] = static_cast<float>(t.random.uniform());
      begins.push_back(setDomainRay(rays, rays.size++, m_domain, t.ray, t.range));
      if (rays.size == RayBatch::capacity)
        flush();
    }
    flush();
    return results;
  }

  Domain m_domain;
  Clip m_clip;
  SimdTracker m_tracker;
};

/// "scalar", or the SIMD tracker of an instruction set; null if the machine lacks that set.
std::unique_ptr<TrackerAdapter> makeAdapter(const Subject& subject, const MajorantGrid& majorants,
                                            const Clip& clip, const std::string& name) {
  if (name == "scalar")
    return std::visit(
        [&](const auto& voxels) -> std::unique_ptr<TrackerAdapter> {
          using Voxel = typename std::decay_t<decltype(voxels)>::value_type;
          return std::make_unique<ScalarAdapter<Voxel>>(subject, voxels, majorants, clip);
        },
        subject.volume.voxels);
  const std::vector<std::string> known = instructionSets();
  if (std::find(known.begin(), known.end(), name) == known.end())
    return nullptr;
  EXPECT_TRUE(SimdTracker::isSupported(subject.volume, subject.transfer));
  useInstructionSet(name);
  EXPECT_EQ(instructionSet(), name);
  return std::make_unique<SimdAdapter>(subject, majorants, clip);
}

/// A medium, and the tracker under test.
class Tracking : public ::testing::TestWithParam<std::tuple<int, std::string>> {
protected:
  void SetUp() override {
    m_majorants.emplace(m_subject.volume.grid, MinMaxGrid(m_subject.volume, 0), m_subject.transfer,
                        m_clip);
    m_adapter = makeAdapter(m_subject, *m_majorants, m_clip, std::get<1>(GetParam()));
    if (!m_adapter)
      GTEST_SKIP() << "this machine does not support " << std::get<1>(GetParam());
  }
  void TearDown() override { useInstructionSet(instructionSets().front()); }

  Subject m_subject = makeSubject(std::get<0>(GetParam()));
  LineIntegral m_integral{m_subject.volume, m_subject.transfer};
  Clip m_clip = ClipNone{};
  std::optional<MajorantGrid> m_majorants;
  std::unique_ptr<TrackerAdapter> m_adapter;
};

TEST_P(Tracking, MeanTransmittanceEqualsExpOfIntegral) {
  std::vector<TestRay> testRays;
  for (std::uint64_t i = 0; i < scaleSamples(100000UL); ++i) {
    Random random(shiftSeed(6), i, 0);
    const Ray ray = randomRay(m_subject.volume, random);
    // Range up to a nearby light, or infinite.
    const Interval inside = m_integral.boxInterval(ray);
    const double end =
        i % 2 == 0 ? infinity : inside.begin + random.uniform() * (inside.end - inside.begin);
    testRays.push_back({ray, {0.0, end}, random});
  }
  const std::vector<double> ratios = m_adapter->transmittances(testRays);
  const std::vector<double> distances = m_adapter->collisions(testRays);
  Differences passed, survived;
  for (std::size_t i = 0; i < testRays.size(); ++i) {
    const double expected = std::exp(-m_integral.opticalDepth(testRays[i].ray, testRays[i].range));
    passed.add(ratios[i], expected);
    survived.add(distances[i] == infinity ? 1.0 : 0.0, expected);
  }
  passed.expectUnbiased("ratio tracking");
  survived.expectUnbiased("survival");
}

/// The cumulative probability at the collision must be uniform. Rays that pass get a random value
/// above the probability of a collision.
TEST_P(Tracking, CollisionsFollowExactDistribution) {
  std::vector<TestRay> testRays;
  for (std::uint64_t i = 0; i < scaleSamples(100000UL); ++i) {
    Random random(shiftSeed(7), i, 0);
    const Ray ray = randomRay(m_subject.volume, random);
    testRays.push_back({ray, {}, random});
  }
  const std::vector<double> distances = m_adapter->collisions(testRays);
  std::vector<double> quantiles;
  for (std::size_t i = 0; i < testRays.size(); ++i) {
    Random random(shiftSeed(8), i, 0);
    const double passes = std::exp(-m_integral.opticalDepth(testRays[i].ray, {0.0, distances[i]}));
    quantiles.push_back(1.0 - (distances[i] < infinity ? passes : random.uniform() * passes));
  }
  EXPECT_GT(uniformityProbability(quantiles), 1e-4);
}

TEST_P(Tracking, ResultDoesNotDependOnOtherRaysOfBatch) {
  std::vector<TestRay> testRays;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    Random random(9, i, 0);
    const Ray ray = randomRay(m_subject.volume, random);
    testRays.push_back({ray, {}, random});
  }
  const std::vector<double> distances = m_adapter->collisions(testRays);
  const std::vector<double> ratios = m_adapter->transmittances(testRays);
  for (std::size_t i = 0; i < testRays.size(); i += 7) {
    EXPECT_EQ(m_adapter->collisions({testRays[i]}).at(0), distances[i]);
    EXPECT_EQ(m_adapter->transmittances({testRays[i]}).at(0), ratios[i]);
  }
}

/// Medium in front of an exact clipping surface, with each tracker.
class SilhouetteTracking : public ::testing::TestWithParam<std::string> {
protected:
  void TearDown() override { useInstructionSet(instructionSets().front()); }
};

/// Short segments of camera rays in dense fog beside the silhouette of a ball, where the exact
/// surface differs from interpolated samples.
TEST_P(SilhouetteTracking, TransmittanceBesideFocusFollowsExactSurface) {
  const Grid grid = makeCenteredGrid({40, 40, 40}, Vec3::Ones());
  const Subject fog{"fog", makeVolume(grid, [](const Vec3&) { return 1.0; }),
                    makeTransfer({{0.0, 0.0}, {1.0, 8.0}})};
  Mask ball{grid, {}, 0, {"ball"}};
  for (std::int64_t i = 0; i < grid.voxelCount(); ++i)
    ball.voxels.push_back(
        (grid.indexToWorld * Vec3(static_cast<double>(i % 40), static_cast<double>(i / 40 % 40),
                                  static_cast<double>(i / 1600)))
            .norm() < 10.0);
  for (const Projection projection : {Projection::orthographic, Projection::perspective}) {
    CameraPose pose{projection, {7.0, -150.0, 20.0}, Vec3::Zero(), Vec3::UnitZ(), 15.0, 12.0};
    const Camera camera(pose, 24, 24);
    SurfaceOptions options;
    options.boundary = Boundary::exact;
    options.offset = 0.3;
    const Clip clip = buildClippingSurface(camera, Domain(grid), ball, options).clip;
    const auto& depth = std::get<ClipDepth>(clip);
    const MajorantGrid majorants(grid, MinMaxGrid(fog.volume, 0), fog.transfer, clip);
    const auto adapter = makeAdapter(fog, majorants, clip, GetParam());
    if (!adapter)
      GTEST_SKIP() << "this machine does not support " << GetParam();
    std::vector<TestRay> testRays;
    std::vector<double> expected;
    for (std::uint64_t i = 0; testRays.size() < scaleSamples(20000UL); ++i) {
      Random random(shiftSeed(10), i, 0);
      const double angle = 2.0 * pi * random.uniform(), radius = 8.5 + 3.0 * random.uniform();
      const Vec2 at(radius * std::cos(angle), radius * std::sin(angle));
      const double surface = depth.surfaceDepth(at), linear = depth.buffer->depth(at);
      if (std::abs(surface - linear) < 0.2)
        continue;
      const Ray ray = camera.makePlaneRay(at);
      const double perLength = camera.depthPerLength(ray);
      const Interval segment{std::min(surface, linear) / perLength,
                             std::max(surface, linear) / perLength};
      testRays.push_back({ray, segment, random});
      expected.push_back(surface > linear ? 1.0 : std::exp(-8.0 * (segment.end - segment.begin)));
    }
    const std::vector<double> passed = adapter->transmittances(testRays);
    double difference = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < passed.size(); ++i) {
      difference += passed[i] - expected[i];
      squares += std::pow(passed[i] - expected[i], 2);
    }
    // In float, the silhouette is slightly displaced: a few of a thousand rays are on its other
    // side.
    EXPECT_NEAR(difference, 0.0,
                4.0 * std::sqrt(squares) + 2e-3 * static_cast<double>(passed.size()));
  }
}

INSTANTIATE_TEST_SUITE_P(Trackers, SilhouetteTracking,
                         ::testing::Values("scalar", "AVX3", "AVX2", "SSE4", "SCALAR"));

INSTANTIATE_TEST_SUITE_P(Media, Tracking,
                         ::testing::Combine(::testing::Range(0, 5),
                                            ::testing::Values("scalar", "AVX3", "AVX2", "SSE4",
                                                              "SCALAR")),
                         [](const auto& info) {
                           return std::string(makeSubject(std::get<0>(info.param)).name) + "_" +
                                  std::get<1>(info.param);
                         });

} // namespace
} // namespace fenestra::core::testing::TransmittanceTests
