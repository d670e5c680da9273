// SIMD look-ups in the scene. Each header included below is the SIMD version of the scalar header
// of its name, and part of this namespace. Compiled once per instruction set: include after
// Highway's foreach_target.h.

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
namespace fenestra::core::HWY_NAMESPACE {
#include "integrator/simd/Medium-inl.h"
// Used by the ones below:
#include "integrator/simd/Clip-inl.h"
#include "integrator/simd/LabelWeights-inl.h"
// Shading and mixtures:
#include "integrator/simd/Mixture-inl.h"
#include "integrator/simd/Shading-inl.h"
} // namespace fenestra::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
