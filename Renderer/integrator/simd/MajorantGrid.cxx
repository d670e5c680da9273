#include "integrator/simd/MajorantGrid.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <bit>

namespace fenestra::core {
namespace {

/// Index arithmetic of an array of cells with a border one cell wide.
struct PaddedGrid {
  Size3 size;

  std::size_t count() const { return static_cast<std::size_t>(size.prod()); }
  std::size_t index(const Size3& cell) const { return linearIndex(cell, size); }
  /// Offsets from a cell to its next neighbors along the axes.
  std::array<std::size_t, 3> strides() const {
    return {index(Size3::UnitX()), index(Size3::UnitY()), index(Size3::UnitZ())};
  }
  /// Calls visit(index, cell) for all cells of a layer, border excluded.
  template <typename Visit>
  void forEachInLayer(std::int64_t z, Visit&& visit) const {
    for (std::int64_t y = 1; y < size.y() - 1; ++y)
      for (std::int64_t x = 1; x < size.x() - 1; ++x)
        visit(index({x, y, z}), Size3(x, y, z));
  }
  /// Visits inner cells in ascending order of their indices.
  template <typename Visit>
  void forEachInner(Visit&& visit) const {
    for (std::int64_t z = 1; z < size.z() - 1; ++z)
      forEachInLayer(z, visit);
  }
  /// Visits inner cells in any order.
  template <typename Visit>
  void forEachInParallel(Visit&& visit) const {
    tbb::parallel_for(std::int64_t{1}, size.z() - 1,
                      [&](std::int64_t z) { forEachInLayer(z, visit); });
  }
};

/// For each inner cell the radius, in cells, of the empty cube around it; -1 for cells that are not
/// empty. A chessboard distance transform in two sweeps (Rosenfeld and Pfaltz 1966). Cells
/// outside the border do not count as empty.
std::vector<std::int32_t> findEmptyRadii(const PaddedGrid& grid,
                                         const std::vector<float>& majorants) {
  constexpr std::int32_t unknown = 1000000;
  std::vector<std::int32_t> cells(grid.count(), 0);
  grid.forEachInner(
      [&](std::size_t i, const Size3&) { cells[i] = majorants[i] > 0.0F ? -1 : unknown; });
  std::array<std::ptrdiff_t, 13> back; // offsets to neighbors visited earlier in the first sweep
  for (std::ptrdiff_t n = 0; n < 13; ++n)
    back[static_cast<std::size_t>(n)] =
        n % 3 - 1 + grid.size.x() * (n / 3 % 3 - 1 + grid.size.y() * (n / 9 - 1));
  const auto relax = [&](std::int32_t* cell, std::ptrdiff_t side) {
    // A filled neighbor (-1) allows radius 0; an empty one of radius n allows n + 1.
    for (const std::ptrdiff_t step : back)
      if (*cell > 0)
        *cell = std::min(*cell, cell[side * step] + 1);
  };
  grid.forEachInner([&](std::size_t i, const Size3&) { relax(&cells[i], 1); });
  grid.forEachInner([&](std::size_t i, const Size3&) { relax(&cells[grid.count() - 1 - i], -1); });
  return cells;
}

/// Replaces each inner cell by the maximum of the 27 cells centered there.
void dilate(const PaddedGrid& grid, std::vector<float>& cells, std::vector<float>& scratch) {
  for (const std::size_t stride : grid.strides()) {
    grid.forEachInParallel([&](std::size_t i, const Size3&) {
      scratch[i] = std::max({cells[i - stride], cells[i], cells[i + stride]});
    });
    cells.swap(scratch);
  }
}

/// Skip radius of each cell, and the majorant that holds within it.
struct SkipRadii {
  std::vector<float> bound;
  std::vector<std::uint8_t> radii;
};

/// Summed-volume table: sums over boxes of cells in constant time.
class BoxSums {
public:
  BoxSums(const PaddedGrid& grid, const std::vector<float>& cells)
      : m_grid(grid), m_sums(cells.begin(), cells.end()) {
    for (const std::size_t stride : grid.strides())
      grid.forEachInner([&](std::size_t i, const Size3&) { m_sums[i] += m_sums[i - stride]; });
  }

  /// Mean over the inner cells within `radius` cells of a cell.
  float mean(const Size3& cell, std::int64_t radius) const {
    const Size3 low = (cell.array() - radius).max(1);
    const Size3 high = (cell.array() + radius).min(m_grid.size.array() - 2);
    const auto upTo = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
      return m_sums[m_grid.index({x, y, z})];
    };
    const auto slice = [&](std::int64_t z) {
      return upTo(high.x(), high.y(), z) - upTo(low.x() - 1, high.y(), z) -
             upTo(high.x(), low.y() - 1, z) + upTo(low.x() - 1, low.y() - 1, z);
    };
    return static_cast<float>((slice(high.z()) - slice(low.z() - 1)) /
                              static_cast<double>((high - low + Size3::Ones()).prod()));
  }

private:
  const PaddedGrid& m_grid;
  std::vector<double> m_sums;
};

/// Chooses for each cell the skip radius r of least cost per mm, in units of a look-up:
/// stepCost / (edge (0.7 + r)) for steps, plus bound_r - mean majorant for null collisions. 0.7
/// edges is the mean chord of a cell; stepCost is the measured cost of a step. The choice changes
/// cost alone, never an expected value.
SkipRadii chooseRadii(const PaddedGrid& grid, const std::vector<float>& majorants,
                      const std::vector<bool>& cut, double edge) {
  constexpr double stepCost = 0.15;
  const BoxSums sums(grid, majorants);
  SkipRadii best{majorants, std::vector<std::uint8_t>(grid.count(), 0)};
  std::vector<float> minCosts(grid.count(), static_cast<float>(stepCost / (edge * 0.7)));
  std::vector<float> bounds(majorants);
  std::vector<float> scratch(grid.count(), 0.0F);
  for (std::size_t i = 0; i < grid.count(); ++i)
    if (cut[i]) // cut cells are never part of another cell's radius
      bounds[i] = std::numeric_limits<float>::infinity();
  // A cell that gains from neither r + 1 nor r + 2 is assumed not to gain from r + 3.
  std::atomic<bool> canGain = true;
  for (std::uint32_t radius = 1; canGain && radius <= SimdMajorants::maxRadius; ++radius) {
    canGain = false;
    dilate(grid, bounds, scratch);
    const auto step = static_cast<float>(stepCost / (edge * (0.7 + radius)));
    grid.forEachInParallel([&](std::size_t i, const Size3& cell) {
      if (majorants[i] == 0.0F || best.radii[i] + 2U < radius)
        return;
      canGain.store(true, std::memory_order_relaxed);
      const float cost = bounds[i] - sums.mean(cell, radius) + step;
      if (cost < minCosts[i]) {
        minCosts[i] = cost;
        best.bound[i] = bounds[i];
        best.radii[i] = static_cast<std::uint8_t>(radius);
      }
    });
  }
  return best;
}

/// Cells of at most this many voxels are merged (measured: looser bounds cost less than more
/// cells).
constexpr std::int64_t maxMergedVoxels = 16;

/// Bits of a majorant > 0, rounded up so that those of the radius are 0.
std::uint32_t encodeMajorant(float majorant) {
  constexpr auto mask = static_cast<std::uint32_t>(SimdMajorants::radiusBits);
  return (std::bit_cast<std::uint32_t>(majorant) + mask) & ~mask;
}

} // namespace

SimdMajorants::SimdMajorants(const MajorantGrid& majorants)
    : merged(majorants.edge().prod() <= maxMergedVoxels ? 2 : 1),
      count((majorants.cellCount().array() + merged - 1) / merged) {
  const PaddedGrid grid{count.array() + 2};
  std::vector<float> bound(grid.count(), 0.0F);
  std::vector<bool> cut(grid.count(), false);
  const Size3& fine = majorants.cellCount();
  std::int64_t next = 0;
  for (std::int64_t z = 0; z < fine.z(); ++z)
    for (std::int64_t y = 0; y < fine.y(); ++y)
      for (std::int64_t x = 0; x < fine.x(); ++x) {
        const MajorantGrid::Cell& cell = majorants.cell(next++);
        const std::size_t i = grid.index({x / merged + 1, y / merged + 1, z / merged + 1});
        bound[i] = std::max(bound[i], cell.majorant);
        cut[i] = cut[i] || cell.isCut;
      }
  const double edge = static_cast<double>(merged) *
                      std::cbrt(std::abs(1.0 / majorants.worldToCell().linear().determinant()));
  const std::vector<std::int32_t> emptyRadii = findEmptyRadii(grid, bound);
  const SkipRadii skip = chooseRadii(grid, bound, cut, edge);
  codes.assign(grid.count(), 0);
  for (std::size_t i = 0; i < grid.count(); ++i) {
    if (bound[i] > 0.0F)
      codes[i] = static_cast<std::int32_t>((cut[i] ? SimdMajorants::cutBit : 0U) |
                                           encodeMajorant(skip.bound[i]) | skip.radii[i]);
    else
      codes[i] = std::min(std::max(emptyRadii[i], 0), radiusBits);
  }
}

} // namespace fenestra::core
