#pragma once
// Local expansion of a thin plate spline: the sum of distant kernels as a polynomial over a disk
// (Greengard and Rokhlin 1987, "A Fast Algorithm for Particle Simulations"; biharmonic kernel).

#include "clip/surface/KernelSums.h"

#include <Eigen/Core>

#include <optional>
#include <span>
#include <vector>

namespace fenestra::core {

/// For u = center + radius * tau, |tau| <= 1, with d = site - center and e = radius / d as complex
/// numbers, |e| < 1,
///   phi = |u - site|^2 (ln |d|^2 + 2 Re ln(1 - e tau)),
///   (1 - q) ln(1 - q) = -q + sum over k >= 2 of q^k / (k (k - 1)),
/// so that the sum of the terms is the real part of P(tau) + conj(tau) Q(tau), with
///   P_k = 2 / (k (k - 1)) sum w |d|^2 e^k,  Q_k = -2 radius^2 / (k (k - 1)) sum w e^(k - 1)
/// for k >= 2. The remainder after k = K is at most
///   2 / (K (K + 1)) sum |w| |d|^2 |e|^(K + 1) (1 + |e|) / (1 - |e|).
class LocalExpansion {
public:
  /// Largest |e| of expanded terms. Larger values expand more terms but need longer expansions.
  static constexpr double maxRatio = 1.0 / 3.0;

  /// Expansion within `tolerance` of the terms' sum over the disk, including rounding. Empty if
  /// double precision cannot reach `tolerance`. Every |e| must be at most maxRatio.
  static std::optional<LocalExpansion> make(std::span<const KernelTerm> terms, const Vec2& center,
                                            double radius, double tolerance);

  void addPlane(double atCenter, double alongX, double alongY);

  /// Sum of the terms at center + (x[i], y) for every i, all points within the disk.
  void evaluateRow(std::span<const double> x, double y, std::span<double> values) const;

private:
  /// Coefficients of x^a y^b in row a and column b; x and y in radii.
  using Coefficients = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic>;

  LocalExpansion(Coefficients coefficients, double radius)
      : m_coefficients(std::move(coefficients)), m_radius(radius) {}

  Coefficients m_coefficients;
  double m_radius;
};

} // namespace fenestra::core
