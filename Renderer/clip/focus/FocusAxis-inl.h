// One axis of the SIMD traversal in FocusTraversal.cxx. Compiled once per instruction set.

#if defined(FENESTRA_FOCUS_AXIS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_FOCUS_AXIS_INL_H
#undef FENESTRA_FOCUS_AXIS_INL_H
#else
#define FENESTRA_FOCUS_AXIS_INL_H
#endif

#include "clip/focus/FocusCells.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace fenestra::core::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::ScalableTag<double>;
using Ints = hn::Rebind<std::int32_t, Doubles>;
using D = hn::Vec<Doubles>;
using I = hn::Vec<Ints>;
using M = hn::Mask<Doubles>;

constexpr Doubles doubles{};
constexpr Ints ints{};

HWY_INLINE D set(double x) {
  return hn::Set(doubles, x);
}
HWY_INLINE I setInts(std::int64_t x) {
  return hn::Set(ints, static_cast<std::int32_t>(x));
}
HWY_INLINE M isNonZero(I x) {
  return hn::Ne(hn::PromoteTo(doubles, x), hn::Zero(doubles));
}

/// Traversal state of a vector of rays along one axis. Rays of negative direction are mirrored, so
/// that all rays ascend. The number of cells is rounded up to full blocks.
struct FocusAxis {
  D origin, direction; ///< direction >= 0
  D inverseDirection;  ///< 1 / direction; infinity: no motion along this axis
  D cell;              ///< current cell of each ray
  D face;              ///< next face: of the cell, or of the block if that is empty
  M isMirrored;
  double cellCount; ///< number of cells, a multiple of blockSize

  FocusAxis(D o, D d, D t, std::int64_t blocks)
      : direction(hn::Abs(d)),
        inverseDirection(hn::Div(set(1.0), direction)),
        face(hn::Zero(doubles)),
        isMirrored(hn::Lt(d, hn::Zero(doubles))),
        cellCount(static_cast<double>(blocks * FocusCells::blockSize)) {
    origin = hn::IfThenElse(isMirrored, hn::Sub(set(cellCount), o), o);
    cell = hn::Max(hn::Min(findCell(t), set(cellCount - 1.0)), hn::Zero(doubles));
  }

  /// Sets `face` and returns its t; infinity for the last face, since the ray's range ends there.
  HWY_INLINE D findFace(M emptyBlock) {
    constexpr double edge = FocusCells::blockSize;
    const D block = hn::Floor(hn::Mul(cell, set(1.0 / edge)));
    face = hn::IfThenElse(emptyBlock, hn::MulAdd(block, set(edge), set(edge)),
                          hn::Add(cell, set(1.0)));
    const M inner = hn::And(hn::Lt(face, set(cellCount)), hn::Lt(inverseDirection, set(infinity)));
    return hn::IfThenElse(inner, hn::Mul(hn::Sub(face, origin), inverseDirection), set(infinity));
  }

  /// Advances the rays of `which` to t: into the cell beyond the face where `crosses`, otherwise at
  /// most up to the face. Never moves back.
  HWY_INLINE void advance(M which, M crosses, D t) {
    const D before = hn::Min(hn::Max(findCell(t), cell), hn::Sub(face, set(1.0)));
    cell = hn::IfThenElse(which, hn::IfThenElse(crosses, face, before), cell);
  }

  /// Cell index, not mirrored.
  HWY_INLINE D cellIndex() const {
    return hn::IfThenElse(isMirrored, hn::Sub(set(cellCount - 1.0), cell), cell);
  }
  /// Position in the cell at t, 0 to 1, and displacement over `length`; both not mirrored.
  HWY_INLINE D fraction(D t) const {
    const D f = hn::Sub(position(t), cell);
    return hn::IfThenElse(isMirrored, hn::Sub(set(1.0), f), f);
  }
  HWY_INLINE D displacement(D length) const {
    const D d = hn::Mul(direction, length);
    return hn::IfThenElse(isMirrored, hn::Neg(d), d);
  }

private:
  HWY_INLINE D position(D t) const { return hn::Add(origin, hn::Mul(t, direction)); }
  HWY_INLINE D findCell(D t) const { return hn::Floor(position(t)); }
};

} // namespace
} // namespace fenestra::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
