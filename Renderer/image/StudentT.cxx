#include "image/StudentT.h"

#include <cmath>
#include <initializer_list>
#include <limits>

namespace fenestra {

namespace {

/// The continued fraction of the incomplete beta function (DLMF 8.17.22), evaluated as Lentz does
/// (modified: Thompson and Barnett 1986). It converges fast for x < (a + 1) / (a + b + 2).
double betaFraction(double a, double b, double x) {
  constexpr double tiny = 1e-300, enough = 1e-14;
  const auto kept = [](double value) { return std::abs(value) < tiny ? tiny : value; };
  double c = 1.0, d = 1.0 / kept(1.0 - (a + b) * x / (a + 1.0));
  double fraction = d;
  for (int m = 1; m <= 10000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1.0) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1.0));
    double step = 1.0;
    for (const double coefficient : {even, odd}) {
      d = 1.0 / kept(1.0 + coefficient * d);
      c = kept(1.0 + coefficient / c);
      step = c * d;
      fraction *= step;
    }
    if (std::abs(step - 1.0) < enough)
      break;
  }
  return fraction;
}

/// I_x(a, b); `y` is 1 - x, without the rounding of that difference.
double regularizedBeta(double x, double y, double a, double b) {
  if (x <= 0.0 || y <= 0.0)
    return x <= 0.0 ? 0.0 : 1.0;
  const double factor = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                 a * std::log(x) + b * std::log(y));
  if (x < (a + 1.0) / (a + b + 2.0))
    return factor * betaFraction(a, b, x) / a;
  return 1.0 - factor * betaFraction(b, a, y) / b;
}

} // namespace

double studentTail(double t, double freedom) {
  if (std::isnan(t) || std::isnan(freedom))
    return std::numeric_limits<double>::quiet_NaN();
  if (std::isinf(t))
    return 0.0;
  const double sum = freedom + t * t;
  return regularizedBeta(freedom / sum, t * t / sum, 0.5 * freedom, 0.5); // DLMF 8.17(ii)
}

} // namespace fenestra
