#pragma once
// Approximating thin plate spline (Duchon 1977; Wahba 1990, "Spline Models for Observational
// Data", section 2.4), which extends the depth of the focus into the context.

#include "clip/surface/LocalExpansion.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fenestra::core {

/// f(x) = a0 + a1 x + a2 y + sum w_i phi(|x - x_i|), phi(r) = r^2 ln r^2, with
///   (K + lambda I) w + P a = z,  P' w = 0,  lambda = (1 - p) / p,
/// where K_ij = phi(|x_i - x_j|) and the rows of P are (1, x_i, y_i), all in mm, as in MATLAB's
/// tpaps. p = 1 interpolates; p = 0 is the least-squares plane. Sites that do not determine a plane
/// (fewer than three, coincident, collinear to 1e-9 of their extent or to their coordinates'
/// rounding) give the least-squares line along them, or their mean; no sites give 0.
///
/// Solved in the unit disk, u = (x - c) / s. There phi(s r) = s^2 phi(r) + s^2 ln(s^2) r^2. For
/// weights with P' w = 0 the last term sums to a constant, which a0 absorbs. With w' = s^2 w the
/// system in u is (K' + lambda / s^2 I) w' + P' a' = z, with the same f.
///
/// Accuracy: the error of f is 1e-14 times the condition number, relative to |f| and to the range
/// of the values, at any distance from the sites. The tilt across nearly collinear sites is
/// ill-conditioned. With almost no smoothing, f overshoots between sites that are very close
/// together, and in the limit loses all digits. Sites closer than r with lambda / s^2 - phi(r / s)
/// < 1e-12 (r = 1.9e-7 s at p = 1) are therefore merged into the first of them, with their mean
/// value.
class ThinPlateSpline {
public:
  /// Sites and values: mm, finite, of equal number. Smoothing p in [0, 1].
  ThinPlateSpline(std::span<const Vec2> sites, std::span<const double> values, double smoothing);

  double operator()(const Vec2& x) const;

  /// f at (x[i], y) for every i.
  void evaluateRow(std::span<const double> x, double y, std::span<double> values) const;

  /// f at (x[i], y[j]) for every i and j, row by row, to within `tolerance` mm plus the rounding of
  /// f. Much cheaper than evaluateRow, since terms far from the tile are summed as one polynomial.
  /// Equals evaluateRow if double precision cannot reach `tolerance`, or if all terms are near. At
  /// most maxColumns of x; x and y must be monotonic.
  void evaluateTile(std::span<const double> x, std::span<const double> y, double tolerance,
                    std::span<double> values) const;

  /// Number of terms that evaluateTile evaluates directly, which dominate the cost of a tile.
  std::int64_t countNearTerms(std::span<const double> x, std::span<const double> y) const;

  static constexpr Eigen::Index maxColumns = 64; ///< fits the L1 cache

  /// Solution of the system: sites in the unit disk with their weights w' (empty if none was
  /// solved), and lambda / s^2.
  const std::vector<KernelTerm>& terms() const { return m_terms; }
  double lambda() const { return m_lambda; }

private:
  using Points = Eigen::Array<double, Eigen::Dynamic, 1, 0, maxColumns, 1>; ///< of a row

  /// Chooses the unit disk and returns the sites in it.
  std::vector<Vec2> toUnitDisk(std::span<const Vec2> sites);
  void fit(const std::vector<Vec2>& sites, const Eigen::VectorXd& values);

  struct Disk {
    Vec2 center; ///< in the unit disk
    double radius;

    bool isFar(const KernelTerm& term) const {
      return (term.site - center).norm() * LocalExpansion::maxRatio > radius;
    }
  };

  /// Conversion from mm to the unit disk.
  double toDiskX(double x) const { return (x - m_origin.x()) * m_invScale - m_centroid.x(); }
  double toDiskY(double y) const { return (y - m_origin.y()) * m_invScale - m_centroid.y(); }
  /// Bounding disk of a tile.
  Disk boundTile(std::span<const double> x, std::span<const double> y) const;

  /// Sum of w'_i phi(|u - u_i|) for |u| > 1, where the terms are as large as |u|^2 ln |u|^2 and
  /// nearly cancel. With e_i = |u - u_i|^2 - |u|^2 and P' w' = 0 the sum is m ln |u|^2 +
  /// sum w'_i (|u|^2 + e_i) ln(1 + e_i / |u|^2) with the moment m, and its terms are at most 4 |u|.
  Points evaluateFarTerms(const Points& u, double v) const;

  Vec2 m_origin = Vec2::Zero();    ///< mm; one of the sites, so that differences are exact
  Vec2 m_centroid = Vec2::Zero();  ///< from the origin, in radii: c = origin + s centroid
  double m_invScale = 1.0;         ///< 1 / s, mm^-1
  double m_lambda = 0.0;           ///< lambda / s^2
  Vec3 m_plane = Vec3::Zero();     ///< a', in the unit disk
  double m_moment = 0.0;           ///< sum of w'_i |u_i|^2
  std::vector<KernelTerm> m_terms; ///< sites in the unit disk
};

} // namespace fenestra::core
