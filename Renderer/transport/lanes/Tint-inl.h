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
#include "transport/lanes/Shares-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {

/// TintedField::albedo for the lanes of `which`, 0 in others; `own`: of the transfer function.
HWY_INLINE Float3 tintedAlbedo(const WideTint& tint, LaneMask which, const Float3& index,
                               Float scalar, const Float3& own) {
  Float3 sum(0.0F, 0.0F, 0.0F);
  LaneShares(tint.shares, index).forEach(which, [&](LaneMask lanes, Int components, Float share) {
    Float3 albedo = own;
    forEachComponent(lanes, components, [&](LaneMask same, std::size_t component) {
      if (const auto& table = tint.albedo[component])
        albedo = select(same, albedoOf(*table, scalar), albedo);
    });
    sum = sum + share * albedo;
  });
  return sum;
}

} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
