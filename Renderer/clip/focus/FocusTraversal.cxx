// FocusCells::findHits and findHitsAndMaxima with SIMD. Each lane traces one ray through the cells
// with a DDA (Amanatides and Woo 1987) that skips empty blocks. Lanes are double, so that hits are
// as exact as those of scalar code.

#include "base/SimdTargets.h"
#include "clip/focus/CellCubic.h"
#include "clip/focus/FocusCells.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "clip/focus/FocusTraversal.cxx"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include "clip/focus/FocusAxis-inl.h"

#include <bit>
HWY_BEFORE_NAMESPACE();
namespace fenestra::core::HWY_NAMESPACE {
namespace {

constexpr std::size_t maxLanes = HWY_MAX_BYTES / sizeof(double);
struct alignas(64) LaneDoubles : std::array<double, maxLanes> {};

HWY_INLINE unsigned maskBits(M mask) {
  std::array<std::uint8_t, 8> packed = {};
  hn::StoreMaskBits(doubles, mask, packed.data());
  return packed[0];
}

/// Collects cubics over ray segments that rise from < 0 to >= 0, and solves them in SIMD batches.
class RootSolver {
public:
  void add(const scalar::Cubic& cubic, double begin, double length, std::size_t ray) {
    m_c[0][m_size] = cubic.c0;
    m_c[1][m_size] = cubic.c1;
    m_c[2][m_size] = cubic.c2;
    m_c[3][m_size] = cubic.c3;
    m_begin[m_size] = begin;
    m_length[m_size] = length;
    m_ray[m_size] = ray;
    ++m_size;
  }

  /// Sets rays.hitT from the roots, found like findRoot(cubic, 0, 1).
  void solveAll(FocusRays& rays) {
    for (std::size_t i = m_size; i % hn::Lanes(doubles) != 0; ++i)
      for (Column* column : {&m_c[0], &m_c[1], &m_c[2], &m_c[3], &m_begin, &m_length})
        (*column)[i] = 0.0; // full vectors are loaded
    for (std::size_t i = 0; i < m_size; i += hn::Lanes(doubles)) {
      const D s = findRoots(i);
      LaneDoubles hits;
      hn::Store(hn::MulAdd(s, hn::Load(doubles, &m_length[i]), hn::Load(doubles, &m_begin[i])),
                doubles, hits.data());
      for (std::size_t lane = 0; lane < std::min(hn::Lanes(doubles), m_size - i); ++lane)
        rays.hitT[m_ray[i + lane]] = hits[lane];
    }
  }

private:
  HWY_INLINE D findRoots(std::size_t i) const {
    const D c0 = hn::Load(doubles, &m_c[0][i]), c1 = hn::Load(doubles, &m_c[1][i]);
    const D c2 = hn::Load(doubles, &m_c[2][i]), c3 = hn::Load(doubles, &m_c[3][i]);
    const auto at = [&](D s) {
      return hn::MulAdd(hn::MulAdd(hn::MulAdd(c3, s, c2), s, c1), s, c0);
    };
    const auto slope = [&](D s) {
      return hn::MulAdd(hn::MulAdd(hn::Mul(set(3.0), c3), s, hn::Mul(set(2.0), c2)), s, c1);
    };
    const D rounding = set(1e-15);
    D low = hn::Zero(doubles), high = set(1.0);
    D s = hn::Div(c0, hn::Sub(c0, at(high)));
    M open = hn::FirstN(doubles, m_size - i);
    for (int step = 0; step < 100; ++step) {
      const D value = at(s);
      const M below = hn::Lt(value, hn::Zero(doubles));
      low = hn::IfThenElse(below, s, low);
      high = hn::IfThenElse(below, high, s);
      const D newton = hn::Sub(s, hn::Div(value, slope(s)));
      const M settled = hn::Or(hn::Le(hn::Sub(high, low), rounding),
                               hn::Le(hn::Abs(hn::Sub(newton, s)), rounding));
      open = hn::AndNot(settled, open); // NaN never settles
      if (hn::AllFalse(doubles, open))
        break;
      const M inside = hn::And(hn::Gt(newton, low), hn::Lt(newton, high));
      const D next = hn::IfThenElse(inside, newton, hn::Mul(set(0.5), hn::Add(low, high)));
      s = hn::IfThenElse(open, next, s);
    }
    return s;
  }

  using Column = FocusRays::SoaArray;
  std::size_t m_size = 0;
  alignas(64) std::array<Column, 4> m_c;
  alignas(64) Column m_begin, m_length;
  std::array<std::size_t, FocusRays::capacity> m_ray;
};

/// Values (indicator units) and positions (mm) that differ by less are equal. Along a flat face the
/// indicator is a plateau, and the ray maximum is where the plateau begins.
constexpr double plateauTolerance = 1e-8;

/// Points less than this below a maximum, in indicator units, belong to the same ridge, which
/// occludes what is behind (FocusCells::replaceRatio). Needed for a face seen edge-on: its distance
/// from the ray varies slightly along the ray.
constexpr double ridgeTolerance = 1e-4;

/// Traversal of rays i, i + 1, …, one per lane.
template <bool withMaxima>
class Traversal {
public:
  Traversal(const FocusCells::Layout& cells, FocusRays& rays, RootSolver& roots, std::size_t i)
      : m_cells(cells),
        m_rays(rays),
        m_solver(roots),
        m_first(i),
        m_t(hn::Load(doubles, &rays.begin[i])),
        m_end(hn::Load(doubles, &rays.end[i])),
        m_busy(
            hn::And(hn::FirstN(doubles, rays.size - std::min(i, rays.size)), hn::Lt(m_t, m_end))),
        m_axes{axis(0), axis(1), axis(2)} {
    m_maxima.fill(FocusCells::captureThreshold - 0.5);
    m_maximaT.fill(-infinity);
    m_ridgeEnds.fill(-infinity);
  }

  /// Writes the maxima to the rays. To be called when no lane is busy.
  void finish() {
    for (std::size_t i = m_first;
         withMaxima && i < std::min(m_first + hn::Lanes(doubles), m_rays.size); ++i) {
      m_rays.maximumT[i] = m_maximaT[i - m_first];
      m_rays.maximum[i] = 0.5 + m_maxima[i - m_first];
    }
  }

  bool isBusy() const { return !hn::AllFalse(doubles, m_busy); }

  FocusAxis axis(std::size_t a) const {
    return {hn::Load(doubles, &m_rays.origin[a][m_first]),
            hn::Load(doubles, &m_rays.direction[a][m_first]), m_t,
            m_cells.blockCount[static_cast<int>(a)]};
  }

  /// Steps into the next cell or block.
  HWY_INLINE void step() {
    const I x = hn::DemoteTo(ints, m_axes[0].cellIndex());
    const I y = hn::DemoteTo(ints, m_axes[1].cellIndex());
    const I z = hn::DemoteTo(ints, m_axes[2].cellIndex());
    const auto linear = [](I a, I b, I c, std::int64_t countA, std::int64_t countB) {
      return hn::Add(a, hn::Mul(setInts(countA), hn::Add(b, hn::Mul(setInts(countB), c))));
    };
    const I block =
        hn::GatherIndex(ints, m_cells.blocks,
                        linear(hn::ShiftRight<2>(x), hn::ShiftRight<2>(y), hn::ShiftRight<2>(z),
                               m_cells.blockCount.x(), m_cells.blockCount.y()));
    const M isOccupied = isNonZero(block);
    const M isEmpty = hn::Not(isOccupied);
    const D toX = m_axes[0].findFace(isEmpty);
    const D toY = m_axes[1].findFace(isEmpty);
    const D toZ = m_axes[2].findFace(isEmpty);
    const D out = hn::Min(hn::Min(toX, toY), toZ);
    const D exit = hn::Min(m_end, hn::Max(m_t, out));

    if (const M candidates = hn::And(isOccupied, m_busy); !hn::AllFalse(doubles, candidates)) {
      const I three = setInts(3);
      const I cell = linear(hn::And(x, three), hn::And(y, three), hn::And(z, three), 4, 4);
      const I at = hn::Add(hn::ShiftLeft<6>(block), cell); // 64 cells per block
      const I corners = hn::And(
          hn::GatherOffset(ints, reinterpret_cast<const std::int32_t*>(m_cells.corners), at),
          setInts(0xff));
      if (const M occupied = hn::And(candidates, isNonZero(corners));
          !hn::AllFalse(doubles, occupied))
        intersect(occupied, corners,
                  // BlockValues: 128 bytes per block, 5 values per row.
                  hn::Add(hn::ShiftLeft<7>(block),
                          linear(hn::And(x, three), hn::And(y, three), hn::And(z, three), 5, 5)),
                  exit);
    }

    m_busy = hn::And(m_busy, hn::Lt(out, m_end));
    const M throughX = hn::Eq(toX, out);
    const M throughY = hn::AndNot(throughX, hn::Eq(toY, out));
    const M throughZ = hn::Not(hn::Or(throughX, throughY));
    m_axes[0].advance(m_busy, throughX, exit);
    m_axes[1].advance(m_busy, throughY, exit);
    m_axes[2].advance(m_busy, throughZ, exit);
    m_t = exit;
  }

private:
  /// Intersects the rays of `which` with the surface in their current cells and stops those that
  /// hit it. The Bernstein coefficients (c0, b1, b2, b3) bound a cubic: it is solved only if one is
  /// >= 0, or near the maximum so far. `values`: index of a cell's first value.
  HWY_INLINE void intersect(M which, I corners, I values, D exit) {
    const std::array<D, 8> v = m_cells.values ? smoothCorners(values) : binaryCorners(corners);
    const D length = hn::Sub(exit, m_t);
    const D x = m_axes[0].fraction(m_t), u = m_axes[0].displacement(length);
    const D y = m_axes[1].fraction(m_t), w = m_axes[1].displacement(length);
    const D z = m_axes[2].fraction(m_t), q = m_axes[2].displacement(length);

    // The indicator is a + x bx + y by + z bz + x y cxy + x z cxz + y z cyz + x y z d, and along
    // the ray x becomes x + s u, y + s w, z + s q with s in [0, 1].
    const D bx = hn::Sub(v[1], v[0]), by = hn::Sub(v[2], v[0]), bz = hn::Sub(v[4], v[0]);
    const D cxy = hn::Sub(hn::Sub(v[3], v[2]), bx);
    const D cxz = hn::Sub(hn::Sub(v[5], v[4]), bx);
    const D cyz = hn::Sub(hn::Sub(v[6], v[4]), by);
    const D d = hn::Sub(hn::Add(hn::Sub(hn::Sub(v[7], v[6]), v[5]), v[4]), cxy);
    const auto sum = [](auto... terms) {
      D total = hn::Zero(doubles);
      ((total = hn::Add(total, terms)), ...);
      return total;
    };
    const auto times = [](D a, auto... factors) {
      ((a = hn::Mul(a, factors)), ...);
      return a;
    };
    const D c0 = sum(v[0], times(bx, x), times(by, y), times(bz, z), times(cxy, x, y),
                     times(cxz, x, z), times(cyz, y, z), times(d, x, y, z));
    const D c1 =
        sum(times(bx, u), times(by, w), times(bz, q), times(cxy, sum(times(x, w), times(y, u))),
            times(cxz, sum(times(x, q), times(z, u))), times(cyz, sum(times(y, q), times(z, w))),
            times(d, sum(times(x, y, q), times(x, w, z), times(u, y, z))));
    const D c2 = sum(times(cxy, u, w), times(cxz, u, q), times(cyz, w, q),
                     times(d, sum(times(x, w, q), times(u, y, q), times(u, w, z))));
    const D c3 = times(d, u, w, q);

    const D third = set(1.0 / 3.0);
    const D b1 = hn::Add(c0, hn::Mul(c1, third));
    const D b2 = hn::Add(b1, hn::Mul(hn::Add(c1, c2), third));
    const D b3 = sum(c0, c1, c2, c3);
    const D greatest = hn::Max(hn::Max(c0, b1), hn::Max(b2, b3));
    D least = set(-1e-12); // tolerance for rounding
    if constexpr (withMaxima)
      least = hn::Min(least, hn::Sub(hn::Load(doubles, m_maxima.data()), set(ridgeTolerance)));
    const M possible = hn::And(which, hn::Ge(greatest, least));
    if (hn::AllFalse(doubles, possible))
      return;
    const M rises = hn::And(hn::And(hn::Lt(c0, hn::Zero(doubles)), hn::Ge(b3, hn::Zero(doubles))),
                            hn::And(hn::And(hn::Le(c0, b1), hn::Le(b1, b2)), hn::Le(b2, b3)));
    solve(possible, {c0, c1, c2, c3}, rises, length);
  }

  /// Indicator - 1/2 at the corners of cells, x fastest.
  HWY_INLINE static std::array<D, 8> binaryCorners(I corners) {
    const auto value = [&](std::int32_t i) {
      const I bit = hn::And(corners, setInts(1 << i));
      return hn::IfThenElse(isNonZero(bit), set(0.5), set(-0.5));
    };
    return {value(0), value(1), value(2), value(3), value(4), value(5), value(6), value(7)};
  }
  HWY_INLINE std::array<D, 8> smoothCorners(I first) const {
    const auto value = [&](I byte) {
      const D number = hn::PromoteTo(doubles, hn::And(byte, setInts(0xff)));
      return hn::MulSub(number, set(m_cells.valueScale), set(0.5));
    };
    std::array<D, 8> v;
    std::size_t i = 0;
    // Rows (y, z) of the 5 x 5 x 5 values of a block; two neighbors along x per gather.
    for (const std::int32_t row : {0, 5, 25, 30}) {
      const I both = hn::GatherOffset(ints, reinterpret_cast<const std::int32_t*>(m_cells.values),
                                      hn::Add(first, setInts(row)));
      v[i++] = value(both);
      v[i++] = value(hn::ShiftRight<8>(both));
    }
    return v;
  }

  /// Searches the cubics of `which` one by one, except those of `rises`: they have exactly one
  /// root, and m_solver solves them later in batches.
  HWY_INLINE void solve(M which, const std::array<D, 4>& c, M rises, D length) {
    alignas(64) std::array<LaneDoubles, 4> coefficients;
    alignas(64) LaneDoubles begins, lengths, busy; // of segments in their cells; busy: 1 or 0
    for (std::size_t i = 0; i < 4; ++i)
      hn::Store(c[i], doubles, coefficients[i].data());
    hn::Store(m_t, doubles, begins.data());
    hn::Store(length, doubles, lengths.data());
    hn::Store(hn::IfThenElseZero(m_busy, set(1.0)), doubles, busy.data());
    const unsigned pending = maskBits(which);
    const unsigned rising = maskBits(rises);
    for (unsigned left = pending; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      const scalar::Cubic cubic{coefficients[0][lane], coefficients[1][lane], coefficients[2][lane],
                                coefficients[3][lane]};
      const bool isRising = rising >> lane & 1;
      const double s = isRising ? 0.0 : scalar::findFirstNonNegative(cubic, scalar::rootRounding);
      if (s == infinity) {
        if constexpr (withMaxima)
          updateMaximum(lane, cubic, begins[lane], lengths[lane]);
        continue;
      }
      busy[lane] = 0.0;
      if (isRising)
        m_solver.add(cubic, begins[lane], lengths[lane], m_first + lane);
      else
        m_rays.hitT[m_first + lane] = begins[lane] + s * lengths[lane];
    }
    m_busy = hn::Gt(hn::Load(doubles, busy.data()), hn::Zero(doubles));
  }

  /// Updates the ray maximum in a cell without a hit.
  void updateMaximum(std::size_t lane, const scalar::Cubic& cubic, double begin, double length) {
    const scalar::TurningPoints turns = scalar::findTurningPoints(cubic);
    bool isOnRidge = begin - m_ridgeEnds[lane] < plateauTolerance;
    for (const double s :
         {0.0, turns.first, turns.second, 1.0}) { // the cubic is monotonic in between
      const double height = scalar::evalCubic(cubic, s);
      if (isOnRidge ? isHigher(lane, height) : isNewMaximum(lane, height)) {
        m_maxima[lane] = height;
        m_maximaT[lane] = begin + s * length;
        isOnRidge = true;
      }
      isOnRidge = isOnRidge && height >= m_maxima[lane] - ridgeTolerance;
      if (isOnRidge)
        m_ridgeEnds[lane] = begin + s * length;
    }
  }

  /// True if a value on the same ridge replaces the maximum so far. `height`: indicator - 1/2, < 0.
  bool isHigher(std::size_t lane, double height) const {
    const double least = std::min(ridgeTolerance, -height / FocusCells::replaceRatio);
    return height > m_maxima[lane] + std::max(plateauTolerance, least);
  }

  /// True if a later local maximum replaces the maximum so far (FocusCells::findHitsAndMaxima).
  bool isNewMaximum(std::size_t lane, double height) const {
    return m_maximaT[lane] == -infinity ? height > m_maxima[lane] + plateauTolerance
                                        : height > FocusCells::replaceRatio * m_maxima[lane];
  }

  const FocusCells::Layout& m_cells;
  FocusRays& m_rays;
  RootSolver& m_solver;
  std::size_t m_first;
  D m_t, m_end;
  M m_busy;
  std::array<FocusAxis, 3> m_axes;
  LaneDoubles m_maxima, m_maximaT; ///< so far: indicator - 1/2, and t
  LaneDoubles m_ridgeEnds;         ///< t at which the ridge of the maximum ends
};

template <bool withMaxima>
void traverseAll(const FocusCells::Layout& cells, FocusRays& rays) {
  RootSolver roots;
  const std::size_t lanes = hn::Lanes(doubles);
  for (std::size_t i = 0; i < rays.size; i += 2 * lanes) {
    // Two traversals alternate, to hide the latency of their memory accesses.
    Traversal<withMaxima> one(cells, rays, roots, i);
    if (i + lanes < rays.size) {
      Traversal<withMaxima> other(cells, rays, roots, i + lanes);
      while (one.isBusy() || other.isBusy()) {
        one.step();
        other.step();
      }
      other.finish();
    }
    while (one.isBusy())
      one.step();
    one.finish();
  }
  roots.solveAll(rays);
}

void findAllHits(const FocusCells::Layout& cells, FocusRays& rays) {
  traverseAll<false>(cells, rays);
}
void findAllHitsAndMaxima(const FocusCells::Layout& cells, FocusRays& rays) {
  traverseAll<true>(cells, rays);
}

} // namespace
} // namespace fenestra::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fenestra::core {

HWY_EXPORT(findAllHits);
HWY_EXPORT(findAllHitsAndMaxima);

namespace {

/// Sets all hits to infinity, and pads the rays with finite values for full-vector loads.
void initialize(FocusRays& rays) {
  std::fill_n(rays.hitT.begin(), rays.size, infinity);
  for (std::size_t i = rays.size; i < std::min(rays.size + 16, rays.begin.size()); ++i) {
    for (FocusRays::SoaArray* column :
         {&rays.origin[0], &rays.origin[1], &rays.origin[2], &rays.begin, &rays.end})
      (*column)[i] = 0.0;
    for (FocusRays::SoaArray& column : rays.direction)
      column[i] = 1.0;
  }
}

} // namespace

void FocusCells::findHits(FocusRays& rays) const {
  initialize(rays);
  const Layout cells = layout();
  HWY_DYNAMIC_DISPATCH(findAllHits)(cells, rays);
}

void FocusCells::findHitsAndMaxima(FocusRays& rays) const {
  initialize(rays);
  const Layout cells = layout();
  HWY_DYNAMIC_DISPATCH(findAllHitsAndMaxima)(cells, rays);
}

} // namespace fenestra::core
#endif
