#include "clip/surface/LocalExpansion.h"

#include <array>
#include <complex>

namespace fenestra::core {

namespace {

using Complex = std::complex<double>;

/// Maximum number of terms: 3^-24 is about the rounding error of a sum.
constexpr Eigen::Index maxTerms = 24;

/// Rounding error of a sum, relative to the sum of the absolute terms.
constexpr double rounding = 64.0 * std::numeric_limits<double>::epsilon();

constexpr auto binomials = [] {
  std::array<std::array<double, maxTerms + 1>, maxTerms + 1> rows{};
  for (std::size_t k = 0; k <= maxTerms; ++k) {
    rows[k][0] = 1.0;
    for (std::size_t b = 1; b <= k; ++b)
      rows[k][b] = rows[k - 1][b - 1] + rows[k - 1][b];
  }
  return rows;
}();

/// P and Q of LocalExpansion.h, of equal length.
struct Polynomials {
  std::vector<Complex> p, q;
};

/// Terms as a structure of arrays.
struct Terms {
  Eigen::ArrayXd x, y, weight; ///< d = site - center = x + i y

  Terms(std::span<const KernelTerm> terms, const Vec2& center)
      : x(std::ssize(terms)), y(x.size()), weight(x.size()) {
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const KernelTerm& term = terms[static_cast<std::size_t>(i)];
      x[i] = term.site.x() - center.x();
      y[i] = term.site.y() - center.y();
      weight[i] = term.weight;
    }
  }
};

std::optional<Polynomials> expand(const Terms& terms, double radius, double tolerance) {
  const Eigen::ArrayXd squared = terms.x.square() + terms.y.square();
  const Eigen::ArrayXd logarithm = squared.log();
  const Eigen::ArrayXd moment = terms.weight * squared;
  if (!(rounding * (moment * (logarithm.abs() + 2.0)).abs().sum() <= 0.5 * tolerance))
    return {};
  const Eigen::ArrayXd first = -2.0 * radius * terms.weight * (logarithm + 1.0);
  Polynomials result;
  result.p = {(moment * logarithm).sum(), {(first * terms.x).sum(), -(first * terms.y).sum()}};
  result.q = {0.0, radius * radius * (terms.weight * (logarithm + 2.0)).sum()};

  const Eigen::ArrayXd ex = radius * terms.x / squared, ey = -radius * terms.y / squared; // e
  const Eigen::ArrayXd size = radius / squared.sqrt();                                    // |e|
  Eigen::ArrayXd rest = 2.0 * moment.abs() * size.square() * (1.0 + size) / (1.0 - size);
  Eigen::ArrayXd re = ex, im = ey, old; // e^k
  for (Eigen::Index k = 1; k <= maxTerms; ++k) {
    const auto scale = 2.0 / static_cast<double>(k * (k + 1));
    if (0.5 * scale * rest.sum() <= 0.5 * tolerance)
      return result;
    const Complex q((terms.weight * re).sum(), (terms.weight * im).sum());
    old = re;
    re = old * ex - im * ey;
    im = old * ey + im * ex;
    rest *= size;
    result.p.emplace_back(scale * (moment * re).sum(), scale * (moment * im).sum());
    result.q.push_back(-radius * radius * scale * q);
  }
  return {};
}

/// Re(i^power z).
double rotateReal(const Complex& z, Eigen::Index power) {
  const double value = power & 1 ? -z.imag() : z.real();
  return power & 2 ? -value : value;
}

} // namespace

std::optional<LocalExpansion> LocalExpansion::make(std::span<const KernelTerm> terms,
                                                   const Vec2& center, double radius,
                                                   double tolerance) {
  const auto polynomials = expand({terms, center}, radius, tolerance);
  if (!polynomials)
    return {};
  // tau = x + i y: tau^k is the sum of binomial(k, b) x^(k - b) (i y)^b.
  const auto length = std::ssize(polynomials->p);
  Coefficients coefficients = Coefficients::Zero(length + 1, length + 1);
  for (Eigen::Index k = 0; k < length; ++k) {
    const Complex& p = polynomials->p[static_cast<std::size_t>(k)];
    const Complex& q = polynomials->q[static_cast<std::size_t>(k)];
    for (Eigen::Index b = 0; b <= k; ++b) {
      const double binomial = binomials[static_cast<std::size_t>(k)][static_cast<std::size_t>(b)];
      coefficients(k - b, b) += binomial * rotateReal(p, b);
      coefficients(k - b + 1, b) += binomial * rotateReal(q, b);
      coefficients(k - b, b + 1) -= binomial * rotateReal(q, b + 1); // -i y of conj(tau)
    }
  }
  return LocalExpansion(std::move(coefficients), radius);
}

void LocalExpansion::addPlane(double atCenter, double alongX, double alongY) {
  m_coefficients(0, 0) += atCenter;
  m_coefficients(1, 0) += m_radius * alongX;
  m_coefficients(0, 1) += m_radius * alongY;
}

void LocalExpansion::evaluateRow(std::span<const double> x, double y,
                                 std::span<double> values) const {
  const double invRadius = m_radius > 0.0 ? 1.0 / m_radius : 0.0;
  const Eigen::Index length = m_coefficients.cols();
  Eigen::Array<double, Eigen::Dynamic, 1, 0, maxTerms + 2, 1> row = m_coefficients.col(length - 1);
  for (Eigen::Index b = length - 2; b >= 0; --b)
    row = row * (y * invRadius) + m_coefficients.col(b);
  evaluatePolynomial({row.data(), static_cast<std::size_t>(length)}, invRadius, x, values);
}

} // namespace fenestra::core
