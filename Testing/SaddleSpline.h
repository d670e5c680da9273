#pragma once
// Reference thin plate spline for tests, solved from the textbook equations without rescaling.

#include "base/Vector.h"

#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace fenestra::core::testing_clipping {

/// Saddle-point system in mm, [K + lambda I, P; P', 0] [w; a] = [z; 0] with lambda = (1 - p) / p.
/// Solved in Scalar by Gaussian elimination with partial pivoting: a library's solver takes a
/// minute to compile for such a Scalar. Requires p > 0 and sites that determine a plane.
template <typename Scalar>
class SaddleSpline {
public:
  SaddleSpline(std::span<const Vec2> sites, std::span<const double> values, double smoothing)
      : m_sites(sites.begin(), sites.end()) {
    const std::size_t n = m_sites.size();
    std::vector<Row> system(n + 3, Row(n + 4, Scalar(0)));
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < i; ++j)
        system[i][j] = system[j][i] = kernel(m_sites[i], m_sites[j]);
      system[i][i] = (Scalar(1) - Scalar(smoothing)) / Scalar(smoothing);
      system[i][n] = system[n][i] = Scalar(1);
      system[i][n + 1] = system[n + 1][i] = Scalar(m_sites[i].x());
      system[i][n + 2] = system[n + 2][i] = Scalar(m_sites[i].y());
      system[i][n + 3] = Scalar(values[i]);
    }
    m_solution = solve(std::move(system));
  }

  /// f(x), computed in Scalar and rounded to double.
  double operator()(const Vec2& x) const {
    const std::size_t n = m_sites.size();
    Scalar sum =
        m_solution[n] + m_solution[n + 1] * Scalar(x.x()) + m_solution[n + 2] * Scalar(x.y());
    for (std::size_t i = 0; i < n; ++i)
      sum += m_solution[i] * kernel(x, m_sites[i]);
    return static_cast<double>(sum);
  }

private:
  using Row = std::vector<Scalar>;

  /// Solution of A x = b. `rows`: augmented matrix [A b].
  static Row solve(std::vector<Row> rows) {
    using std::abs;
    const std::size_t count = rows.size();
    for (std::size_t k = 0; k < count; ++k) {
      std::size_t pivot = k;
      for (std::size_t i = k + 1; i < count; ++i)
        if (abs(rows[i][k]) > abs(rows[pivot][k]))
          pivot = i;
      std::swap(rows[k], rows[pivot]);
      for (std::size_t i = k + 1; i < count; ++i) {
        const Scalar factor = rows[i][k] / rows[k][k];
        for (std::size_t j = k + 1; j <= count; ++j)
          rows[i][j] -= factor * rows[k][j];
      }
    }
    Row x(count, Scalar(0));
    for (std::size_t k = count; k-- > 0;) {
      x[k] = rows[k][count];
      for (std::size_t j = k + 1; j < count; ++j)
        x[k] -= rows[k][j] * x[j];
      x[k] /= rows[k][k];
    }
    return x;
  }

  static Scalar kernel(const Vec2& a, const Vec2& b) {
    using std::log;
    const Scalar dx = Scalar(a.x()) - Scalar(b.x()), dy = Scalar(a.y()) - Scalar(b.y());
    const Scalar squared = dx * dx + dy * dy;
    return squared > Scalar(0) ? Scalar(squared * log(squared)) : Scalar(0);
  }

  std::vector<Vec2> m_sites;
  Row m_solution;
};

} // namespace fenestra::core::testing_clipping
