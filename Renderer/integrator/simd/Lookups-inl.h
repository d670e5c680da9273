// Look-ups of lanes in a scene. Each of the files named below doubles the readable or model header
// of its name, and is a part of this namespace. Compiled once for each instruction set: include
// after Highway's foreach_target.h.

#if defined(FENESTRA_LOOKUPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_LOOKUPS_INL_H
#undef FENESTRA_LOOKUPS_INL_H
#else
#define FENESTRA_LOOKUPS_INL_H
#endif

#include "clip/field/SilhouetteCells.h"
#include "integrator/simd/Medium.h"
#include "integrator/simd/Shading.h"
// After foreach_target.h:
#include "base/SimdMath-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {
#include "integrator/simd/Medium-inl.h"
// Parts of a look-up:
#include "integrator/simd/Clip-inl.h"
#include "integrator/simd/LabelWeights-inl.h"
// Matter, made of these:
#include "integrator/simd/Mixture-inl.h"
#include "integrator/simd/Shading-inl.h"
// Rays among cells:
#include "integrator/simd/DdaAxis-inl.h"
} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
