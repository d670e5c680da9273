#pragma once
// Condition number of a thin plate spline's system, which bounds its rounding error.

#include "clip/surface/ThinPlateSpline.h"

namespace fenestra::testing_clipping {

/// Condition number in the 2-norm of K' + lambda / s^2 I on the null space of P'; 1 without a
/// system.
double computeConditionNumber(const ThinPlateSpline& spline);

/// Condition number from independently rebuilt matrices, with another basis of the null space:
/// eigenvectors of P P'. Sites in the xy plane, mm.
double computeConditionByEigenvectors(const std::vector<Vec2>& sites, double lambda);

} // namespace fenestra::testing_clipping
