#include "model/filtering/NonLocalMeans.h"

#include "EachInstructionSet.h"
#include "NoisyVolumes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace fenestra::core::testing::NonLocalMeansTests {
namespace {

/// The definition in NonLocalMeans.h, voxel by voxel.
template <typename Voxel>
class Definition {
public:
  Definition(const Volume& volume, const NonLocalMeans& filter)
      : m_volume(volume), m_filter(filter) {}

  double mean(const Size3& x) const {
    double sum = 0.0, weights = 0.0, greatest = 1e-3;
    for (const Size3& step : steps()) {
      const double weight = weigh(x, step);
      sum += weight * value(x + step);
      weights += weight;
      greatest = std::max(greatest, weight);
    }
    return (sum + greatest * value(x)) / (weights + greatest);
  }

private:
  std::vector<Size3> steps() const {
    const Mat3& axes = m_volume.grid.indexToWorld.linear();
    const double ball = 47.0 * std::abs(axes.determinant()); // mm^3
    std::vector<Size3> steps;
    for (int k = 0; k < 7 * 7 * 7; ++k) {
      const Size3 step(k % 7 - 3, k / 7 % 7 - 3, k / 49 - 3);
      const double r = (axes * Vec3(step.cast<double>())).norm();
      const bool isNeighbor = step.cwiseAbs().sum() == 1;
      const bool isInside = (step.cwiseAbs().array() < m_volume.grid.size.array()).all();
      if (!step.isZero() && isInside && (isNeighbor || 4.0 / 3.0 * pi * r * r * r <= ball))
        steps.push_back(step);
    }
    return steps;
  }

  double value(const Size3& at) const {
    const Size3 last = m_volume.grid.size - Size3::Ones();
    const Size3 inside = at.cwiseMax(Size3::Zero()).cwiseMin(last);
    return static_cast<double>(voxelsOf<Voxel>(m_volume)[linearIndex(inside, m_volume.grid.size)]);
  }
  double compared(const Size3& at) const {
    return m_filter.isLogarithmic ? std::log1p(value(at) - m_volume.minimum) : value(at);
  }

  double weigh(const Size3& x, const Size3& step) const {
    double squares = 0.0;
    for (int k = 0; k < 27; ++k) {
      const Size3 patch(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      squares += std::pow(compared(x + patch) - compared(x + step + patch), 2);
    }
    const double s = m_filter.noise, h = m_filter.strength;
    const double t = std::max(0.0, squares / 27.0 - 2.0 * s * s) / (h * h);
    return std::pow(std::max(0.0, 1.0 - t / 16.0), 16);
  }

  const Volume& m_volume;
  NonLocalMeans m_filter;
};

/// Compares voxels at the faces of the volume and of the working tiles, and some others.
template <typename Voxel>
void expectDefinition(const Volume& volume, const NonLocalMeans& filter, double tolerance) {
  const Volume smooth = applyNonLocalMeans(volume, filter);
  ASSERT_EQ(smooth.voxels.index(), volume.voxels.index());
  const Definition<Voxel> definition(volume, filter);
  const Size3& size = volume.grid.size;
  for (std::int64_t z = 0; z < size.z(); z += z == 7 ? 1 : 2)
    for (std::int64_t y = 0; y < size.y(); y += y == 31 ? 1 : 5)
      for (std::int64_t x = 0; x<size.x(); x += x> 120 ? 1 : 7) {
        const auto here =
            static_cast<double>(voxelsOf<Voxel>(smooth)[linearIndex({x, y, z}, size)]);
        ASSERT_NEAR(here, definition.mean({x, y, z}), tolerance) << x << ' ' << y << ' ' << z;
      }
}

/// Two tissues with noise of 30.
double noisyTissues(const Size3& voxel) {
  return (voxel.x() + voxel.y() > 80 ? 60.0 : -100.0) + 30.0 * normalNoise(1, voxel);
}

class NonLocalMeansOnEach : public InstructionSetTest {};

TEST_P(NonLocalMeansOnEach, EqualsItsDefinition) {
  expectDefinition<std::int16_t>(
      makeVoxels<std::int16_t>(makeScaledGrid({133, 34, 9}, {0.9, 0.9, 2.5}), noisyTissues),
      {30.0, 28.0}, 0.501);
  expectDefinition<float>(
      makeVoxels<float>(makeScaledGrid({19, 7, 11}, {0.5, 0.5, 6.0}), noisyTissues), {25.0, 30.0},
      1e-3);
  expectDefinition<std::uint8_t>(
      makeVoxels<std::uint8_t>(makeScaledGrid({21, 14, 1}, {1.0, 0.5, 4.0}),
                               [](const Size3& v) { return 100.0 + 9.0 * normalNoise(2, v); }),
      {9.0, 9.0}, 0.501);
  expectDefinition<std::uint16_t>(
      makeVoxels<std::uint16_t>(
          makeScaledGrid({17, 9, 5}, {1.0, 1.0, 1.0}),
          [](const Size3& v) { return 400.0 * std::exp(0.3 * normalNoise(3, v)); }),
      {0.3, 0.4, true}, 0.501);
}

INSTANTIATE_TEST_SUITE_P(Sets, NonLocalMeansOnEach, allInstructionSets);

TEST(NonLocalMeans, BitsDependOnNeitherThreadsNorInstructionSet) {
  const Volume volume =
      makeVoxels<float>(makeScaledGrid({140, 40, 10}, {0.9, 0.9, 2.5}), noisyTissues);
  const NonLocalMeans filter{30.0, 28.0};
  const Volume expected = applyNonLocalMeans(volume, filter);
  for (const std::string& set : instructionSets()) {
    useInstructionSet(set);
    const tbb::global_control single(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(applyNonLocalMeans(volume, filter).voxels, expected.voxels) << set;
  }
  useInstructionSet(instructionSets().front());
}

double deviation(const Volume& volume, double expected) {
  double squares = 0.0, count = 0.0;
  for (const std::int16_t voxel : voxelsOf<std::int16_t>(volume)) {
    squares += std::pow(static_cast<double>(voxel) - expected, 2);
    count += 1.0;
  }
  return std::sqrt(squares / count);
}

TEST(NonLocalMeans, RemovesTwoThirdsOfTheNoise) {
  const Volume volume =
      makeVoxels<std::int16_t>(makeScaledGrid({40, 40, 20}, {0.9, 0.9, 2.5}),
                               [](const Size3& v) { return 50.0 + 30.0 * normalNoise(4, v); });
  EXPECT_LT(deviation(applyNonLocalMeans(volume, {30.0, 30.0}), 50.0), 0.34 * 30.0);
}

TEST(NonLocalMeans, LeavesEdgesAndConstantsUnchanged) {
  const Grid grid = makeScaledGrid({30, 20, 10}, {0.9, 0.9, 2.5});
  const Volume edge =
      makeVoxels<std::int16_t>(grid, [](const Size3& v) { return v.x() < 15 ? -850.0 : 60.0; });
  EXPECT_EQ(applyNonLocalMeans(edge, {30.0, 30.0}).voxels, edge.voxels);
  const Volume constant = makeVoxels<float>(grid, [](const Size3&) { return 0.1; });
  EXPECT_EQ(applyNonLocalMeans(constant, {30.0, 30.0}).voxels, constant.voxels);
}

TEST(NonLocalMeans, KeepsALesionOf8Millimeters) {
  const Grid grid = makeScaledGrid({48, 48, 20}, {0.9355, 0.9355, 2.5});
  const auto fill = [&](double contrast) {
    return makeVoxels<std::int16_t>(grid, [&, contrast](const Size3& v) {
      const double r = (grid.spacing().cwiseProduct((v - Size3(24, 24, 10)).cast<double>())).norm();
      return 60.0 + 30.0 * normalNoise(5, v) + contrast / (1.0 + std::exp((r - 4.0) / 0.5));
    });
  };
  const NonLocalMeans filter{30.0, 30.0};
  const Volume without = applyNonLocalMeans(fill(0.0), filter);
  for (const double contrast : {-40.0, 60.0}) {
    const Volume with = applyNonLocalMeans(fill(contrast), filter);
    double sum = 0.0, count = 0.0;
    for (std::int64_t y = 23; y <= 25; ++y)
      for (std::int64_t x = 23; x <= 25; ++x) {
        const std::size_t i = linearIndex({x, y, 10}, grid.size);
        sum += static_cast<double>(voxelsOf<std::int16_t>(with)[i]) -
               static_cast<double>(voxelsOf<std::int16_t>(without)[i]);
        count += 1.0;
      }
    EXPECT_GT(sum / count / contrast, 0.85) << contrast;
  }
}

TEST(NonLocalMeans, ExtremeNumbersStayFiniteAndInRange) {
  const Volume volume =
      makeVoxels<float>(makeScaledGrid({9, 9, 3}, {1.0, 1.0, 1.0}),
                        [](const Size3& v) { return v.x() % 3 == 0 ? 3e38 : -3e38; });
  for (const double strength : {1e-300, 1e-38, 1.0, 1e30, 1e38, 1e300})
    for (const bool isLogarithmic : {false, true}) {
      const Volume smooth = applyNonLocalMeans(volume, {strength, strength, isLogarithmic});
      for (const float voxel : voxelsOf<float>(smooth))
        ASSERT_TRUE(voxel >= -3.1e38F && voxel <= 3.1e38F) << strength;
    }
  EXPECT_EQ(applyNonLocalMeans(volume, {0.0, 0.0}).voxels, volume.voxels);
}

} // namespace
} // namespace fenestra::core::testing::NonLocalMeansTests
