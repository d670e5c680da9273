#pragma once
// Along a ray, trilinear interpolation in a cell is a cubic. Finds where it first becomes >= 0.

#include "base/Vector.h"

#include <array>

namespace fenestra::core {

/// c0 + c1 s + c2 s^2 + c3 s^3.
struct Cubic {
  std::array<double, 4> c{};

  double operator()(double s) const { return c[0] + s * (c[1] + s * (c[2] + s * c[3])); }
  double slope(double s) const { return c[1] + s * (2.0 * c[2] + s * 3.0 * c[3]); }
};

/// Turning points of the cubic in (0, 1), ascending; missing ones are 1.
inline std::array<double, 2> findTurningPoints(const Cubic& cubic) {
  const double a = 3.0 * cubic.c[3], halfB = cubic.c[2], c = cubic.c[1];
  const double discriminant = halfB * halfB - a * c;
  if (!(discriminant > 0.0))
    return {1.0, 1.0};
  const double q = -(halfB + std::copysign(std::sqrt(discriminant), halfB)); // no cancellation
  const auto inside = [](double s) { return s > 0.0 && s < 1.0 ? s : 1.0; }; // 1 for NaN, infinity
  const auto [first, second] = std::minmax({inside(q / a), inside(c / q)});
  return {first, second};
}

/// Root of a monotonically increasing cubic with cubic(low) < 0 <= cubic(high). Newton iteration
/// from the secant root, with bisection where a step leaves the bracket.
inline double findRoot(const Cubic& cubic, double low, double high) {
  constexpr double rounding = 1e-15; // of s in [0, 1]
  const double atLow = cubic(low);
  double s = low + (high - low) * (atLow / (atLow - cubic(high)));
  for (int step = 0; step < 100 && high - low > rounding; ++step) {
    const double value = cubic(s);
    (value < 0.0 ? low : high) = s;
    const double newton = s - value / cubic.slope(s);
    if (std::abs(newton - s) <= rounding)
      break; // must precede the bracket test: s is already an end of the bracket
    s = newton > low && newton < high ? newton : 0.5 * (low + high);
  }
  return s;
}

/// Smallest s in [0, 1] with cubic(s) >= 0, or infinity.
inline double findFirstNonNegative(const Cubic& cubic) {
  const std::array<double, 4>& c = cubic.c;
  if (c[0] >= 0.0)
    return 0.0;
  // The Bernstein coefficients bound the cubic. If they ascend, so does the cubic.
  const double b1 = c[0] + c[1] / 3.0, b2 = b1 + (c[1] + c[2]) / 3.0, b3 = cubic(1.0);
  if (std::max({b1, b2, b3}) < 0.0)
    return infinity;
  if (c[0] <= b1 && b1 <= b2 && b2 <= b3)
    return findRoot(cubic, 0.0, 1.0);
  double low = 0.0;
  const auto [first, second] = findTurningPoints(cubic);
  for (const double high : {first, second, 1.0}) { // the cubic is monotonic in between
    if (cubic(high) >= 0.0)
      return findRoot(cubic, low, high);
    low = high;
  }
  return infinity;
}

} // namespace fenestra::core
