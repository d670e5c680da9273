#include "Agreement.h"

#include "base/Error.h"
#include "image/ImagePair.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

namespace fenestra::core {
namespace {

/// Means and standard errors of an image.
struct Estimates {
  Planes means, errors;
  const std::vector<float>* samples;

  explicit Estimates(const Image& image)
      : means(findColors(image)),
        errors(findPlanes(image, errorNames)),
        samples(image.find("samples.N")) {
    if (!isComplete(errors))
      throw inputError("images", "one has no channels error.R, error.G and error.B; compare "
                                 "renders with all layers");
  }
  double mean(std::size_t c, std::size_t i) const { return (*means[c])[i]; }
  double variance(std::size_t c, std::size_t i) const { return square((*errors[c])[i]); }
  double count(std::size_t i) const { return samples ? (*samples)[i] : 0.0; }
};

/// Sums over one tile and channel.
struct TileSums {
  double mean = 0.0, variance = 0.0, samples = 0.0;
  int pixels = 0;

  void add(const Estimates& image, std::size_t c, std::size_t i) {
    mean += image.mean(c, i);
    variance += image.variance(c, i);
    samples += image.count(i);
    ++pixels;
  }
};

TileSums sumTile(const Image& image, const Estimates& estimates, std::size_t c, int left, int top,
                 int size) {
  TileSums sums;
  for (int row = top; row < std::min(top + size, image.height); ++row)
    for (int column = left; column < std::min(left + size, image.width); ++column)
      sums.add(estimates, c,
               static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                   static_cast<std::size_t>(column));
  return sums;
}

/// p-value of one channel of one pixel (see computeAgreement).
double computePValue(const Estimates& a, const Estimates& b, std::size_t c, std::size_t i) {
  const double nA = a.count(i), nB = b.count(i);
  const double mean = (nA * a.mean(c, i) + nB * b.mean(c, i)) / (nA + nB);
  const double perSampleVariance =
      (square(nA) * a.variance(c, i) + square(nB) * b.variance(c, i)) / (nA + nB);
  const double dof = std::min(nA, nB) * std::min(1.0, square(mean) / perSampleVariance);
  const double t =
      (a.mean(c, i) - b.mean(c, i)) / std::sqrt(perSampleVariance * (1.0 / nA + 1.0 / nB));
  return studentTail(t, dof);
}

/// Continued fraction of the incomplete beta function (DLMF 8.17.22), by the modified Lentz method
/// (Thompson and Barnett 1986). It converges fast for x < (a + 1) / (a + b + 2).
double betaFraction(double a, double b, double x) {
  constexpr double tiny = 1e-300, tolerance = 1e-14;
  const auto avoidZero = [](double value) { return std::abs(value) < tiny ? tiny : value; };
  double c = 1.0, d = 1.0 / avoidZero(1.0 - (a + b) * x / (a + 1.0));
  double fraction = d;
  for (int m = 1; m <= 10000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1.0) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1.0));
    double step = 1.0;
    for (const double coefficient : {even, odd}) {
      d = 1.0 / avoidZero(1.0 + coefficient * d);
      c = avoidZero(1.0 + coefficient / c);
      step = c * d;
      fraction *= step;
    }
    if (std::abs(step - 1.0) < tolerance)
      break;
  }
  return fraction;
}

/// I_x(a, b). `y`: 1 - x, passed separately to avoid the rounding of that difference.
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

double studentTail(double t, double dof) {
  if (std::isnan(t) || std::isnan(dof))
    return std::numeric_limits<double>::quiet_NaN();
  if (std::isinf(t))
    return 0.0;
  const double sum = dof + t * t;
  return regularizedBeta(dof / sum, t * t / sum, 0.5 * dof, 0.5); // DLMF 8.17(ii)
}

Image computeTileMeans(const Image& image, int size) {
  const Estimates estimates(image);
  size = std::min(size, std::max(image.width, image.height));
  Image result{(image.width + size - 1) / size, (image.height + size - 1) / size, {}, {}};
  for (int row = 0; row < result.height; ++row)
    for (int column = 0; column < result.width; ++column) {
      TileSums sums;
      for (std::size_t c = 0; c < 3; ++c) {
        sums = sumTile(image, estimates, c, column * size, row * size, size);
        result.channels[colorNames[c]].push_back(static_cast<float>(sums.mean / sums.pixels));
        result.channels[errorNames[c]].push_back(
            static_cast<float>(std::sqrt(sums.variance) / sums.pixels));
      }
      if (estimates.samples)
        result.channels["samples.N"].push_back(static_cast<float>(sums.samples));
    }
  return result;
}

double computeAgreement(const Image& a, const Image& b) {
  const ImagePair pair(a, b);
  const Estimates estimatesA(a), estimatesB(b);
  if (!estimatesA.samples || !estimatesB.samples)
    throw inputError("images", "one has no channel samples.N; compare renders with all layers");
  double minP = 1.0, count = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < pair.pixels; ++i) {
      if (pair.isUninformative(c, i) && pair.isEqual(c, i))
        continue;
      const double p = computePValue(estimatesA, estimatesB, c, i);
      minP = std::isnan(p) ? 0.0 : std::min(minP, p); // NaN: exact or not finite
      ++count;
    }
  return count == 0.0 ? 1.0 : -std::expm1(count * std::log1p(-minP)); // 1 - (1 - p)^count
}

} // namespace fenestra::core
