#pragma once
// Instruction sets that SIMD code is compiled for: three, and the baseline of every machine.
// Include before Highway's foreach_target.h.

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
