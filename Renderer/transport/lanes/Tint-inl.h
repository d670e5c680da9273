// Colours of segments at points in index space. Compiled once for each instruction set.

#if defined(FENESTRA_LANE_TINT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_LANE_TINT_INL_H
#undef FENESTRA_LANE_TINT_INL_H
#else
#define FENESTRA_LANE_TINT_INL_H
#endif

#include "transport/lanes/Tint.h"
// After foreach_target.h:
#include "transport/lanes/Matter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {

/// TintedField::albedo.
class LaneTint {
public:
  HWY_INLINE LaneTint(const WideTint& tint, Float scalar, const Float3& own)
      : m_tint(tint), m_scalar(scalar), m_own(own) {}

  /// Albedo of the lanes of `which`, whose points are given in the volume's index space.
  HWY_INLINE Float3 at(LaneMask which, const Float3& index) const {
    const Corner corner = cornerAt(mapPoint(m_tint.toShares, index));
    const Int code = gather(m_tint.bricks, corner.brick);
    const LaneMask mixed = which & (code < 0);
    Float3 sum = orZero(which, albedoOf(which.without(mixed), code));
    if (mixed.any())
      sum = select(mixed, mean(mixed, code ^ -1, corner), sum);
    return sum;
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
    const auto along = [&](const WideTint::Axis& axis, Float x, Float& fraction) {
      // This order of min and max maps NaN to 0.
      const Float inside = max(min(x, axis.last), 0.0F);
      const Float cell = min(floor(inside), axis.lastCell);
      const Float brick = floor(cell * (1.0F / Shares::edge));
      fraction = inside - cell;
      corner.brick = corner.brick + wholeToInt(brick) * axis.brick;
      corner.voxel = corner.voxel + wholeToInt(cell - brick * float{Shares::edge}) * stride;
      stride *= edge;
    };
    along(m_tint.axes[0], p.x, corner.fractions.x);
    along(m_tint.axes[1], p.y, corner.fractions.y);
    along(m_tint.axes[2], p.z, corner.fractions.z);
    return corner;
  }

  /// Albedo of one component a lane.
  HWY_INLINE Float3 albedoOf(LaneMask which, Int component) const {
    Float3 albedo = m_own;
    const LaneArray<std::int32_t> each(component);
    for (LaneMask left = which; left.any();) {
      const std::int32_t first = each[static_cast<std::size_t>(std::countr_zero(left.bits()))];
      const LaneMask same = left & (component == first);
      if (const auto& table = m_tint.albedo[static_cast<std::size_t>(first)])
        albedo = select(same, HWY_NAMESPACE::albedoOf(*table, m_scalar), albedo);
      left = left.without(same);
    }
    return albedo;
  }

  /// Mean over the components of mixed bricks; `group`: of the first four.
  HWY_INLINE Float3 mean(LaneMask mixed, Int group, const Corner& corner) const {
    const auto* const memory = reinterpret_cast<const std::int32_t*>(m_tint.groups);
    Float3 sum(0.0F, 0.0F, 0.0F);
    for (LaneMask left = mixed; left.any(); group = group + 1) {
      const Int start = orZero(left, group * words);
      const Int components = loadInts(memory, Indices(start));
      const std::array<Int, 8> voxels = voxelsFrom(memory, start + sharesAt + corner.voxel);
      for (int i = 0; i < static_cast<int>(Shares::inGroup); ++i) {
        const Float share = orZero(left, shareOf(voxels, 8 * i, corner.fractions));
        if ((share > 0.0F).any())
          sum = sum + share * albedoOf(share > 0.0F, shiftRight(components, 8 * i) & 0xff);
      }
      left = left & (loadInts(memory, Indices(start + isLastAt)) == 0);
    }
    return sum;
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
  static HWY_INLINE Float shareOf(const std::array<Int, 8>& voxels, int bit, const Float3& f) {
    const auto value = [&](std::size_t i) { return toFloat(shiftRight(voxels[i], bit) & 0xff); };
    const auto row = [&](std::size_t i) { return lerp(value(i), value(i + 1), f.x); };
    const auto slice = [&](std::size_t i) { return lerp(row(i), row(i + 2), f.y); };
    return lerp(slice(0), slice(4), f.z) * (1.0F / 255.0F);
  }

  const WideTint& m_tint;
  Float m_scalar;
  const Float3& m_own;
};

} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
