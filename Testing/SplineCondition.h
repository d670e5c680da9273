#pragma once
// The condition number of a thin plate spline's system, by which its rounding is bounded.

#include "clipping/ThinPlateSpline.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace fenestra::testing_clipping {

/// Of K' + lambda / s^2 I on the null space of P', in the 2-norm; 1 where there was no system.
inline double conditionNumber(const ThinPlateSpline& spline) {
  const auto n = std::ssize(spline.terms());
  if (n == 0)
    return 1.0;
  Eigen::MatrixXd k(n, n);
  Eigen::MatrixX3d p(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec2& site = spline.terms()[static_cast<std::size_t>(i)].site;
    for (Eigen::Index j = 0; j < i; ++j) {
      const double squared =
          (site - spline.terms()[static_cast<std::size_t>(j)].site).squaredNorm();
      k(i, j) = k(j, i) = squared > 0.0 ? squared * std::log(squared) : 0.0;
    }
    k(i, i) = spline.lambda();
    p.row(i) << 1.0, site.x(), site.y();
  }
  const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixX3d>(p).householderQ();
  const Eigen::MatrixXd reduced = q.rightCols(n - 3).transpose() * k * q.rightCols(n - 3);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(reduced, Eigen::EigenvaluesOnly);
  return spectrum.eigenvalues().maxCoeff() / spectrum.eigenvalues().minCoeff();
}

} // namespace fenestra::testing_clipping
