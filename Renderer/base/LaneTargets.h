#pragma once
// Which instruction sets lanes are compiled for: three, and what every machine has. Before
// Highway's foreach_target.h.

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
