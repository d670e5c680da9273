#pragma once
// The approximating thin plate spline (Duchon 1977; Wahba 1990, "Spline Models for Observational
// Data", section 2.4) that carries the focus's depth into its surroundings.

#include "core/Vector.h"

#include <span>
#include <vector>

namespace fenestra {

/// f(x) = a0 + a1 x + a2 y + sum w_i phi(|x - x_i|), phi(r) = r^2 ln r^2, with
///   (K + lambda I) w + P a = z,  P' w = 0,  lambda = (1 - p) / p,
/// K_ij = phi(|x_i - x_j|) and P's rows (1, x_i, y_i), all in mm: MATLAB's tpaps. p = 1
/// interpolates, p = 0 is the least-squares plane. Sites that determine no plane (fewer than three,
/// coincident, collinear) give the least-squares line along them, or their mean.
///
/// Solved in the unit disc, u = (x - c) / s. There phi(s r) = s^2 phi(r) + s^2 ln(s^2) r^2, and for
/// weights with P' w = 0 the sum of the last term is the same at every x, so that a0 takes it in.
/// With w' = s^2 w the system in u is (K' + lambda / s^2 I) w' + P' a' = z, with the same f.
class ThinPlateSpline {
public:
  /// Sites (mm) and values (mm), equally many and at least one; smoothing p in [0, 1].
  ThinPlateSpline(std::span<const Vec2> sites, std::span<const double> values, double smoothing);

  double operator()(const Vec2& x) const;

  /// f at (x[i], y) for every i.
  void evaluateRow(std::span<const double> x, double y, std::span<double> values) const;

  /// Of the system that was solved, in the 2-norm; 1 where there was none to solve.
  double conditionNumber() const { return m_conditionNumber; }

private:
  struct Term {
    Vec2 site; ///< in the unit disc
    double weight;
  };

  void fit(const Eigen::VectorXd& values, double smoothing);

  Vec2 m_center = Vec2::Zero(); ///< mm
  double m_perScale = 1.0;      ///< 1 / s, mm^-1
  Vec3 m_plane = Vec3::Zero();  ///< a', in the unit disc
  std::vector<Term> m_terms;
  double m_conditionNumber = 1.0;
};

} // namespace fenestra
