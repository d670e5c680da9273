#pragma once
// SIMD code for the sums that dominate the cost of a thin plate spline. The instruction set is
// chosen at run time (Highway).

#include "base/Vector.h"

#include <span>

namespace fenestra::core {

/// w phi(|u - site|), phi(r) = r^2 ln r^2.
struct KernelTerm {
  Vec2 site;
  double weight;
};

/// Adds the sum of the terms at (u[i], v) to sums[i].
void addKernels(std::span<const KernelTerm> terms, std::span<const double> u, double v,
                std::span<double> sums);

/// values[i] = sum over k of coefficients[k] (scale x[i])^k.
void evaluatePolynomial(std::span<const double> coefficients, double scale,
                        std::span<const double> x, std::span<double> values);

} // namespace fenestra::core
