#include "clipping/ThinPlateSpline.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace fenestra {

namespace {

/// Keeps the logarithm finite at a site, where its factor is 0.
constexpr double tiny = 1e-300;

/// phi of squared distances.
template <typename Derived>
auto kernel(const Eigen::ArrayBase<Derived>& squared) {
  return squared * (squared + tiny).log();
}

} // namespace

ThinPlateSpline::ThinPlateSpline(std::span<const Vec2> sites, std::span<const double> values,
                                 double smoothing) {
  const auto count = static_cast<double>(sites.size());
  for (const Vec2& site : sites)
    m_center += site / count;
  double scale = 0.0;
  for (const Vec2& site : sites)
    scale = std::max(scale, (site - m_center).norm());
  m_perScale = scale > 0.0 ? 1.0 / scale : 1.0;
  for (const Vec2& site : sites)
    m_terms.push_back({(site - m_center) * m_perScale, 0.0});
  fit(Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values)), smoothing);
}

void ThinPlateSpline::fit(const Eigen::VectorXd& values, double smoothing) {
  const Eigen::Index n = values.size();
  Eigen::MatrixXd sites(n, 2);
  for (Eigen::Index i = 0; i < n; ++i)
    sites.row(i) = m_terms[static_cast<std::size_t>(i)].site.transpose();
  Eigen::MatrixXd p(n, 3);
  p << Eigen::VectorXd::Ones(n), sites;

  // The least-squares polynomial, the flattest where several are: what is left where lambda is
  // infinite or the sites do not determine a plane.
  const Eigen::BDCSVD<Eigen::MatrixXd> svd =
      Eigen::BDCSVD<Eigen::MatrixXd>(p, Eigen::ComputeThinU | Eigen::ComputeThinV)
          .setThreshold(1e-9);
  m_plane = svd.solve(values);
  if (smoothing <= 0.0 || svd.rank() < 3 || n == 3) {
    m_terms.clear();
    return;
  }

  const double lambda = (1.0 - smoothing) / smoothing * m_perScale * m_perScale;
  Eigen::MatrixXd k(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    k.col(i) = kernel((sites.rowwise() - sites.row(i)).rowwise().squaredNorm().array());
  k.diagonal().array() += lambda;

  // w = Q2 v, where the columns of Q2 span the null space of P'.
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(p);
  const Eigen::MatrixXd q2 = qr.householderQ() * Eigen::MatrixXd::Identity(n, n).rightCols(n - 3);
  const Eigen::MatrixXd system = q2.transpose() * k * q2;
  const Eigen::VectorXd w = q2 * system.ldlt().solve(q2.transpose() * values);
  m_plane = svd.solve(values - k * w);
  for (Eigen::Index i = 0; i < n; ++i)
    m_terms[static_cast<std::size_t>(i)].weight = w[i];

  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(system, Eigen::EigenvaluesOnly);
  m_conditionNumber = spectrum.eigenvalues()[n - 4] / spectrum.eigenvalues()[0];
}

double ThinPlateSpline::operator()(const Vec2& x) const {
  double value = 0.0;
  evaluateRow({&x.x(), 1}, x.y(), {&value, 1});
  return value;
}

void ThinPlateSpline::evaluateRow(std::span<const double> x, double y,
                                  std::span<double> values) const {
  constexpr Eigen::Index most = 64; // points at a time: they stay in the first cache
  using Points = Eigen::Array<double, Eigen::Dynamic, 1, 0, most, 1>;
  const double v = (y - m_center.y()) * m_perScale;
  for (Eigen::Index begin = 0; begin < std::ssize(x); begin += most) {
    const Eigen::Index count = std::min(most, std::ssize(x) - begin);
    const Points u =
        (Eigen::Map<const Points>(x.data() + begin, count) - m_center.x()) * m_perScale;
    Points sum = m_plane[0] + m_plane[2] * v + m_plane[1] * u;
    Points squared(count);
    for (const Term& term : m_terms) {
      squared = (u - term.site.x()).square() + (v - term.site.y()) * (v - term.site.y());
      sum += term.weight * kernel(squared);
    }
    Eigen::Map<Points>(values.data() + begin, count) = sum;
  }
}

} // namespace fenestra
