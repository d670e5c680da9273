#pragma once
// The cubic along a ray in a cell, in double.

#include "base/ScalarMath.h"

#include <cmath>

namespace fenestra::core::scalar {

#include "formulas/CellCubic.inl"

constexpr double rootRounding = 1e-15; ///< of roots in [0, 1]

} // namespace fenestra::core::scalar
