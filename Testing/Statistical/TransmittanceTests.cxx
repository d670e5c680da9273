// Transmittance and free paths through heterogeneous media against exact optical depths.

#include "Anchors.h"
#include "Significance.h"
#include "StraightIntegral.h"

namespace fenestra::testing {
namespace {

struct Subject {
  const char* name;
  Volume volume;
  TransferFunction transfer;
};

TransferFunction table(const std::vector<std::pair<double, double>>& knots) {
  std::vector<ScalarFunction::Knot> list;
  for (const auto& [scalar, sigma_t] : knots)
    list.push_back({scalar, ScalarFunction::Value(sigma_t)});
  return {ScalarFunction(list), ColorFunction({{0.0, Rgb::Ones()}})};
}

/// Voxels drawn uniformly from [0, 1].
template <typename Voxel = float>
Volume noise(const Size3& size, const Vec3& spacing, double greatest = 1.0) {
  Random random(77, static_cast<std::uint64_t>(size.prod()), 0);
  return makeVolume<Voxel>(centredGrid(size, spacing),
                           [&](const Vec3&) { return greatest * random.uniform(); });
}

/// The scalar is x's index, 0 to 5; extinction is proportional to it.
constexpr double rampSlope = 0.12;
Volume ramp() {
  return makeVolume(centredGrid({6, 4, 5}, {1.3, 0.7, 0.9}), [](const Vec3& p) { return p.x(); });
}

/// A turned grid of unequal spacing.
Volume turned(Volume volume) {
  const Affine turn(Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -0.5).normalized()));
  volume.grid = Grid(volume.grid.size, turn * volume.grid.indexToWorld);
  return volume;
}

/// A linear ramp; one trilinear cell; a spike inside the range, with nothing on both sides; steps,
/// in 8 bit; all kinds of knots, dense, so that little light passes.
std::vector<Subject> subjects() {
  return {{"ramp", ramp(), table({{0.0, 0.0}, {5.0, 5.0 * rampSlope}})},
          {"cell", turned(noise({2, 2, 2}, {2.0, 1.5, 2.5})), table({{0.0, 0.0}, {1.0, 1.5}})},
          {"spike", turned(noise({5, 6, 4}, {0.9, 0.8, 1.1})),
           table({{0.0, 0.0}, {0.4, 0.0}, {0.5, 6.0}, {0.53, 0.0}, {1.0, 0.0}})},
          {"steps", noise<std::uint8_t>({5, 5, 5}, {1.0, 1.0, 1.0}, 255.0),
           table({{60.0, 0.4}, {60.0, 0.05}, {140.0, 0.3}, {140.0, 2.0}, {200.0, 0.0}})},
          {"dense", turned(noise({6, 5, 7}, {0.5, 1.0, 0.7})),
           table({{0.1, 0.2}, {0.3, 3.0}, {0.35, 0.1}, {0.6, 0.8}, {0.6, 2.5}, {0.9, 0.4}})}};
}

Subject subject(int index) {
  return std::move(subjects()[static_cast<std::size_t>(index)]);
}

/// Toward a point inside, from outside or from another point inside.
Ray randomRay(const Volume& volume, Random& random) {
  const auto inside = [&] {
    const Box box = volume.grid.indexBox();
    const Vec3 u(random.uniform(), random.uniform(), random.uniform());
    return Vec3(volume.grid.indexToWorld *
                (box.lower + u.cwiseProduct(box.upper - box.lower)).eval());
  };
  const Vec3 target = inside();
  const Vec3 origin =
      random.uniform() < 0.3 ? inside() : Vec3(20.0 * uniformDirection(random.uniform2()));
  return {origin, (target - origin).normalized()};
}

// ---- the integral itself
// -------------------------------------------------------------------------

TEST(StraightIntegral, IsThatOfALinearRampInClosedForm) {
  const Subject ramp = subject(0);
  const StraightIntegral integral(ramp.volume, ramp.transfer);
  // Of clamp(x, 0, 5), which is what the outer half voxels make of x.
  const auto antiderivative = [](double x) {
    return x < 0.0 ? 0.0 : x < 5.0 ? 0.5 * x * x : 12.5 + 5.0 * (x - 5.0);
  };
  for (std::uint64_t i = 0; i < 10000; ++i) {
    Random random(3, i, 0);
    const Ray ray = randomRay(ramp.volume, random);
    const Interval range = integral.inside(ray);
    const double from = (ramp.volume.grid.worldToIndex * ray.at(range.begin)).x();
    const double to = (ramp.volume.grid.worldToIndex * ray.at(range.end)).x();
    const double expected = rampSlope * (range.end - range.begin) *
                            (antiderivative(to) - antiderivative(from)) / (to - from);
    EXPECT_NEAR(integral.opticalDepth(ray), expected, 1e-9);
  }
}

/// By the midpoint rule on Medium's own extinction.
TEST(StraightIntegral, IsTheLimitOfSmallSteps) {
  for (int index = 0; index < 5; ++index) {
    const Subject s = subject(index);
    const StraightIntegral integral(s.volume, s.transfer);
    std::visit(
        [&](const auto& voxels) {
          const Medium medium(s.volume.grid, voxels, s.transfer);
          for (std::uint64_t i = 0; i < 50; ++i) {
            Random random(4, i, 0);
            const Ray ray = randomRay(s.volume, random);
            const Interval range = integral.inside(ray);
            constexpr int steps = 20000;
            const double step = (range.end - range.begin) / steps;
            double sum = 0.0;
            for (int n = 0; n < steps; ++n)
              sum += step * medium.extinction(s.volume.grid.worldToIndex *
                                              ray.at(range.begin + (n + 0.5) * step));
            // Each of a few dozen steps of the table costs up to its height times half a step.
            EXPECT_NEAR(integral.opticalDepth(ray), sum, 2e-3) << s.name;
          }
        },
        s.volume.voxels);
  }
}

// ---- the tracker
// ---------------------------------------------------------------------------------

/// Sum of differences from what is expected, and of their variance, by how much is expected.
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

  /// Within 4 standard errors wherever the expectation is known to 2 percent.
  void expectNone(const std::string& what) const {
    int sharp = 0;
    for (const Bin& bin : m_bins) {
      if (!(std::sqrt(bin.squares) < 0.02 * bin.expected))
        continue;
      ++sharp;
      EXPECT_NEAR(bin.sum / std::sqrt(bin.squares), 0.0, 4.0)
          << what << ": " << bin.count << " rays, mean transmittance " << bin.expected / bin.count
          << ", relative error " << std::sqrt(bin.squares) / bin.expected;
    }
    EXPECT_GT(sharp, 0) << what;
  }

private:
  struct Bin {
    double count = 0.0, expected = 0.0, sum = 0.0, squares = 0.0;
  };
  Bin m_bins[3];
};

class Tracking : public ::testing::TestWithParam<int> {
protected:
  /// Runs test(tracker) on the subject.
  template <typename Test>
  void withTracker(Test&& test) const {
    const MajorantGrid majorants(m_subject.volume.grid, CellRanges(m_subject.volume, 0),
                                 m_subject.transfer, ClipNone{});
    std::visit(
        [&](const auto& voxels) {
          using Voxel = typename std::decay_t<decltype(voxels)>::value_type;
          const Medium<Voxel> medium(m_subject.volume.grid, voxels, m_subject.transfer);
          const Clip clip;
          test(Tracker<Voxel>(m_subject.volume.grid, medium, majorants, clip));
        },
        m_subject.volume.voxels);
  }

  Subject m_subject = subject(GetParam());
  StraightIntegral m_integral{m_subject.volume, m_subject.transfer};
};

TEST_P(Tracking, PassesWhatTheExactTransmittanceSays) {
  withTracker([&](const auto& tracker) {
    Counters counters;
    Differences passed, survived;
    for (std::uint64_t i = 0; i < budget(100000UL); ++i) {
      Random random(seeded(6), i, 0);
      const Ray ray = randomRay(m_subject.volume, random);
      // As far as a near light, or everything.
      const Interval inside = m_integral.inside(ray);
      const Interval range{0.0, i % 2 == 0 ? infinity
                                           : inside.begin +
                                                 random.uniform() * (inside.end - inside.begin)};
      const double expected = std::exp(-m_integral.opticalDepth(ray, range));
      passed.add(tracker.transmittance(ray, range, random, counters), expected);
      const bool free = tracker.sampleCollision(ray, range, random, counters) == infinity;
      survived.add(free ? 1.0 : 0.0, expected);
    }
    passed.expectNone("ratio tracking");
    survived.expectNone("survival");
  });
}

/// The optical depth to the collision, as a share of the rays that collide before: uniform. Where a
/// ray passes, any share above that of all its collisions, drawn here.
TEST_P(Tracking, DrawsCollisionsByTheExactDistribution) {
  withTracker([&](const auto& tracker) {
    Counters counters;
    std::vector<double> shares;
    for (std::uint64_t i = 0; i < budget(100000UL); ++i) {
      Random random(seeded(7), i, 0);
      const Ray ray = randomRay(m_subject.volume, random);
      const double distance = tracker.sampleCollision(ray, {}, random, counters);
      const double passes = std::exp(-m_integral.opticalDepth(ray, {0.0, distance}));
      shares.push_back(1.0 - (distance < infinity ? passes : random.uniform() * passes));
    }
    EXPECT_GT(uniformityProbability(shares), 1e-4);
  });
}

INSTANTIATE_TEST_SUITE_P(Media, Tracking, ::testing::Range(0, 5),
                         [](const auto& info) { return std::string(subject(info.param).name); });

} // namespace
} // namespace fenestra::testing
