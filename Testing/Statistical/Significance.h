#pragma once
// How probable a difference is where there is none.

#include <cstddef>
#include <optional>
#include <vector>

namespace fenestra::testing {

/// A mean, and how sure it is.
struct Estimated {
  double mean = 0.0;
  double variance = 0.0; ///< of the mean
  double samples = 0.0;  ///< that it is the mean of
  double skewness = 0.0; ///< of one sample, where it is known
};

/// How probable a difference as large as that between two estimates of one value is, by Welch's t
/// (1947) with Satterthwaite's degrees of freedom. A mean of few bright paths is skewed as a count
/// of them is, so there are no more degrees of freedom than there would be paths, were they equally
/// bright, and than n / skewness^2: the tails are then the heavier ones. None where both are exact
/// and agree; 0 where both are exact and differ, or something is not a number.
std::optional<double> welchProbability(const Estimated& a, const Estimated& b);

/// Whether no few paths decide on a mean: n / skewness^2 of at least 100. Where they do, they
/// decide on its error as well, and t is too often near 1: over sixteen seed bases of the matrix,
/// all tiles' probabilities were uniform to 0.011 (Kolmogorov and Smirnov's distance, probability
/// 3e-6), those of even ones to 0.006 (0.27); by the readable transport 0.009 (1e-4) and 0.007
/// (0.14).
bool isEven(const Estimated& e);

/// Of the least of `count` independent probabilities being this small (Šidák 1967).
double sidak(double least, double count);

/// A suite of `count` independent probabilities, each held to this, fails once in a thousand runs
/// by chance.
double leastProbability(std::size_t count);

/// Of probabilities that should be uniform in [0, 1] straying this far from it: Kolmogorov and
/// Smirnov's largest distance, in Stephens' approximation (1970). 1 for none.
double uniformityProbability(std::vector<double> probabilities);

/// Two-sided, of a normal deviate.
double normalTail(double z);

} // namespace fenestra::testing
