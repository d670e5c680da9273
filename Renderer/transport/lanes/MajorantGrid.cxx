#include "transport/lanes/MajorantGrid.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <bit>

namespace fenestra {
namespace {

/// Array of cells with a border one cell wide.
struct Bordered {
  Size3 size;

  std::size_t count() const { return static_cast<std::size_t>(size.prod()); }
  std::size_t index(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return static_cast<std::size_t>(x + size.x() * (y + size.y() * z));
  }
  /// Calls visit(x, y, z) for all cells of a layer inside the border.
  template <typename Visit>
  void forEachInLayer(std::int64_t z, Visit&& visit) const {
    for (std::int64_t y = 1; y < size.y() - 1; ++y)
      for (std::int64_t x = 1; x < size.x() - 1; ++x)
        visit(x, y, z);
  }
  /// Visits inner cells in the order of their indices.
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

/// Number of empty cells around each empty cell inside the border, -1 for filled cells: two sweeps
/// (Rosenfeld and Pfaltz 1966), exact for distances that count diagonals as 1. Nothing beyond the
/// border counts as empty.
std::vector<std::int32_t> emptyAround(const Bordered& at, const std::vector<float>& majorants) {
  constexpr std::int32_t unknown = 1000000;
  std::vector<std::int32_t> cells(at.count(), 0);
  at.forEachInner([&](auto x, auto y, auto z) {
    cells[at.index(x, y, z)] = majorants[at.index(x, y, z)] > 0.0F ? -1 : unknown;
  });
  // `side`: -1 for neighbours visited earlier in the first sweep, 1 in the second.
  const auto relax = [&](std::int64_t x, std::int64_t y, std::int64_t z, std::int64_t side) {
    std::int32_t& cell = cells[at.index(x, y, z)];
    if (cell < 0)
      return;
    // A filled neighbour (-1) allows 0; an empty neighbour with n around allows n + 1.
    const auto neighbour = [&](std::int64_t dx, std::int64_t dy, std::int64_t dz) {
      cell = std::min(cell, cells[at.index(x + dx, y + dy, z + dz)] + 1);
    };
    for (std::int64_t dy = -1; dy <= 1; ++dy)
      for (std::int64_t dx = -1; dx <= 1; ++dx)
        neighbour(dx, dy, side);
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      neighbour(dx, side, 0);
    neighbour(side, 0, 0);
  };
  at.forEachInner([&](auto x, auto y, auto z) { relax(x, y, z, -1); });
  at.forEachInner([&](auto x, auto y, auto z) {
    relax(at.size.x() - 1 - x, at.size.y() - 1 - y, at.size.z() - 1 - z, 1);
  });
  return cells;
}

/// Replaces each cell inside the border by the maximum of the 27 cells centred there.
void dilate(const Bordered& at, std::vector<float>& cells, std::vector<float>& room) {
  for (const std::size_t stride : {at.index(1, 0, 0), at.index(0, 1, 0), at.index(0, 0, 1)}) {
    at.forEachInParallel([&](auto x, auto y, auto z) {
      const std::size_t i = at.index(x, y, z);
      room[i] = std::max({cells[i - stride], cells[i], cells[i + stride]});
    });
    cells.swap(room);
  }
}

/// Reach of each cell, and the bound that holds within the reach.
struct Reach {
  std::vector<float> bound;
  std::vector<std::uint8_t> cells;
};

/// Sums over boxes of cells.
class BoxSums {
public:
  BoxSums(const Bordered& at, const std::vector<float>& cells) : m_at(at), m_sums(cells.size()) {
    for (std::size_t i = 0; i < cells.size(); ++i)
      m_sums[i] = static_cast<double>(cells[i]);
    for (const std::size_t stride : {at.index(1, 0, 0), at.index(0, 1, 0), at.index(0, 0, 1)})
      at.forEachInner([&](auto x, auto y, auto z) {
        const std::size_t i = at.index(x, y, z);
        m_sums[i] += m_sums[i - stride];
      });
  }

  /// Mean over the inner cells at most `reach` away from (x, y, z).
  float mean(std::int64_t x, std::int64_t y, std::int64_t z, std::int64_t reach) const {
    const Size3 low = (Size3(x, y, z).array() - reach).max(1);
    const Size3 high = (Size3(x, y, z).array() + reach).min(m_at.size.array() - 2);
    const auto upTo = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
      return m_sums[m_at.index(i, j, k)];
    };
    const auto slice = [&](std::int64_t k) {
      return upTo(high.x(), high.y(), k) - upTo(low.x() - 1, high.y(), k) -
             upTo(high.x(), low.y() - 1, k) + upTo(low.x() - 1, low.y() - 1, k);
    };
    return static_cast<float>((slice(high.z()) - slice(low.z() - 1)) /
                              static_cast<double>((high - low + Size3::Ones()).prod()));
  }

private:
  const Bordered& m_at;
  std::vector<double> m_sums;
};

/// Chooses per cell the reach r of least cost per mm, in look-ups: stepCost / (edge (0.7 + r)) for
/// steps, plus bound_r - mean majorant for null collisions. 0.7 edges: mean chord of a cell.
/// stepCost: cost of a step relative to a look-up (measured; changes no expectation).
Reach findReach(const Bordered& at, const std::vector<float>& majorants,
                const std::vector<bool>& cut, double edge) {
  constexpr double stepCost = 0.15;
  const BoxSums sums(at, majorants);
  Reach best{majorants, std::vector<std::uint8_t>(at.count(), 0)};
  std::vector<float> least(at.count(), static_cast<float>(stepCost / (edge * 0.7)));
  std::vector<float> bounds(majorants);
  std::vector<float> room(at.count(), 0.0F);
  for (std::size_t i = 0; i < at.count(); ++i)
    if (cut[i]) // cut cells are walked alone
      bounds[i] = std::numeric_limits<float>::infinity();
  // A cell that gains by neither r + 1 nor r + 2 is assumed not to gain by r + 3.
  std::atomic<bool> some = true;
  for (std::uint32_t reach = 1; some && reach <= WideCells::mostReach; ++reach) {
    some = false;
    dilate(at, bounds, room);
    const auto step = static_cast<float>(stepCost / (edge * (0.7 + reach)));
    at.forEachInParallel([&](auto x, auto y, auto z) {
      const std::size_t i = at.index(x, y, z);
      if (majorants[i] == 0.0F || best.cells[i] + 2U < reach)
        return;
      some.store(true, std::memory_order_relaxed);
      const float here = bounds[i] - sums.mean(x, y, z, reach) + step;
      if (here < least[i]) {
        least[i] = here;
        best.bound[i] = bounds[i];
        best.cells[i] = static_cast<std::uint8_t>(reach);
      }
    });
  }
  return best;
}

constexpr std::uint32_t cutBit = 1U << 31;

/// Cells of this many voxels at most are merged (measured: looser bounds cost less than more
/// cells).
constexpr std::int64_t mostMergedVoxels = 16;

/// Code of a bound >= majorant, which is not 0.
std::uint32_t majorantCode(float majorant) {
  constexpr auto below = static_cast<std::uint32_t>(WideCells::reachBits);
  return (std::bit_cast<std::uint32_t>(majorant) + below) & ~below;
}

} // namespace

WideCells::WideCells(const MajorantGrid& majorants)
    : merged(majorants.edge().prod() <= mostMergedVoxels ? 2 : 1),
      count((majorants.cellCount().array() + merged - 1) / merged) {
  const Bordered at{count.array() + 2};
  std::vector<float> bound(at.count(), 0.0F);
  std::vector<bool> cut(at.count(), false);
  const Size3& fine = majorants.cellCount();
  std::int64_t next = 0;
  for (std::int64_t z = 0; z < fine.z(); ++z)
    for (std::int64_t y = 0; y < fine.y(); ++y)
      for (std::int64_t x = 0; x < fine.x(); ++x) {
        const MajorantGrid::Cell& cell = majorants.cell(next++);
        const std::size_t i = at.index(x / merged + 1, y / merged + 1, z / merged + 1);
        bound[i] = std::max(bound[i], cell.majorant);
        cut[i] = cut[i] || cell.cut;
      }
  const double edge = static_cast<double>(merged) *
                      std::cbrt(std::abs(1.0 / majorants.worldToCell().linear().determinant()));
  const std::vector<std::int32_t> around = emptyAround(at, bound);
  const Reach reach = findReach(at, bound, cut, edge);
  codes.assign(at.count(), 0);
  for (std::size_t i = 0; i < at.count(); ++i) {
    if (bound[i] > 0.0F)
      codes[i] = static_cast<std::int32_t>((cut[i] ? cutBit : 0U) | majorantCode(reach.bound[i]) |
                                           reach.cells[i]);
    else
      codes[i] = std::min(std::max(around[i], 0), reachBits);
  }
}

WideCells::Cell WideCells::cell(std::size_t place) const {
  const std::int32_t code = codes[place];
  return {std::bit_cast<float>(code & majorantBits), static_cast<std::uint32_t>(code & reachBits),
          code < 0};
}

} // namespace fenestra
