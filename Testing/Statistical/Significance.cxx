#include "Significance.h"

#include "Agreement.h"

#include <algorithm>
#include <cmath>

namespace fenestra::core::testing {
namespace {

double square(double x) {
  return x * x;
}

/// Estimate with a variance, also if all its samples are 0.
Estimated withRareEvents(Estimated e, const Estimated& other) {
  if (e.mean == 0.0 && e.variance == 0.0)
    e.variance = std::abs(other.mean) * e.brightness / e.samples;
  return e;
}

} // namespace

std::optional<double> welchProbability(const Estimated& one, const Estimated& other) {
  const Estimated a = withRareEvents(one, other), b = withRareEvents(other, one);
  const double difference = a.mean - b.mean;
  const double variance = a.variance + b.variance;
  // Rounding error of equal numbers: Fenestra's SIMD code computes in float.
  const double rounding = 1e-6 * std::max(std::abs(a.mean), std::abs(b.mean));
  if (std::abs(difference) <= rounding && variance <= square(rounding))
    return std::nullopt;
  if (!(variance > 0.0) || !std::isfinite(difference))
    return 0.0;
  const auto termOfVariance = [](const Estimated& e) {
    return square(e.variance) / ((e.blocks > 0.0 ? e.blocks : e.samples) - 1.0);
  };
  const double satterthwaite = square(variance) / (termOfVariance(a) + termOfVariance(b));
  const double all = a.samples + b.samples;
  const double mean = (a.samples * a.mean + b.samples * b.mean) / all;
  const double sampleVariance =
      (square(a.samples) * a.variance + square(b.samples) * b.variance) / all;
  const double brightPaths =
      std::min(a.samples, b.samples) * std::min(1.0, square(mean) / sampleVariance);
  const auto limitBySkewness = [](const Estimated& e) {
    return e.samples / std::max(square(e.skewness), 1e-9);
  };
  return studentTail(
      difference / std::sqrt(variance),
      std::min({satterthwaite, brightPaths, limitBySkewness(a), limitBySkewness(b)}));
}

bool hasManyPaths(const Estimated& e) {
  return e.samples >= 100.0 * square(e.skewness);
}

double sidak(double minimum, double count) {
  return -std::expm1(count * std::log1p(-minimum));
}

double significanceLevel(std::size_t count) {
  return 1.0 - std::pow(1.0 - 1e-3, 1.0 / static_cast<double>(count));
}

double uniformityProbability(std::vector<double> probabilities) {
  if (probabilities.empty())
    return 1.0;
  std::ranges::sort(probabilities);
  const auto n = static_cast<double>(probabilities.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < probabilities.size(); ++i) {
    const auto below = static_cast<double>(i);
    distance =
        std::max({distance, probabilities[i] - below / n, (below + 1.0) / n - probabilities[i]});
  }
  const double x = distance * (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n));
  double sum = 0.0;
  for (int k = 1; k <= 100; ++k)
    sum += (k % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * square(k * x));
  return x < 0.2 ? 1.0 : std::clamp(sum, 0.0, 1.0);
}

double normalTail(double z) {
  return std::erfc(std::abs(z) / std::sqrt(2.0));
}

} // namespace fenestra::core::testing
