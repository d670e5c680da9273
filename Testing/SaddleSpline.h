#pragma once
// The thin plate spline as its equations stand, for tests: no unit disc, no null space.

#include "core/Vector.h"

#include <Eigen/LU>

#include <span>
#include <vector>

namespace fenestra::testing_clipping {

/// The plain saddle system in mm, [K + lambda I, P; P', 0] [w; a] = [z; 0] with
/// lambda = (1 - p) / p, solved in Scalar. p is above 0, and the sites determine a plane.
template <typename Scalar>
class SaddleSpline {
public:
  SaddleSpline(std::span<const Vec2> sites, std::span<const double> values, double smoothing)
      : m_sites(sites.begin(), sites.end()) {
    const auto n = std::ssize(m_sites);
    Matrix system = Matrix::Zero(n + 3, n + 3);
    Vector right = Vector::Zero(n + 3);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Vec2& site = m_sites[static_cast<std::size_t>(i)];
      for (Eigen::Index j = 0; j < i; ++j)
        system(i, j) = system(j, i) = kernel(site, m_sites[static_cast<std::size_t>(j)]);
      system(i, i) = (Scalar(1) - Scalar(smoothing)) / Scalar(smoothing);
      system(i, n) = system(n, i) = Scalar(1);
      system(i, n + 1) = system(n + 1, i) = Scalar(site.x());
      system(i, n + 2) = system(n + 2, i) = Scalar(site.y());
      right[i] = Scalar(values[static_cast<std::size_t>(i)]);
    }
    m_solution = system.partialPivLu().solve(right);
  }

  /// f, rounded at last.
  double operator()(const Vec2& x) const {
    const auto n = std::ssize(m_sites);
    Scalar sum =
        m_solution[n] + m_solution[n + 1] * Scalar(x.x()) + m_solution[n + 2] * Scalar(x.y());
    for (Eigen::Index i = 0; i < n; ++i)
      sum += m_solution[i] * kernel(x, m_sites[static_cast<std::size_t>(i)]);
    return static_cast<double>(sum);
  }

private:
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  static Scalar kernel(const Vec2& a, const Vec2& b) {
    using std::log;
    const Scalar dx = Scalar(a.x()) - Scalar(b.x()), dy = Scalar(a.y()) - Scalar(b.y());
    const Scalar squared = dx * dx + dy * dy;
    return squared > Scalar(0) ? Scalar(squared * log(squared)) : Scalar(0);
  }

  std::vector<Vec2> m_sites;
  Vector m_solution;
};

} // namespace fenestra::testing_clipping
