// Shares of components at points in index space. Compiled once for each instruction set.

#if defined(FENESTRA_LANE_SHARES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_LANE_SHARES_INL_H
#undef FENESTRA_LANE_SHARES_INL_H
#else
#define FENESTRA_LANE_SHARES_INL_H
#endif

#include "transport/lanes/Shares.h"
// After foreach_target.h:
#include "transport/lanes/Medium-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {

/// Calls visit(lanes, component) for each component that lanes of `which` have: its lanes, and its
/// number, plain.
template <typename Visit>
HWY_INLINE void forEachComponent(LaneMask which, Int components, Visit&& visit) {
  const LaneArray<std::int32_t> each(components);
  for (LaneMask left = which; left.any();) {
    const std::int32_t first = each[static_cast<std::size_t>(std::countr_zero(left.bits()))];
    const LaneMask same = left & (components == first);
    visit(same, static_cast<std::size_t>(first));
    left = left.without(same);
  }
}

/// Shares at the lanes' points (Shares::at).
class LaneShares {
public:
  /// `index`: in the volume's index space.
  HWY_INLINE LaneShares(const WideShares& shares, const Float3& index)
      : m_shares(shares), m_corner(cornerAt(mapPoint(shares.toShares, index))) {}

  /// Calls visit(lanes, components, shares) until all shares of the lanes of `which` have been
  /// given. `lanes`: whose shares are above 0; the shares of others are 0.
  template <typename Visit>
  HWY_INLINE void forEach(LaneMask which, Visit&& visit) const {
    const Int code = gather(m_shares.bricks, m_corner.brick);
    const LaneMask mixed = which & (code < 0);
    const LaneMask pure = which.without(mixed);
    if (pure.any())
      visit(pure, code, orZero(pure, 1.0F));
    if (mixed.any())
      forEachMixed(mixed, code ^ -1, visit);
  }

private:
  /// Lowest voxel of the eight around a point.
  struct Corner {
    Int brick, voxel; ///< number of the brick; and of the voxel in it
    Float3 fractions; ///< position from there, 0 to 1
  };
  static constexpr std::int32_t edge = Shares::edge + 1; ///< voxels
  /// Groups are read as numbers of 32 bits.
  static constexpr std::int32_t words = sizeof(Shares::Group) / sizeof(std::int32_t);
  static constexpr std::int32_t sharesAt = offsetof(Shares::Group, shares) / sizeof(std::int32_t);
  static constexpr std::int32_t isLastAt = offsetof(Shares::Group, isLast) / sizeof(std::int32_t);

  HWY_INLINE Corner cornerAt(const Float3& p) const {
    Corner corner{0, 0, p};
    std::int32_t stride = 1;
    const auto along = [&](const WideShares::Axis& axis, Float x, Float& fraction) {
      // This order of min and max maps NaN to 0.
      const Float inside = max(min(x, axis.last), 0.0F);
      const Float cell = min(floor(inside), axis.lastCell);
      const Float brick = floor(cell * (1.0F / Shares::edge));
      fraction = inside - cell;
      corner.brick = corner.brick + wholeToInt(brick) * axis.brick;
      corner.voxel = corner.voxel + wholeToInt(cell - brick * float{Shares::edge}) * stride;
      stride *= edge;
    };
    along(m_shares.axes[0], p.x, corner.fractions.x);
    along(m_shares.axes[1], p.y, corner.fractions.y);
    along(m_shares.axes[2], p.z, corner.fractions.z);
    return corner;
  }

  /// Shares in mixed bricks; `group`: of the first four.
  template <typename Visit>
  HWY_INLINE void forEachMixed(LaneMask mixed, Int group, Visit&& visit) const {
    const auto* const memory = reinterpret_cast<const std::int32_t*>(m_shares.groups);
    for (LaneMask left = mixed; left.any(); group = group + 1) {
      const Int start = orZero(left, group * words);
      const Int components = loadInts(memory, Indices(start));
      const std::array<Int, 8> voxels = voxelsFrom(memory, start + sharesAt + m_corner.voxel);
      for (int i = 0; i < static_cast<int>(Shares::inGroup); ++i) {
        const Float share = orZero(left, shareOf(voxels, 8 * i));
        if (const LaneMask some = share > 0.0F; some.any())
          visit(some, shiftRight(components, 8 * i) & 0xff, share);
      }
      left = left & (loadInts(memory, Indices(start + isLastAt)) == 0);
    }
  }

  static HWY_INLINE std::array<Int, 8> voxelsFrom(const std::int32_t* memory, Int first) {
    std::array<Int, 8> voxels;
    for (std::int32_t i = 0; i < 8; ++i) {
      const std::int32_t offset = (i & 1) + edge * (i >> 1 & 1) + edge * edge * (i >> 2);
      voxels[static_cast<std::size_t>(i)] = loadInts(memory + offset, Indices(first));
    }
    return voxels;
  }

  /// Share in the eight bits from `bit` on, trilinear.
  HWY_INLINE Float shareOf(const std::array<Int, 8>& voxels, int bit) const {
    const Float3& f = m_corner.fractions;
    const auto value = [&](std::size_t i) { return toFloat(shiftRight(voxels[i], bit) & 0xff); };
    const auto row = [&](std::size_t i) { return lerp(value(i), value(i + 1), f.x); };
    const auto slice = [&](std::size_t i) { return lerp(row(i), row(i + 2), f.y); };
    return lerp(slice(0), slice(4), f.z) * (1.0F / 255.0F);
  }

  const WideShares& m_shares;
  Corner m_corner;
};

} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
