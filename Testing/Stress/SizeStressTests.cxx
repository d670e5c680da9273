// Volumes of one voxel, one row, one slice, prime sizes, and more than 2^31 voxels.

#include "StressSupport.h"

#include <array>
#include <fstream>

namespace fenestra::core::testing::SizeStressTests {
namespace {

/// Continuous field by its definition: trilinear interpolation of the voxels, clamped.
template <typename Voxel>
double evaluateField(const Volume& volume, const Vec3& index) {
  const auto& voxels = std::get<LargeArray<Voxel>>(volume.voxels);
  const Size3& size = volume.grid.size;
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    std::array<std::uint64_t, 3> at{};
    for (int axis = 0; axis < 3; ++axis) {
      const double x = std::clamp(index[axis], 0.0, static_cast<double>(size[axis] - 1));
      const double low = std::floor(x);
      const bool up = corner >> axis & 1;
      weight *= up ? x - low : 1.0 - (x - low);
      at[static_cast<std::size_t>(axis)] = static_cast<std::uint64_t>(
          std::min(low + (up ? 1.0 : 0.0), static_cast<double>(size[axis] - 1)));
    }
    const auto rowLength = static_cast<std::uint64_t>(size.x());
    const auto rowsPerSlice = static_cast<std::uint64_t>(size.y());
    if (weight > 0.0)
      sum +=
          weight * static_cast<double>(voxels[at[0] + rowLength * (at[1] + rowsPerSlice * at[2])]);
  }
  return sum;
}

/// Integral of the field along a segment, by the midpoint rule.
template <typename Voxel>
double integrateField(const Volume& volume, const Vec3& from, const Vec3& to, int steps = 20000) {
  double sum = 0.0;
  for (int k = 0; k < steps; ++k)
    sum += evaluateField<Voxel>(volume, volume.grid.worldToIndex *
                                            (from + (to - from) * ((k + 0.5) / steps)));
  return sum * (to - from).norm() / steps;
}

Vec3 sampleIndex(const Grid& grid, Random& random) {
  const Vec3 u(random.uniform(), random.uniform(), random.uniform());
  return u.cwiseProduct(grid.size.cast<double>()) - Vec3::Constant(0.5);
}

class SmallSizes : public ::testing::TestWithParam<std::array<int, 3>> {
protected:
  SmallSizes() {
    const Size3 size(GetParam()[0], GetParam()[1], GetParam()[2]);
    // Rotated volume of about 6 mm along each axis.
    Grid grid = makeCenteredGrid(size, Vec3(6.0, 5.0, 7.0).cwiseQuotient(size.cast<double>()));
    grid = Grid(size, makeRotation(0.6, Vec3(1, 2, 3).normalized()) * grid.indexToWorld);
    m_volume = makeVolume(grid, [](const Vec3& p) {
      return 0.5 + 0.5 * std::sin(1.7 * p.x() + 0.5) * std::cos(2.1 * p.y() - p.z());
    });
  }

  Volume m_volume;
};

TEST_P(SmallSizes, TransmittanceEqualsExpOfIntegral) {
  constexpr double sigma = 0.3;
  const RayProbe<> probe(m_volume, makeLinearTransfer(sigma, Rgb::Zero()));
  const Grid& grid = m_volume.grid;
  for (int i = 0; i < 6; ++i) {
    Random random(2, static_cast<std::uint64_t>(i), 0);
    const Vec3 a = grid.indexToWorld * sampleIndex(grid, random);
    const Vec3 b = grid.indexToWorld * sampleIndex(grid, random);
    const Ray ray{a, (b - a).normalized()};
    EXPECT_NEAR(probe.measureWalk(ray), chord(grid, ray), 1e-12);
    const Interval range{0.0, (b - a).norm()};
    const double depth = sigma * integrateField<float>(m_volume, a, b, 4000);
    probe.expectTransmittance(ray, range, std::exp(-depth), scaleSamples(4000));
  }
}

TEST_P(SmallSizes, GradientIsZeroAlongSingleVoxels) {
  const RayProbe<> probe(m_volume, makeLinearTransfer(1.0, Rgb::Zero()));
  const Grid& grid = m_volume.grid;
  for (int i = 0; i < 20; ++i) {
    Random random(3, static_cast<std::uint64_t>(i), 0);
    const Vec3 index = sampleIndex(grid, random);
    const Vec3 gradient = probe.medium().evaluate(index, true).gradient;
    for (int axis = 0; axis < 3; ++axis) {
      // The derivative along an index axis is the gradient's dot product with that axis's column.
      const Vec3 step = Vec3::Unit(axis);
      const double expected = 0.5 * (evaluateField<float>(m_volume, index + step) -
                                     evaluateField<float>(m_volume, index - step));
      EXPECT_NEAR(gradient.dot(grid.indexToWorld.linear().col(axis)), expected, 1e-12);
      EXPECT_TRUE(grid.size[axis] > 1 || expected == 0.0) << expected;
    }
  }
}

TEST_P(SmallSizes, FurnaceIsOne) {
  for (const bool hybrid : {false, true}) {
    TestScene scene{m_volume, makeLinearTransfer(0.8, Rgb::Ones()), {EnvironmentLight{}}, {}, 12,
                    12};
    scene.pose.position = {3.0, -20.0, 6.0};
    scene.pose.target = Vec3::Zero();
    scene.pose.scale = 6.0;
    if (hybrid)
      scene.transfer.shading = SurfaceShading{1.0, 0.0, 10.0, 0.5}; // Lambert alone loses no energy
    expectRadianceOne(renderScene(scene, scaleSamples(50)));
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, SmallSizes,
                         ::testing::Values(std::array{1, 1, 1}, std::array{5, 1, 1},
                                           std::array{1, 6, 1}, std::array{1, 1, 7},
                                           std::array{9, 1, 4}, std::array{8, 9, 1},
                                           std::array{1, 9, 8}, std::array{2, 2, 2},
                                           std::array{7, 11, 13}, std::array{251, 3, 1},
                                           std::array{1, 2, 127}),
                         [](const auto& info) {
                           return std::to_string(info.param[0]) + "x" +
                                  std::to_string(info.param[1]) + "x" +
                                  std::to_string(info.param[2]);
                         });

// ---- cells

TEST(MajorantCells, AnyShapeHasAboutQuarterMillionCells) {
  constexpr double target = 1 << 18;
  struct Shape {
    Size3 size;
    Vec3 spacing;
  };
  for (const auto& [size, spacing] :
       {Shape{{512, 512, 512}, {1, 1, 1}}, Shape{{127, 131, 113}, {1, 1, 1}},
        Shape{{40000, 40000, 1}, {1, 1, 1}}, Shape{{40000, 40000, 1}, {1, 1, 0.001}},
        Shape{{40000, 1, 40000}, {0.001, 100, 0.001}}, Shape{{1, 2000000000, 1}, {1, 1, 1}},
        Shape{{2000000000, 1, 1}, {1, 0.001, 1000}}, Shape{{1300, 1300, 1300}, {0.01, 0.01, 100}},
        Shape{{2000, 2000, 3}, {0.01, 0.01, 100}}, Shape{{3000000, 3, 5}, {1, 2, 0.1}}}) {
    const Size3 edge = MinMaxGrid::chooseCellSize(makeCenteredGrid(size, spacing));
    const Size3 cells = (size.array() + edge.array() - 1) / edge.array();
    EXPECT_TRUE((edge.array() >= 1).all() && (edge.array() <= size.array()).all());
    EXPECT_LT(cells.cast<double>().prod(), 4.0 * target) << size;
    EXPECT_GT(cells.cast<double>().prod(), 0.25 * target) << size;
  }
}

TEST(MajorantCells, PrimeSizesTransmitExpOfIntegral) {
  const Volume volume = makeVolume<std::uint8_t>(
      makeCenteredGrid({127, 131, 113}, Vec3::Constant(0.05)), [](const Vec3& p) {
        return 127.5 + 127.5 * std::sin(0.3 * p.x()) * std::cos(0.2 * p.y() + 0.25 * p.z());
      });
  ASSERT_EQ(MinMaxGrid::chooseCellSize(volume.grid), Size3(2, 2, 2));
  constexpr double sigma = 0.3 / 255.0;
  const RayProbe<std::uint8_t> probe(
      volume, {ScalarFunction({makeKnot(0.0, 0.0), makeKnot(255.0, 255.0 * sigma)}),
               ColorFunction({{0.0, Rgb::Zero()}})});
  for (int i = 0; i < 4; ++i) {
    const Vec3 from = volume.grid.worldCorner(i);
    const Vec3 to = volume.grid.worldCorner(7 - i);
    const double depth = sigma * integrateField<std::uint8_t>(volume, from, to);
    probe.expectTransmittance({from, (to - from).normalized()}, {}, std::exp(-depth),
                              scaleSamples(4000));
  }
}

// ---- more than 2^31 voxels

double availableGigabytes() {
  std::ifstream file("/proc/meminfo");
  for (std::string word; file >> word;)
    if (word == "MemAvailable:") {
      double kilobytes = 0.0;
      file >> kilobytes;
      return kilobytes * 1024.0 / 1e9;
    }
  return 0.0;
}

constexpr bool isSanitized() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return true;
#elif defined(__has_feature)
  return __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
  return false;
#endif
}

/// Volume of 0, with blocks of 16^3 voxels of 100 and of 200 in two opposite corners.
Volume makeHugeVolume(std::int64_t side) {
  LargeArray<std::uint8_t> voxels(static_cast<std::size_t>(side * side * side));
  for (std::int64_t k = 0; k < 16; ++k)
    for (std::int64_t j = 0; j < 16; ++j)
      for (std::int64_t i = 0; i < 16; ++i) {
        const auto near = static_cast<std::size_t>(i + side * (j + side * k));
        voxels[near] = 100;
        voxels[voxels.size() - 1 - near] = 200;
      }
  return {makeCenteredGrid({side, side, side}, Vec3::Constant(0.1)),
          std::move(voxels),
          0.0,
          200.0,
          "huge volume",
          {}};
}

TEST(HugeVolume, VoxelsBeyond31BitsAreVisible) {
  if (isSanitized() || availableGigabytes() < 8.0)
    GTEST_SKIP() << "requires 8 GB of free memory and no sanitizer";
  constexpr std::int64_t side = 1300;
  // 1 mm of the far block has an optical depth of 1.
  TestScene scene{makeHugeVolume(side),
                  {ScalarFunction({makeKnot(0.0, 0.0), makeKnot(200.0, 1.0)}),
                   ColorFunction({{0.0, Rgb::Constant(0.5)}})},
                  {EnvironmentLight{}},
                  {},
                  4,
                  4};
  const Volume& volume = scene.volume;
  ASSERT_GT(volume.grid.voxelCount(), std::int64_t{1} << 31);
  const MinMaxGrid ranges(volume, 0);
  EXPECT_EQ(ranges.high(0), 100.0);
  EXPECT_EQ(ranges.high(ranges.size() - 1), 200.0);
  // Cells larger than the block also contain 0.
  EXPECT_EQ(ranges.low(ranges.size() - 1), 200.0 * (ranges.cellSize().x() < 16 ? 1 : 0));
  EXPECT_EQ(ranges.high(ranges.size() / 2), 0.0);

  const RayProbe<std::uint8_t> probe(scene.volume, scene.transfer);
  const Vec3 last = volume.grid.indexToWorld * Vec3::Constant(side - 1.0);
  for (const Vec3& direction :
       {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 1), Vec3(1, 0.5, 0.2)}) {
    const Vec3 from = last - 4.0 * direction;
    const double depth = integrateField<std::uint8_t>(volume, from, last) / 200.0;
    EXPECT_GT(depth, 1.0);
    probe.expectTransmittance({from, direction.normalized()}, {0.0, (last - from).norm()},
                              std::exp(-depth), scaleSamples(4000));
  }
  // The far block must look like a small volume with the content of the last corner.
  scene.pose.position = last + Vec3(3, 4, 5);
  scene.pose.target = last - Vec3::Constant(0.8);
  scene.pose.scale = 1.5;
  constexpr std::int64_t part = 32;
  const Grid corner({part, part, part},
                    volume.grid.indexToWorld * makeTranslation(Vec3::Constant(side - part)));
  const TestScene small{
      makeVolume<std::uint8_t>(
          corner, [](const Vec3& p) { return p.minCoeff() >= part - 16 ? 200.0 : 0.0; }),
      scene.transfer,
      scene.lights,
      scene.pose,
      4,
      4};
  expectSameImage(renderScene(scene, scaleSamples(500), 1).film,
                  renderScene(small, scaleSamples(500), 2).film);
}

} // namespace
} // namespace fenestra::core::testing::SizeStressTests
