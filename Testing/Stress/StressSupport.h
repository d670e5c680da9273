#pragma once
// Support for the stress tests: estimates along one ray, chords, comparison of two images, and
// random generators with selected numbers.

#include "RunSettings.h"
#include "Support.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace fenestra::core::testing {

inline constexpr double largestUniform = 1.0 - 0x1p-53;

/// Inverse of mixBits: every step of the mixer is invertible.
constexpr std::uint64_t unmixBits(std::uint64_t y) {
  const auto unshift = [](std::uint64_t x, int by) {
    std::uint64_t result = x;
    for (int known = by; known < 64; known += by)
      result = x ^ (result >> by);
    return result;
  };
  const auto inverse = [](std::uint64_t odd) { // Newton: each step doubles the correct bits
    std::uint64_t x = odd;
    for (int step = 0; step < 5; ++step)
      x *= 2 - odd * x;
    return x;
  };
  y = unshift(y, 31) * inverse(0x94d049bb133111ebULL);
  y = unshift(y, 27) * inverse(0xbf58476d1ce4e5b9ULL);
  return unshift(y, 30);
}

/// Random whose `draw`-th call of bits(), counted from 1, returns `bits`; other calls stay random.
/// Passes 0 and the largest u to code that accepts only a Random.
inline Random makeRandomWithDraw(int draw, std::uint64_t bits) {
  return Random(unmixBits(bits) - static_cast<std::uint64_t>(draw) * Random::gamma);
}

/// Numbers of a path, the `draw`-th of which is `bits`, counted in the order of PrimarySamples from
/// `depth`.
inline PrimarySamples makeSamplesWithDraw(int draw, std::uint64_t bits) {
  constexpr int given = 4; // stored by PrimarySamples; `rest` generates all others
  Random random = makeRandomWithDraw(draw, bits);
  const std::uint64_t depth = random.bits();
  const std::uint64_t acceptance = random.bits();
  const std::uint64_t direction = random.bits();
  const std::uint64_t choices = random.bits();
  const std::uint64_t rest =
      unmixBits(bits) - static_cast<std::uint64_t>(draw - given) * Random::gamma;
  return {0, depth, acceptance, direction, choices, rest};
}

/// Length of a ray inside a grid's box, t >= 0, mm; in long double, without the renderer's code.
inline double chord(const Grid& grid, const Ray& ray) {
  using Vector = Eigen::Matrix<long double, 3, 1>;
  const auto precise = [](const Vec3& v) { return Vector(v.x(), v.y(), v.z()); };
  Eigen::Matrix<long double, 3, 3> linear;
  for (int axis = 0; axis < 3; ++axis)
    linear.col(axis) = precise(grid.indexToWorld.linear().col(axis));
  const Eigen::Matrix<long double, 3, 3> inverse = linear.inverse();
  const Vector origin = inverse * precise(ray.origin - grid.indexToWorld.translation());
  const Vector direction = inverse * precise(ray.direction);
  long double begin = 0.0L;
  long double end = std::numeric_limits<long double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const long double lower = -0.5L - origin[axis];
    const long double upper = static_cast<long double>(grid.size[axis]) - 0.5L - origin[axis];
    if (direction[axis] == 0.0L) {
      if (lower > 0.0L || upper < 0.0L)
        return 0.0;
      continue;
    }
    const long double a = lower / direction[axis];
    const long double b = upper / direction[axis];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return static_cast<double>(std::max(0.0L, end - begin));
}

/// Medium, majorants and tracker of a classified volume; the volume must outlive the probe.
template <typename Voxel = float>
class RayProbe {
public:
  RayProbe(const Volume& volume, TransferFunction transfer)
      : m_transfer(std::move(transfer)),
        m_majorants(volume.grid, MinMaxGrid(volume, MajorantGrid::requiredPadding(m_transfer)),
                    m_transfer, m_clip),
        m_medium(volume.grid, std::get<LargeArray<Voxel>>(volume.voxels), m_transfer),
        m_tracker(volume.grid, m_medium, m_majorants, m_clip),
        m_domain(volume.grid) {}
  RayProbe(const RayProbe&) = delete;
  RayProbe& operator=(const RayProbe&) = delete;

  const Tracker<Voxel>& tracker() const { return m_tracker; }
  const MajorantGrid& majorants() const { return m_majorants; }
  const Medium<Voxel>& medium() const { return m_medium; }

  /// Compares free paths and ratio tracking with a known transmittance T. Both estimates are in
  /// [0, 1], so variance <= T (1 - T). Returns the counters of `n` rays of each.
  Counters expectTransmittance(const Ray& ray, const Interval& range, double expected,
                               int n) const {
    double survived = 0.0;
    double ratio = 0.0;
    Counters counters;
    for (int i = 0; i < n; ++i) {
      Random random(41, static_cast<std::uint64_t>(i), 0);
      survived +=
          m_tracker.sampleCollision(ray, range, random.uniform2(), random, counters) == infinity
              ? 1.0 / n
              : 0.0;
      ratio += m_tracker.transmittance(ray, range, random, counters) / n;
    }
    const double error = 4.0 * std::sqrt(expected * (1.0 - expected) / n) + 1e-12 * expected + 1e-9;
    EXPECT_NEAR(survived, expected, error) << ray.origin << " | " << ray.direction;
    EXPECT_NEAR(ratio, expected, error) << ray.origin << " | " << ray.direction;
    return counters;
  }

  /// Length of the ray that the walk over majorant cells covers, mm; expects no gaps or overlaps.
  double measureWalk(const Ray& ray) const {
    const Interval interval =
        m_domain.clip(transformRay(m_domain.grid().worldToIndex, ray), Interval{});
    GridWalk walk(transformRay(m_majorants.worldToCell(), ray), interval, m_majorants.cellCount());
    if (walk.isDone())
      return 0.0;
    const double begin = walk.interval().begin;
    double reached = begin;
    for (; !walk.isDone(); walk.next()) {
      EXPECT_EQ(walk.interval().begin, reached);
      EXPECT_LE(walk.interval().begin, walk.interval().end);
      reached = walk.interval().end;
    }
    return reached - begin;
  }

private:
  TransferFunction m_transfer;
  Clip m_clip;
  MajorantGrid m_majorants;
  Medium<Voxel> m_medium;
  Tracker<Voxel> m_tracker;
  Domain m_domain;
};

/// Calls `work` with the path integrator of a scene, built as in a render.
template <typename Work>
auto withIntegrator(const TestScene& scene, Work&& work) {
  const Camera camera(scene.pose, scene.width, scene.height);
  const LightSet lights(scene.lights, scene.volume.grid, camera);
  const RayProbe<> probe(scene.volume, scene.transfer);
  const PathSettings settings;
  const std::atomic<bool> stop = false;
  return work(PathIntegrator<float>(scene.volume.grid, probe.medium(), probe.tracker(), lights,
                                    camera, scene.clip, settings, stop));
}

/// Expects two images of independent seeds to differ only by chance: their means by at most 4
/// standard errors, the sum of squared z over the pixels by at most 4 of its own (Wilson and
/// Hilferty 1931). Pixels without variance in both must be equal.
inline void expectSameImage(const Film& a, const Film& b) {
  ASSERT_EQ(a.pixelCount(), b.pixelCount());
  double difference = 0.0, variance = 0.0, chi2 = 0.0;
  int pixels = 0;
  for (std::size_t i = 0; i < a.pixelCount(); ++i) {
    const double d = a.pixels()[i].mean[0] - b.pixels()[i].mean[0];
    const double v = std::pow(a.pixels()[i].standardError()[0], 2.0) +
                     std::pow(b.pixels()[i].standardError()[0], 2.0);
    ASSERT_TRUE(std::isfinite(d)) << "pixel " << i;
    if (!(v > 0.0)) {
      ASSERT_EQ(d, 0.0) << "pixel " << i;
      continue;
    }
    difference += d;
    variance += v;
    chi2 += d * d / v;
    ++pixels;
  }
  ASSERT_GT(pixels, 0) << "no pixel varies: the images test nothing";
  const double spread = 2.0 / (9.0 * pixels);
  EXPECT_LT((std::cbrt(chi2 / pixels) - (1.0 - spread)) / std::sqrt(spread), 4.0)
      << "mean squared z " << chi2 / pixels << " over " << pixels << " pixels";
  EXPECT_LT(std::abs(difference), 4.0 * std::sqrt(variance));
}

inline void expectEqualBits(const Film& a, const Film& b) {
  ASSERT_EQ(a.pixelCount(), b.pixelCount());
  for (std::size_t i = 0; i < a.pixelCount(); ++i) {
    ASSERT_TRUE(a.pixels()[i].mean == b.pixels()[i].mean) << "pixel " << i;
    ASSERT_TRUE(a.pixels()[i].m2 == b.pixels()[i].m2) << "pixel " << i;
  }
}

/// Renders with `samples` per pixel; the environment is visible behind the volume.
inline RenderResult renderScene(const TestScene& scene, int samples, std::uint64_t seed = 1) {
  RenderSettings settings;
  settings.samples = static_cast<std::uint64_t>(samples);
  settings.seed = seed;
  settings.path.background.kind = Background::Kind::environment;
  return scene.render(settings);
}

/// Furnace test: expects radiance 1 for albedo 1 in an environment of 1.
inline void expectRadianceOne(const RenderResult& result) {
  const Estimate estimate = estimateMean(result.film);
  EXPECT_NEAR(estimate.mean, 1.0, 4.0 * estimate.error + 1e-7);
  EXPECT_LT(estimate.error, 0.02);
}

} // namespace fenestra::core::testing
