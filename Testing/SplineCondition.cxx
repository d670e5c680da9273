#include "SplineCondition.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace fenestra::core::testing_clipping {

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

double computeConditionNumber(const ThinPlateSpline& spline) {
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
  const Solver spectrum(reduced, Eigen::EigenvaluesOnly);
  return spectrum.eigenvalues().maxCoeff() / spectrum.eigenvalues().minCoeff();
}

double computeConditionByEigenvectors(const std::vector<Vec2>& sites, double lambda) {
  const auto n = std::ssize(sites);
  Vec2 center = Vec2::Zero();
  for (const Vec2& site : sites)
    center += site / static_cast<double>(n);
  double s = 0.0;
  for (const Vec2& site : sites)
    s = std::max(s, (site - center).norm());
  Eigen::MatrixXd p(n, 3), k(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec2 u = (sites[static_cast<std::size_t>(i)] - center) / s;
    p.row(i) << 1.0, u.x(), u.y();
    for (Eigen::Index j = 0; j < n; ++j) {
      const double r = (sites[static_cast<std::size_t>(j)] - center - s * u).norm() / s;
      k(i, j) = i == j ? lambda / (s * s) : r * r * std::log(r * r);
    }
  }
  const Eigen::MatrixXd square = p * p.transpose();
  const Eigen::MatrixXd basis = Solver(square).eigenvectors().leftCols(n - 3);
  const Solver spectrum(basis.transpose() * k * basis);
  return spectrum.eigenvalues()[n - 4] / spectrum.eigenvalues()[0];
}

} // namespace fenestra::core::testing_clipping
