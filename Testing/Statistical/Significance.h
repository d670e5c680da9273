#pragma once
// Probabilities of differences under the hypothesis that there is none.

#include <cstddef>
#include <optional>
#include <vector>

namespace fenestra::testing {

/// Mean of samples, with its uncertainty.
struct Estimated {
  double mean = 0.0;
  double variance = 0.0; ///< of the mean
  double samples = 0.0;  ///< number of samples
  double skewness = 0.0; ///< of one sample; 0 if unknown
  double blocks = 0.0;   ///< independent values that tell the variance; 0: all samples
  double brightness =
      0.0; ///< mean square over mean of a sample, wherever there is light; 0: unknown
};

/// Two-sided probability of the difference between two estimates of one value, by Welch's t (1947)
/// with Satterthwaite's degrees of freedom. A mean of few bright paths is skewed like their count,
/// so the degrees of freedom are limited by the number of equally bright paths and by n /
/// skewness^2: lower limits give heavier tails. Samples that are all 0 tell nothing of their
/// variance: it is that of events of the given brightness, as rare as the other mean says. Empty if
/// both estimates are exact and agree; 0 if both are exact and differ, or a value is not finite.
std::optional<double> welchProbability(const Estimated& one, const Estimated& other);

/// True if a mean is not decided by few paths: n / skewness^2 >= 100. Few paths also decide on the
/// error of their mean, and t is then too often near 1. Measured over sixteen seed bases of the
/// matrix: the probabilities of all tiles were uniform to 0.011 (Kolmogorov and Smirnov's distance,
/// probability 3e-6), of even tiles to 0.006 (0.27); by the readable transport to 0.009 (1e-4) and
/// 0.007 (0.14).
bool hasManyPaths(const Estimated& e);

/// Probability that the least of `count` independent probabilities is <= `least` (Šidák 1967).
double sidak(double minimum, double count);

/// Bound on each of `count` independent probabilities such that the suite fails by chance once in a
/// thousand runs.
double significanceLevel(std::size_t count);

/// Probability that uniform values in [0, 1] deviate at least as far: Kolmogorov and Smirnov's
/// largest distance, in Stephens' approximation (1970). 1 for an empty list.
double uniformityProbability(std::vector<double> probabilities);

/// Two-sided tail probability of a normal deviate.
double normalTail(double z);

} // namespace fenestra::testing
