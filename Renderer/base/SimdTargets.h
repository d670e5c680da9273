#pragma once
// SIMD code is compiled for three instruction sets and for the baseline, which every machine has.
// Include before Highway's foreach_target.h.

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
