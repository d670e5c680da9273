// What a lane asks of the volume at a point in index space: the extinction, and what clipping keeps
// of it. Compiled once for each instruction set (see WideTracker.cxx).

#if defined(FENESTRA_WIDE_LOOKUP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_WIDE_LOOKUP_INL_H
#undef FENESTRA_WIDE_LOOKUP_INL_H
#else
#define FENESTRA_WIDE_LOOKUP_INL_H
#endif

#include "tracking/WideTracker.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::RebindToSigned<Floats>;
using Bits = hn::RebindToUnsigned<Floats>;
using F = hn::Vec<Floats>;
using I = hn::Vec<Ints>;
using U = hn::Vec<Bits>;
using M = hn::Mask<Floats>;

inline constexpr Floats floats{};
inline constexpr Ints ints{};
inline constexpr Bits bits{};

HWY_INLINE F all(float x) {
  return hn::Set(floats, x);
}
HWY_INLINE F lerp(F a, F b, F f) {
  return hn::MulAdd(hn::Sub(b, a), f, a);
}

struct Point {
  F x, y, z;
};

/// The voxels around a point: four rows along x, `near` where they begin, `far` one voxel on.
struct Corners {
  F near[4], far[4];
};
using Rows = std::array<I, 4>; ///< index of each row's beginning

HWY_INLINE Corners cornersAt(const WideScene& scene, const float* voxels, const Rows& rows) {
  (void)scene;
  Corners c;
  // All rows first: what has to come from afar is then under way together.
  for (std::size_t i = 0; i < rows.size(); ++i)
    c.near[i] = hn::GatherIndex(floats, voxels, rows[i]);
  for (std::size_t i = 0; i < rows.size(); ++i)
    c.far[i] = hn::GatherIndex(floats, voxels + 1, rows[i]);
  return c;
}

/// Of 16 bits: one gather takes both voxels; `lower` and `upper` make floats of them.
template <typename Voxel, typename Lower, typename Upper>
HWY_INLINE Corners cornersInPairs(const Voxel* voxels, const Rows& rows, Lower&& lower,
                                  Upper&& upper) {
  Corners c;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const I both = hn::GatherOffset(ints, reinterpret_cast<const std::int32_t*>(voxels),
                                    hn::ShiftLeft<1>(rows[i]));
    c.near[i] = hn::ConvertTo(floats, lower(both));
    c.far[i] = hn::ConvertTo(floats, upper(both));
  }
  return c;
}
HWY_INLINE Corners cornersAt(const WideScene& scene, const std::int16_t* voxels, const Rows& rows) {
  (void)scene;
  return cornersInPairs(
      voxels, rows, [](I both) { return hn::ShiftRight<16>(hn::ShiftLeft<16>(both)); },
      [](I both) { return hn::ShiftRight<16>(both); });
}
HWY_INLINE Corners cornersAt(const WideScene& scene, const std::uint16_t* voxels,
                             const Rows& rows) {
  (void)scene;
  const I low = hn::Set(ints, 0xffff);
  return cornersInPairs(
      voxels, rows, [&](I both) { return hn::And(both, low); },
      [&](I both) { return hn::And(hn::ShiftRight<16>(both), low); });
}
HWY_INLINE Corners cornersAt(const WideScene& scene, const std::uint8_t* voxels, const Rows& rows) {
  Corners c;
  const I low = hn::Set(ints, 0xff);
  const I lastFour = hn::Set(ints, static_cast<std::int32_t>(scene.voxelCount - 4));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    // Four bytes are read: not beyond the last voxel.
    const I from = hn::Min(rows[i], lastFour);
    const I shift = hn::ShiftLeft<3>(hn::Sub(rows[i], from));
    const I four = hn::GatherOffset(ints, reinterpret_cast<const std::int32_t*>(voxels), from);
    const I both = hn::Shr(four, shift);
    c.near[i] = hn::ConvertTo(floats, hn::And(both, low));
    c.far[i] = hn::ConvertTo(floats, hn::And(hn::ShiftRight<8>(both), low));
  }
  return c;
}

/// The scalar, trilinear between voxel centres and clamped in the outer half voxel.
template <typename Voxel>
HWY_INLINE F scalarAt(const WideScene& scene, const Point& p) {
  const auto* voxels = static_cast<const Voxel*>(scene.voxels);
  const auto cell = [&](std::size_t axis, F x, F& fraction) {
    const WideScene::Axis& a = scene.axes[axis];
    // In this order a NaN becomes 0.
    const F inside = hn::Max(hn::Min(x, all(a.last)), hn::Zero(floats));
    const I index = hn::Min(hn::ConvertTo(ints, inside), hn::Set(ints, a.lastCell));
    fraction = hn::Sub(inside, hn::ConvertTo(floats, index));
    return index;
  };
  F fx, fy, fz;
  const I ix = cell(0, p.x, fx);
  const I iy = cell(1, p.y, fy);
  const I iz = cell(2, p.z, fz);
  const I up = hn::Set(ints, scene.axes[1].stride);
  const I deep = hn::Set(ints, scene.axes[2].stride);
  const I at = hn::Add(ix, hn::Add(hn::Mul(iy, up), hn::Mul(iz, deep)));
  const I above = hn::Add(at, deep);
  const Corners c = cornersAt(scene, voxels, Rows{at, hn::Add(at, up), above, hn::Add(above, up)});
  const F low = lerp(lerp(c.near[0], c.far[0], fx), lerp(c.near[1], c.far[1], fx), fy);
  const F high = lerp(lerp(c.near[2], c.far[2], fx), lerp(c.near[3], c.far[3], fx), fy);
  return lerp(low, high, fz);
}

/// Extinction (mm^-1) of a scalar.
HWY_INLINE F extinctionOf(const WideScene& scene, F s) {
  const auto lastBin = static_cast<float>(scene.binSegment.size() - 1);
  const F bin = hn::Mul(hn::Sub(s, all(scene.binStart)), all(scene.binsPerUnit));
  const I inTable = hn::ConvertTo(ints, hn::Max(hn::Min(bin, all(lastBin)), hn::Zero(floats)));
  I segment = hn::GatherIndex(ints, scene.binSegment.data(), inTable);
  const float* next = scene.position.data() + 1;
  for (;;) {
    const M beyond = hn::Ge(s, hn::GatherIndex(floats, next, segment));
    if (hn::AllFalse(floats, beyond))
      break;
    segment =
        hn::IfThenElse(hn::RebindMask(ints, beyond), hn::Add(segment, hn::Set(ints, 1)), segment);
  }
  const F slope = hn::GatherIndex(floats, scene.slope.data(), segment);
  const F value = hn::GatherIndex(floats, scene.value.data(), segment);
  const F from = hn::GatherIndex(floats, scene.position.data(), segment);
  // Constant segments may begin at -infinity.
  const F rise =
      hn::IfThenZeroElse(hn::Eq(slope, hn::Zero(floats)), hn::Mul(hn::Sub(s, from), slope));
  return hn::Max(hn::Add(value, rise), hn::Zero(floats));
}

HWY_INLINE F apply(const std::array<float, 4>& row, const Point& p) {
  return hn::MulAdd(all(row[0]), p.x,
                    hn::MulAdd(all(row[1]), p.y, hn::MulAdd(all(row[2]), p.z, all(row[3]))));
}

/// Continuous index of a coordinate in mm among a depth buffer's samples (DepthAxis::index).
HWY_INLINE F depthIndex(const WideScene::DepthAxis& axis, F coordinate) {
  const F pixel = hn::MulSub(coordinate, all(axis.perPitch), all(axis.start));
  const F fine = hn::Max(hn::Min(pixel, all(axis.lastInside)), hn::Zero(floats));
  const F index =
      hn::MulAdd(hn::Sub(pixel, fine), all(axis.perFactor), hn::Add(fine, all(axis.before)));
  return hn::Max(hn::Min(index, all(axis.last)), hn::Zero(floats));
}

/// Where clipping removes nothing (clipping/Clip.h's keep, for all its kinds).
inline M kept(const WideScene& scene, const Point& p) {
  const F depth = apply(scene.toView[2], p); // from the target
  F scale = all(1.0F);
  M before = hn::Lt(depth, depth); // the eye: none
  if (scene.perspective) {
    const F fromEye = hn::Add(depth, all(scene.targetDepth));
    before = hn::Le(fromEye, hn::Zero(floats));
    scale = hn::Div(all(scene.targetDepth), fromEye);
  }
  if (scene.clipKind == WideScene::ClipKind::plane)
    return hn::Not(hn::Or(before, hn::Gt(apply(scene.toPlane, p), hn::Zero(floats))));
  const F column = depthIndex(scene.depthX, hn::Mul(apply(scene.toView[0], p), scale));
  const F row = depthIndex(scene.depthY, hn::Mul(apply(scene.toView[1], p), scale));
  const I columns = hn::Set(ints, scene.depthColumns);
  F surface;
  if (scene.clipKind == WideScene::ClipKind::depthNearest) {
    const I c = hn::ConvertTo(ints, hn::Add(column, all(0.5F)));
    const I r = hn::ConvertTo(ints, hn::Add(row, all(0.5F)));
    surface = hn::GatherIndex(floats, scene.depths, hn::Add(hn::Mul(r, columns), c));
  } else {
    const I one = hn::Set(ints, 1);
    const I c0 = hn::ConvertTo(ints, column);
    const I r0 = hn::ConvertTo(ints, row);
    const I c1 = hn::Min(hn::Add(c0, one), hn::ConvertTo(ints, all(scene.depthX.last)));
    const I r1 = hn::Min(hn::Add(r0, one), hn::ConvertTo(ints, all(scene.depthY.last)));
    const F fc = hn::Sub(column, hn::ConvertTo(floats, c0));
    const F fr = hn::Sub(row, hn::ConvertTo(floats, r0));
    const auto at = [&](I c, I r) {
      return hn::GatherIndex(floats, scene.depths, hn::Add(hn::Mul(r, columns), c));
    };
    surface = lerp(lerp(at(c0, r0), at(c1, r0), fc), lerp(at(c0, r1), at(c1, r1), fc), fr);
  }
  return hn::Not(hn::Or(before, hn::Lt(depth, surface)));
}

} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
