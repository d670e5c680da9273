#pragma once
// The condition number of a thin plate spline's system, by which its rounding is bounded.

#include "clip/surface/ThinPlateSpline.h"

namespace fenestra::testing_clipping {

/// Of K' + lambda / s^2 I on the null space of P', in the 2-norm; 1 where there was no system.
double conditionNumber(const ThinPlateSpline& spline);

/// The same, where the system's matrices are made anew of its data, for sites in the xy plane, mm,
/// and with another basis of the null space: eigenvectors of P P'.
double conditionByEigenvectors(const std::vector<Vec2>& sites, double lambda);

} // namespace fenestra::testing_clipping
