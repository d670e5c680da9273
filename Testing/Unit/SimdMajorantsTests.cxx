#include "integrator/simd/MajorantGrid.h"

#include "base/Random.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::SimdMajorantsTests {
namespace {

constexpr std::int64_t edge = 96;

/// Extinction at a voxel, mm^-1.
using Extinction = double (*)(const Vec3&);

/// Majorants of a volume of 1 mm voxels whose scalars are the extinctions.
MajorantGrid makeMajorants(Extinction extinction, const Clip& clip = ClipNone{}) {
  const Grid grid(Size3(edge, edge, edge), Affine::Identity());
  LargeArray<float> voxels;
  for (std::int64_t z = 0; z < edge; ++z)
    for (std::int64_t y = 0; y < edge; ++y)
      for (std::int64_t x = 0; x < edge; ++x)
        voxels.push_back(static_cast<float>(extinction(Size3(x, y, z).cast<double>())));
  Volume volume{grid, std::move(voxels), 0.0, 0.0, "", {}};
  computeRange(volume);
  const ScalarFunction identity(
      {{0.0, ScalarFunction::Value(0.0)}, {1e6, ScalarFunction::Value(1e6)}});
  const TransferFunction transfer{.extinction = identity,
                                  .albedo = ColorFunction({{0.0, Rgb::Ones()}})};
  return {grid, MinMaxGrid(volume, 0), transfer, clip};
}

/// Fields of a cell's code, as SIMD code decodes them.
struct DecodedCell {
  float majorant;
  std::int32_t skipRadius;
  bool isCut;
};

struct MajorantPair {
  MajorantGrid majorants;
  SimdMajorants simd{majorants};
  Size3 count = simd.count;

  /// Maximum majorant of the scalar cells merged into cell c; cut if one of them is.
  MajorantGrid::Cell mergeCells(const Size3& c) const {
    MajorantGrid::Cell merged{0.0F, false};
    const Size3& fine = majorants.cellCount();
    const Size3 low = simd.merged * c;
    const Size3 high = (low.array() + simd.merged).matrix().cwiseMin(fine);
    for (std::int64_t z = low.z(); z < high.z(); ++z)
      for (std::int64_t y = low.y(); y < high.y(); ++y)
        for (std::int64_t x = low.x(); x < high.x(); ++x) {
          const MajorantGrid::Cell& cell = majorants.cell(x + fine.x() * (y + fine.y() * z));
          merged = {std::max(merged.majorant, cell.majorant), merged.isCut || cell.isCut};
        }
    return merged;
  }
  DecodedCell cell(const Size3& c) const {
    const std::int32_t code = simd.codes[linearIndex(c.array() + 1, count.array() + 2)];
    return {std::bit_cast<float>(code & SimdMajorants::majorantBits),
            code & SimdMajorants::radiusBits, code < 0};
  }
  explicit MajorantPair(MajorantGrid scalarGrid) : majorants(std::move(scalarGrid)) {}
  template <typename Visit>
  void forEach(const Size3& from, const Size3& to, Visit&& visit) const {
    const Size3 low = from.cwiseMax(Size3::Zero());
    const Size3 high = to.cwiseMin(count - Size3::Ones());
    for (std::int64_t z = low.z(); z <= high.z(); ++z)
      for (std::int64_t y = low.y(); y <= high.y(); ++y)
        for (std::int64_t x = low.x(); x <= high.x(); ++x)
          visit(Size3(x, y, z));
  }
  template <typename Visit>
  void forEach(Visit&& visit) const {
    forEach(Size3::Zero(), count, visit);
  }
};

/// Checks, for one cell in sixteen, that its majorant bounds all cells within its skip radius.
void expectBounds(const MajorantPair& pair) {
  pair.forEach([&](const Size3& c) {
    if ((c.x() + 3 * c.y() + 7 * c.z()) % 16 != 0)
      return;
    const DecodedCell cell = pair.cell(c);
    const MajorantGrid::Cell exact = pair.mergeCells(c);
    ASSERT_EQ(cell.majorant == 0.0F, exact.majorant == 0.0F) << c;
    ASSERT_EQ(cell.isCut, exact.isCut) << c;
    if (cell.skipRadius == 0) { // rounded up to fifteen bits
      ASSERT_LE(cell.majorant, exact.majorant * (1.0F + 0x1p-15F)) << c;
    }
    const Size3 radius = Size3::Constant(cell.skipRadius);
    pair.forEach(c - radius, c + radius, [&](const Size3& other) {
      ASSERT_GE(cell.majorant, pair.mergeCells(other).majorant) << c << ", " << other;
      ASSERT_TRUE(other == c || !pair.mergeCells(other).isCut) << c << ", " << other;
    });
  });
}

/// Extinction: high in a ball, low in mist at low z, 0 above.
double ballInMist(const Vec3& p) {
  const bool isInBall = (p - Vec3::Constant(0.5 * edge)).norm() < 0.2 * edge;
  const double mist = p.z() < 0.6 * edge ? 1e-3 * (1.0 + p.x() / edge) : 0.0;
  return isInBall ? 2.0 + std::sin(p.y()) : mist;
}

TEST(SimdMajorants, MajorantBoundsEveryCellWithinTheSkipRadius) {
  const MajorantPair pair{makeMajorants(ballInMist)};
  expectBounds(pair);
  EXPECT_GT(pair.cell(Size3::Constant(4)).skipRadius, 3) << "mist";
  EXPECT_EQ(pair.cell(pair.count / 2).skipRadius, 0) << "the ball";
  const DecodedCell above = pair.cell({5, 5, pair.count.z() - 2});
  EXPECT_EQ(above.majorant, 0.0F);
  EXPECT_GT(above.skipRadius, 0);
}

TEST(SimdMajorants, SkipRadiusIsZeroInCutCells) {
  const CameraPose pose{
      .position = {0.0, 0.0, -200.0}, .target = Vec3::Zero(), .up = Vec3::UnitY()};
  const ClipPlane plane{Camera(pose, 8, 8), Vec3::Constant(0.5 * edge), Vec3(1.0, 2.0, 3.0)};
  const MajorantPair pair{makeMajorants(ballInMist, plane)};
  expectBounds(pair);
  int cutCount = 0;
  pair.forEach([&](const Size3& c) {
    cutCount += pair.cell(c).isCut ? 1 : 0;
    EXPECT_TRUE(!pair.cell(c).isCut || pair.cell(c).skipRadius == 0) << c;
  });
  EXPECT_GT(cutCount, 100);
}

TEST(SimdMajorants, MergesOnlyCellsOfFewVoxels) {
  EXPECT_EQ(MajorantPair{makeMajorants(ballInMist)}.simd.merged, 2) << "2^3 voxels";
  const Grid grid(Size3(256, 256, 256), Affine::Identity());
  const Volume volume{grid, LargeArray<std::uint8_t>(1 << 24, 1), 0.0, 1.0, "", {}};
  const TransferFunction thin{
      ScalarFunction({{0.0, ScalarFunction::Value(0.1)}, {1.0, ScalarFunction::Value(0.1)}}),
      ColorFunction({{0.0, Rgb::Ones()}})};
  const SimdMajorants simd(MajorantGrid(grid, MinMaxGrid(volume, 0), thin, ClipNone{}));
  EXPECT_EQ(simd.merged, 1) << "4^3 voxels";
  EXPECT_EQ(simd.count, Size3(64, 64, 64));
}

TEST(SimdMajorants, BoundsExtinctionsOfAnyMagnitude) {
  const MajorantPair pair{
      makeMajorants([](const Vec3& p) { return std::pow(10.0, 0.4 * p.x() - 33.0); })};
  expectBounds(pair);
}

} // namespace
} // namespace fenestra::core::testing::SimdMajorantsTests
