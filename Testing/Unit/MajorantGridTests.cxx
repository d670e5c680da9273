#include "integrator/scalar/MajorantGrid.h"

#include "RunSettings.h"
#include "Support.h"
#include "base/Random.h"
#include "model/medium/Medium.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::MajorantGridTests {
namespace {

ScalarFunction::Knot knot(double s, double y) {
  return {s, ScalarFunction::Value(y)};
}

template <typename Voxel>
LargeArray<Voxel> makeNoise(const Size3& size, double low, double high) {
  LargeArray<Voxel> voxels;
  for (std::int64_t i = 0; i < size.prod(); ++i) {
    Random random(6, static_cast<std::uint64_t>(i), 0);
    // One half is nearly constant, the other has rare peaks, so that the ranges of cells differ.
    const double most = i % size.x() < size.x() / 2 ? 0.02 : 1.0;
    voxels.push_back(
        static_cast<Voxel>(low + most * (high - low) * std::pow(random.uniform(), 20.0)));
  }
  return voxels;
}

/// Index of the cell that contains a point (index space).
std::int64_t findCell(const MajorantGrid& majorants, const Grid& grid, const Vec3& p) {
  const Vec3 inCells = majorants.worldToCell() * (grid.indexToWorld * p);
  Size3 cell;
  for (int axis = 0; axis < 3; ++axis)
    cell[axis] = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(inCells[axis])), 0,
                                          majorants.cellCount()[axis] - 1);
  return cell.x() + majorants.cellCount().x() * (cell.y() + majorants.cellCount().y() * cell.z());
}

/// Random point of the box within MajorantGrid::margin of `p` along each axis.
Vec3 randomNeighbor(const Vec3& p, const Box& box, Random& random) {
  Vec3 q;
  for (int axis = 0; axis < 3; ++axis)
    q[axis] = std::clamp(p[axis] + MajorantGrid::margin * (2.0 * random.uniform() - 1.0),
                         box.lower[axis], box.upper[axis]);
  return q;
}

/// Expects extinction <= majorant at random points of the cells and within the margin around them.
template <typename Voxel>
void expectConservative(const TransferFunction& transfer, double low, double high) {
  Affine map = Affine::Identity();
  map.linear() = Mat3::Diagonal({0.3, -1.0, 2.5});
  const Grid grid(Size3(29, 17, 11), map);
  Volume volume{grid, makeNoise<Voxel>(grid.size, low, high), 0.0, 0.0, "noise", {}};
  computeRange(volume);
  const MinMaxGrid ranges(volume, MajorantGrid::requiredPadding(transfer));
  const MajorantGrid majorants(grid, ranges, transfer, ClipNone{});
  const Medium<Voxel> medium(grid, std::get<LargeArray<Voxel>>(volume.voxels), transfer);

  const Box box = grid.indexBox();
  double tightest = infinity;
  for (int i = 0; i < reduceSamples(300000); ++i) {
    Random random(7, static_cast<std::uint64_t>(i), 0);
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] = box.lower[axis] + random.uniform() * (box.upper[axis] - box.lower[axis]);
      if (random.uniform() < 0.3) // often on voxel centers and cell faces
        p[axis] = std::round(2.0 * p[axis]) / 2.0;
    }
    const std::int64_t index = findCell(majorants, grid, p);
    const Vec3 q = randomNeighbor(p, box, random);
    ASSERT_LE(medium.extinction(q), static_cast<double>(majorants.cell(index).majorant))
        << "at " << q << " near the cell of " << p;
    const double sigma_t = medium.extinction(p);
    ASSERT_LE(sigma_t, static_cast<double>(majorants.cell(index).majorant)) << "at " << p;
    tightest = std::min(tightest, static_cast<double>(majorants.cell(index).majorant));
  }
  EXPECT_LT(tightest, transfer.extinction.range(-1e9, 1e9)[1]) << "no cell is below the maximum";
}

const ColorFunction gray({{0.0, Rgb::Constant(0.5)}});

TEST(MajorantGrid, BoundsNonMonotonicExtinction) {
  const TransferFunction transfer{
      ScalarFunction({knot(0, 0), knot(40, 0), knot(50, 8), knot(60, 0), knot(200, 1)}), gray};
  expectConservative<std::uint8_t>(transfer, 0, 255);
  expectConservative<float>(transfer, -20, 220);
}

TEST(MajorantGrid, OccupiedBoundsAreTightToOneCell) {
  const Grid grid({160, 129, 96}, Affine::Identity());
  const Vec3 first(11, 6, 67), last(130, 8, 95); // corner voxels of a block, inclusive
  Volume volume = makeVolume<std::uint8_t>(grid, [&](const Vec3& p) {
    const bool inside = (p.array() >= first.array()).all() && (p.array() <= last.array()).all();
    return inside ? 200.0 : 10.0;
  });
  const auto computeBounds = [&](double threshold) {
    const TransferFunction transfer{ScalarFunction({knot(threshold, 0), knot(threshold + 1, 1)}),
                                    gray};
    return MajorantGrid(grid, MinMaxGrid(volume, 0), transfer, ClipNone{}).occupiedBounds();
  };
  const Vec3 edge = MinMaxGrid::chooseCellSize(grid).cast<double>();
  const Box box = computeBounds(100.0);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(box.lower[axis], first[axis] - 0.5);
    EXPECT_GE(box.lower[axis], first[axis] - 2.0 - edge[axis]);
    EXPECT_GE(box.upper[axis], std::min(last[axis] + 0.5, grid.indexBox().upper[axis]));
    EXPECT_LE(box.upper[axis], last[axis] + 2.0 + edge[axis]);
  }
  EXPECT_EQ(computeBounds(5.0).lower, grid.indexBox().lower);
  EXPECT_TRUE((computeBounds(5.0).upper.array() >= grid.indexBox().upper.array()).all());
  EXPECT_EQ(computeBounds(250.0), Box::makeEmpty());
  EXPECT_GT(edge.minCoeff(), 1.0) << "cells must span several voxels";
}

TEST(MajorantGrid, BoundsStepsAndSpikes) {
  const TransferFunction transfer{ScalarFunction({knot(0, 0), knot(100, 0), knot(100, 5),
                                                  knot(101, 5), knot(101, 0), knot(1000, 0.1)}),
                                  gray};
  expectConservative<std::int16_t>(transfer, -50, 1000);
}

TEST(MajorantGrid, BoundsGradientOpacity) {
  TransferFunction transfer{ScalarFunction({knot(0, 0.5), knot(255, 3)}), gray};
  transfer.gradientOpacity = ScalarFunction({knot(0, 0), knot(30, 0.2), knot(60, 1), knot(200, 0)});
  expectConservative<std::uint16_t>(transfer, 0, 255);
}

/// Fraction of cells with majorant 0.
double computeEmptyFraction(const MajorantGrid& grid) {
  std::int64_t empty = 0;
  for (std::int64_t i = 0; i < grid.cellCount().prod(); ++i)
    empty += grid.cell(i).majorant == 0.0F;
  return static_cast<double>(empty) / static_cast<double>(grid.cellCount().prod());
}

TEST(MajorantGrid, ClippedCellsAreEmptyAndCutCellsAreMarked) {
  const Grid grid(Size3(32, 32, 32), Affine::Identity());
  Volume volume{grid, LargeArray<float>(32768, 1.0F), 1.0, 1.0, "ones", {}};
  const MinMaxGrid ranges(volume, 0);
  const TransferFunction opaque{ScalarFunction({knot(0, 0), knot(1, 2)}), gray};
  CameraPose pose;
  pose.position = {16, 16, 100};
  pose.target = {16, 16, 16};
  pose.up = Vec3::UnitY();
  // The clip plane halves a layer of cells and removes the part above.
  const Clip plane = ClipPlane{Camera(pose, 8, 8), Vec3(0, 0, 15.9), Vec3::UnitZ()};
  const MajorantGrid clipped(grid, ranges, opaque, plane);
  const double layer = 1.0 / static_cast<double>(clipped.cellCount().z());
  EXPECT_NEAR(computeEmptyFraction(clipped), 0.5, layer);
  std::int64_t cut = 0;
  for (std::int64_t i = 0; i < clipped.cellCount().prod(); ++i)
    cut += clipped.cell(i).isCut;
  EXPECT_EQ(cut, clipped.cellCount().x() * clipped.cellCount().y());

  const TransferFunction empty{ScalarFunction({knot(1.5, 0), knot(2, 2)}), gray};
  EXPECT_EQ(computeEmptyFraction(MajorantGrid(grid, ranges, empty, ClipNone{})), 1.0);
}

TEST(MajorantGrid, BoundsClipAndContextStyleWithinMarginOfCells) {
  const Grid grid(Size3(24, 24, 24), Affine::Identity());
  Volume volume{grid, LargeArray<float>(13824, 1.0F), 1.0, 1.0, "ones", {}};
  const TransferFunction opaque{ScalarFunction({knot(0, 0), knot(1, 2)}), gray};
  CameraPose pose;
  pose.position = {12, 12, 100};
  pose.target = {12, 12, 12};
  pose.up = Vec3::UnitY();
  const Clip plane =
      ClipPlane{Camera(pose, 8, 8), Vec3(12.2, 11.7, 12.1), Vec3(0.3, -0.5, 1.0).normalized()};
  const auto focus = std::make_shared<Mask>(
      Mask{.grid = grid, .voxels = std::vector<std::uint8_t>(13824, 0), .names = {}});
  for (std::size_t i = 0; i < 24 * 24 * 11 + 24 * 9; ++i) // 11 slices and 9 rows
    focus->voxels[i] = 1;
  const ContextStyle style{.focus = focus, .extinction = 0.25};
  const MajorantGrid majorants(grid, MinMaxGrid(volume, 0), opaque, plane, &style);
  const Medium<float> medium(grid, std::get<LargeArray<float>>(volume.voxels), opaque, &style);
  const Box box = grid.indexBox();
  for (int i = 0; i < reduceSamples(200000); ++i) {
    Random random(8, static_cast<std::uint64_t>(i), 0);
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] = box.lower[axis] + random.uniform() * (box.upper[axis] - box.lower[axis]);
      if (random.uniform() < 0.8) // often on a voxel face
        p[axis] = std::floor(p[axis]) + 0.5;
    }
    const MajorantGrid::Cell& cell = majorants.cell(findCell(majorants, grid, p));
    const Vec3 q = randomNeighbor(p, box, random);
    const double weight = clipWeight(plane, q);
    ASSERT_LE(weight * medium.extinction(q), static_cast<double>(cell.majorant)) << "at " << q;
    ASSERT_TRUE(cell.isCut || cell.majorant == 0.0F || weight == 1.0) << "at " << q;
  }
}

TEST(MinMaxGrid, ThickSlicesDoNotElongateCells) {
  Affine map = Affine::Identity();
  map.linear() = Mat3::Diagonal({0.5, 0.5, 5.0});
  const Grid grid(Size3(512, 512, 60), map);
  const Size3 edge = MinMaxGrid::chooseCellSize(grid);
  EXPECT_EQ(edge.z(), 1);
  EXPECT_EQ(edge.x(), edge.y());
  EXPECT_NEAR(0.5 * static_cast<double>(edge.x()), 5.0, 2.5);
  EXPECT_EQ(MinMaxGrid::chooseCellSize(Grid(Size3(1, 1, 1), map)), Size3(1, 1, 1));
}

TEST(MinMaxGrid, CellsSpanAtLeastOneVoxel) {
  for (const double scale : {1e-300, 1.0, 1e308}) {
    Affine map = Affine::Identity();
    map.linear()(0, 1) = scale;
    EXPECT_TRUE((MinMaxGrid::chooseCellSize(Grid({3, 4, 2}, map)).array() >= 1).all());
  }
}

} // namespace
} // namespace fenestra::core::testing::MajorantGridTests
