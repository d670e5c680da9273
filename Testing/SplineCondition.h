#pragma once
// Condition number of a thin plate spline's system, which bounds its rounding error.

#include "clip/surface/ThinPlateSpline.h"

namespace fenestra::core::testing_clipping {

/// 2-norm condition number of K' + lambda / s^2 I on the null space of P'; 1 without kernel terms.
double computeConditionNumber(const ThinPlateSpline& spline);

/// The same from independently rebuilt matrices, with the eigenvectors of P P' as the basis of the
/// null space. Sites in the xy plane, mm.
double computeConditionByEigenvectors(const std::vector<Vec2>& sites, double lambda);

} // namespace fenestra::core::testing_clipping
