#pragma once
// Statistical tests: p-values of differences under the hypothesis that there is none.

#include <cstddef>
#include <optional>
#include <vector>

namespace fenestra::core::testing {

/// Mean of samples, with its uncertainty.
struct Estimated {
  double mean = 0.0;
  double variance = 0.0;   ///< of the mean
  double samples = 0.0;    ///< number of samples
  double skewness = 0.0;   ///< of one sample; 0 if unknown
  double blocks = 0.0;     ///< independent values that determine the variance; 0: all samples
  double brightness = 0.0; ///< mean square / mean of a sample; 0: unknown
};

/// Two-sided p-value of the difference between two estimates of one value, by Welch's t (1947) with
/// Satterthwaite's degrees of freedom. A mean of few bright paths is skewed like their count. So
/// the degrees of freedom are limited by the number of equally bright paths and by n / skewness^2:
/// fewer degrees give heavier tails. Samples that are all 0 contain no information about their
/// variance: it is that of events of the given brightness, whose rate follows from the other mean.
/// Empty if both estimates are exact and agree; 0 if both are exact and differ, or a value is not
/// finite.
std::optional<double> welchProbability(const Estimated& one, const Estimated& other);

/// True if few paths do not dominate a mean: n / skewness^2 >= 100. Few paths also dominate the
/// error of their mean, and t is then too often near 1. Kolmogorov-Smirnov distances from
/// uniformity over sixteen seed bases of the matrix: p-values of all tiles 0.011 (probability
/// 3e-6), of tiles with many paths 0.006 (0.27); with the scalar integrator 0.009 (1e-4) and 0.007
/// (0.14).
bool hasManyPaths(const Estimated& e);

/// Probability that the minimum of `count` independent p-values is <= `minimum` (Šidák 1967).
double sidak(double minimum, double count);

/// Lower bound of each of `count` independent p-values, with which all together fail by chance once
/// in a thousand runs.
double significanceLevel(std::size_t count);

/// p-value of the hypothesis that the values are uniform in [0, 1], by the Kolmogorov-Smirnov test
/// in Stephens' approximation (1970). 1 for an empty list.
double uniformityProbability(std::vector<double> probabilities);

/// Two-sided tail probability of a standard normal value.
double normalTail(double z);

} // namespace fenestra::core::testing
