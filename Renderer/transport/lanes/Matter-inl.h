// Matter of lanes at points in index space: albedo and gradient. Compiled once for each instruction
// set.

#if defined(FENESTRA_WIDE_MATTER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_WIDE_MATTER_INL_H
#undef FENESTRA_WIDE_MATTER_INL_H
#else
#define FENESTRA_WIDE_MATTER_INL_H
#endif

#include "transport/lanes/PathTables.h"
// After foreach_target.h:
#include "transport/lanes/Medium-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {

HWY_INLINE F3 albedoOf(const WideTable& table, F scalar) {
  const auto& channels = table.channels;
  if (table.position.size() == 3) // one knot
    return {all(channels[0][0].value), all(channels[1][0].value), all(channels[2][0].value)};
  const Segment segment = segmentOf(table, scalar);
  return {valueIn(channels[0], segment), valueIn(channels[1], segment),
          valueIn(channels[2], segment)};
}

/// ContextStyle::paled, outside the focus.
HWY_INLINE F3 paled(const WideScene::Context& context, const F3& index, const F3& albedo) {
  const F grey = dot(albedo, {all(0.2126F), all(0.7152F), all(0.0722F)});
  const auto channel = [&](F x) { return lerp(grey, x, all(context.saturation)); };
  return select(isFocus(context, index), albedo,
                F3{channel(albedo.x), channel(albedo.y), channel(albedo.z)});
}

/// Differences of the scalar over two voxels along each axis.
template <typename Voxel>
HWY_INLINE F3 differenceAt(const WideField& field, const F3& p) {
  const F one = all(1.0F);
  const auto value = [&](F x, F y, F z) { return scalarAt<Voxel>(field, {x, y, z}); };
  return {hn::Sub(value(hn::Add(p.x, one), p.y, p.z), value(hn::Sub(p.x, one), p.y, p.z)),
          hn::Sub(value(p.x, hn::Add(p.y, one), p.z), value(p.x, hn::Sub(p.y, one), p.z)),
          hn::Sub(value(p.x, p.y, hn::Add(p.z, one)), value(p.x, p.y, hn::Sub(p.z, one)))};
}

/// Medium's probability of scattering at a surface; `slope`: length of the gradient.
HWY_INLINE F surfaceChance(const WideScene& volume, const EventScene& scene, F scalar, F slope) {
  const auto missing = [](F x) { return hn::Neg(hn::Expm1(floats, hn::Neg(x))); };
  const F opacity = missing(extinctionOf(volume, scalar));
  return hn::Mul(opacity, missing(hn::Mul(all(scene.surfaceRate), slope)));
}

} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
