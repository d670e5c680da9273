#pragma once
// The words of formulas/README.md for C++.

/// Function of a formula.
#define FORMULA inline __attribute__((always_inline))
/// Constant of a formula.
#define CONSTANT inline constexpr
/// Argument of a struct type, which the function does not change.
#define STRUCT(T) const T&
/// Shifts by a constant number of bits.
#define SHIFT_LEFT(x, by) shiftLeft<by>(x)
#define SHIFT_RIGHT(x, by) shiftRight<by>(x)
