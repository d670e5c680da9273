// Clip of lanes at points in index space: keep, and the gradient of a soft cut (clip/keep/Clip.h).
// Compiled once for each instruction set (see Tracker.cxx).

#if defined(FENESTRA_WIDE_CLIP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_WIDE_CLIP_INL_H
#undef FENESTRA_WIDE_CLIP_INL_H
#else
#define FENESTRA_WIDE_CLIP_INL_H
#endif

#include "clip/keep/Seams.h"
// After foreach_target.h:
#include "transport/lanes/Medium-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {

/// Continuous index of a coordinate in mm among a depth buffer's samples (DepthAxis::index).
HWY_INLINE F depthIndex(const WideScene::DepthAxis& axis, F coordinate) {
  const F pixel = hn::MulSub(coordinate, all(axis.perPitch), all(axis.start));
  const F fine = hn::Max(hn::Min(pixel, all(axis.lastInside)), hn::Zero(floats));
  const F index =
      hn::MulAdd(hn::Sub(pixel, fine), all(axis.perFactor), hn::Add(fine, all(axis.before)));
  return hn::Max(hn::Min(index, all(axis.last)), hn::Zero(floats));
}

/// Exact surface depth at (x, y) in seams for the lanes of `isAsked`; `surface` for the others.
inline F askSeams(const Seams& seams, M isAsked, I seam, F x, F y, F depth, double softness,
                  F surface) {
  constexpr std::size_t lanes = HWY_MAX_BYTES / sizeof(float);
  static_assert(lanes <= Seams::mostQuestions);
  const Indices numbers(seam);
  struct alignas(64) Floats : std::array<float, lanes> {};
  Floats xs, ys, depths, surfaces, asked;
  hn::Store(x, floats, xs.data());
  hn::Store(y, floats, ys.data());
  hn::Store(depth, floats, depths.data());
  hn::Store(surface, floats, surfaces.data());
  hn::Store(hn::IfThenElseZero(isAsked, all(1.0F)), floats, asked.data());
  std::array<Seams::Question, lanes> questions;
  std::array<std::size_t, lanes> lane;
  std::size_t count = 0;
  for (std::size_t i = 0; i < hn::Lanes(floats); ++i)
    if (asked[i] > 0.0F) {
      lane[count] = i;
      questions[count++] = {numbers[i], Vec2(xs[i], ys[i]), surfaces[i], depths[i] - softness};
    }
  seams.answer(std::span(questions).first(count));
  for (std::size_t i = 0; i < count; ++i)
    surfaces[lane[i]] = static_cast<float>(questions[i].surface);
  return hn::Load(floats, surfaces.data());
}

/// Surface depth for points at (x, y) and `depth` (ClipDepth::surfaceFor): exact in seams for the
/// lanes of `which`, else `surface`.
HWY_INLINE F sewn(const WideScene& scene, M which, I sample, F x, F y, F depth, F surface) {
  const I seam = hn::GatherIndex(ints, scene.seams->numbers().data(), sample);
  const auto isSeam = hn::Gt(seam, hn::Set(ints, -1));
  if (hn::AllFalse(ints, isSeam))
    return surface;
  const I first = hn::ShiftLeft<1>(hn::Max(seam, hn::Zero(ints)));
  const float* const reaches = &scene.seams->reaches().data()->least;
  const F least = hn::Min(surface, hn::GatherIndex(floats, reaches, first));
  const F greatest =
      hn::Max(surface, hn::GatherIndex(floats, reaches + 1, first)); // least and greatest alternate
  const M isNear =
      hn::And(hn::Ge(depth, least), hn::Le(depth, hn::Add(greatest, all(scene.softness))));
  const M isAsked = both(which, both(hn::RebindMask(floats, isSeam), isNear));
  if (hn::AllFalse(floats, isAsked))
    return surface;
  return askSeams(*scene.seams, isAsked, seam, x, y, depth, scene.softness, surface);
}

/// Points in view space.
struct InView {
  F x, y;      ///< as toBuffer's; 0 for a plane
  F depth;     ///< from the target, mm
  F scale;     ///< target's depth / depth; 1 in orthographic views
  M behindEye; ///< no lane in orthographic views
};

HWY_INLINE InView inView(const WideScene& scene, const Point& p) {
  const F zero = hn::Zero(floats);
  InView at{zero, zero, apply(scene.toView[2], p), all(1.0F), noLane()};
  if (scene.perspective) {
    const F fromEye = hn::Add(at.depth, all(scene.targetDepth));
    at.behindEye = hn::Le(fromEye, zero);
    at.scale = hn::Div(all(scene.targetDepth), fromEye);
  }
  if (scene.clipKind == WideScene::ClipKind::plane)
    return at;
  at.x = hn::Mul(apply(scene.toView[0], p), at.scale);
  at.y = hn::Mul(apply(scene.toView[1], p), at.scale);
  return at;
}

/// Depths, mm from the target, of the four samples around places in the buffer.
struct DepthCell {
  F column, row; ///< of the places
  F fc, fr;      ///< places in their cells, 0 to 1
  I first;       ///< sample
  F upLeft, upRight, downLeft, downRight;

  HWY_INLINE F depth() const {
    return lerp(lerp(upLeft, upRight, fc), lerp(downLeft, downRight, fc), fr);
  }
};

HWY_INLINE DepthCell depthCell(const WideScene& scene, const InView& view) {
  const F column = depthIndex(scene.depthX, view.x);
  const F row = depthIndex(scene.depthY, view.y);
  const I columns = hn::Set(ints, scene.depthColumns);
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
  return {column,     row,        fc,         fr,        hn::Add(hn::Mul(r0, columns), c0),
          at(c0, r0), at(c1, r0), at(c0, r1), at(c1, r1)};
}

/// Depth of the nearest sample.
HWY_INLINE F nearestDepth(const WideScene& scene, const InView& view) {
  const I c = hn::ConvertTo(ints, hn::Add(depthIndex(scene.depthX, view.x), all(0.5F)));
  const I r = hn::ConvertTo(ints, hn::Add(depthIndex(scene.depthY, view.y), all(0.5F)));
  return hn::GatherIndex(floats, scene.depths,
                         hn::Add(hn::Mul(r, hn::Set(ints, scene.depthColumns)), c));
}

/// Depth of a linear surface: exact in seams for the lanes of `which`.
HWY_INLINE F linearDepth(const WideScene& scene, const InView& view, const DepthCell& cell,
                         M which) {
  const F surface = cell.depth();
  return scene.seams ? sewn(scene, which, cell.first, view.x, view.y, view.depth, surface)
                     : surface;
}

/// keep for every kind of clip, for the lanes of `which`.
inline F keep(const WideScene& scene, const Point& p, M which) {
  const InView view = inView(scene, p);
  const auto edge = [&](F behind) {
    const F zero = hn::Zero(floats), one = all(1.0F), ghost = all(scene.ghost);
    const F rise =
        scene.perSoftness > 0.0F ? hn::Min(hn::Mul(behind, all(scene.perSoftness)), one) : one;
    const F share = hn::IfThenElse(hn::Lt(behind, zero), ghost, lerp(ghost, one, rise));
    return hn::IfThenElse(view.behindEye, zero, share);
  };
  if (scene.clipKind == WideScene::ClipKind::plane)
    return edge(hn::Neg(apply(scene.toPlane, p)));
  const F surface = scene.clipKind == WideScene::ClipKind::depthNearest
                        ? nearestDepth(scene, view)
                        : linearDepth(scene, view, depthCell(scene, view), which);
  return edge(hn::Sub(view.depth, surface));
}

/// Slope of a surface along one axis of the buffer, mm per mm, from its `rise` over a cell. Beyond
/// the samples, and at the first of them, 0.
HWY_INLINE F slopeAlong(const WideScene::DepthAxis& axis, F index, F rise) {
  const F before = all(axis.before);
  const M isFine =
      both(hn::Ge(index, before), hn::Lt(index, hn::Add(before, all(axis.lastInside))));
  const M isBetween = both(hn::Gt(index, hn::Zero(floats)), hn::Lt(index, all(axis.last)));
  const F perLength =
      hn::IfThenElse(isFine, all(axis.perPitch), all(axis.perPitch * axis.perFactor));
  return hn::IfThenElseZero(isBetween, hn::Mul(rise, perLength));
}

/// Gradient of the depth behind a linear surface, along the view's axes.
HWY_INLINE F3 behindGradient(const WideScene& scene, const InView& view, const DepthCell& cell) {
  const F x = slopeAlong(
      scene.depthX, cell.column,
      lerp(hn::Sub(cell.upRight, cell.upLeft), hn::Sub(cell.downRight, cell.downLeft), cell.fr));
  const F y = slopeAlong(
      scene.depthY, cell.row,
      lerp(hn::Sub(cell.downLeft, cell.upLeft), hn::Sub(cell.downRight, cell.upRight), cell.fc));
  const F one = all(1.0F);
  if (!scene.perspective)
    return {hn::Neg(x), hn::Neg(y), one};
  const F perDepth = hn::Div(view.scale, all(scene.targetDepth));
  const F along = hn::MulAdd(x, view.x, hn::Mul(y, view.y));
  return {hn::Neg(hn::Mul(x, view.scale)), hn::Neg(hn::Mul(y, view.scale)),
          hn::MulAdd(along, perDepth, one)};
}

/// cutGradient, world axes, for the lanes of `which`; 0 in the others. Requires a soft edge.
inline F3 cutGradient(const WideScene& scene, const Point& p, M which) {
  const InView view = inView(scene, p);
  const auto ramp = [&](F behind) {
    const M isRamp = both(hn::Ge(behind, hn::Zero(floats)), hn::Lt(behind, all(scene.softness)));
    return hn::AndNot(view.behindEye, both(which, isRamp));
  };
  const F length = all(scene.cutSlope);
  if (scene.clipKind == WideScene::ClipKind::plane)
    return selectElseZero(ramp(hn::Neg(apply(scene.toPlane, p))), length * all3(scene.cutNormal));
  if (scene.clipKind == WideScene::ClipKind::depthNearest)
    return selectElseZero(ramp(hn::Sub(view.depth, nearestDepth(scene, view))),
                          length * all3(scene.cutNormal));
  const DepthCell cell = depthCell(scene, view);
  const M isRamp = ramp(hn::Sub(view.depth, linearDepth(scene, view, cell, which)));
  if (hn::AllFalse(floats, isRamp))
    return {hn::Zero(floats), hn::Zero(floats), hn::Zero(floats)};
  const F3 normal = normalized(mapDirection(scene.fromView, behindGradient(scene, view, cell)));
  return selectElseZero(isRamp, length * normal);
}

} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
