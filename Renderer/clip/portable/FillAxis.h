#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace fenestra::core {

/// Weights of the two neighbors in a second derivative along an axis, mm^-2.
struct Stencil {
  float before, after;
};

/// Sample coordinates, mm, and stencils of one axis. Boundary condition: slope 0 at both ends.
class FillAxis {
public:
  explicit FillAxis(std::vector<double> coordinates) : m_at(std::move(coordinates)) {
    const std::size_t last = m_at.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
      const double before = i == 0 ? 0.0 : spacing(i - 1);
      const double after = i == last ? 0.0 : spacing(i);
      const double width = i == 0 ? after : i == last ? before : 0.5 * (before + after);
      m_width.push_back(width > 0.0 ? width : 1.0);
      m_before.push_back(weight(width * before));
      m_after.push_back(weight(width * after));
      m_maxWeightSum = std::max(m_maxWeightSum, double{m_before[i]} + m_after[i]);
    }
  }

  std::size_t size() const { return m_at.size(); }
  /// Distance from sample i to the next, mm.
  double spacing(std::size_t i) const { return std::abs(m_at[i + 1] - m_at[i]); }
  FillAxis coarsen() const {
    std::vector<double> coarse;
    for (std::size_t i = 0; i < m_at.size(); i += 2)
      coarse.push_back(0.5 * (m_at[i] + m_at[std::min(i + 1, m_at.size() - 1)]));
    return FillAxis(std::move(coarse));
  }

  Stencil stencil(std::size_t i) const { return {m_before[i], m_after[i]}; }
  const float* before() const { return m_before.data(); }
  const float* after() const { return m_after.data(); }
  double maxWeightSum() const { return m_maxWeightSum; } ///< largest before + after
  /// Smallest distance of two samples, mm; infinity for a single sample.
  double pitch() const { return 1.0 / std::sqrt(0.5 * m_maxWeightSum); }
  double width(std::size_t i) const { return m_width[i]; } ///< of sample i, mm; 1 for a single one

private:
  static float weight(double area) { return area > 0.0 ? static_cast<float>(1.0 / area) : 0.0f; }

  std::vector<double> m_at, m_width;
  std::vector<float> m_before, m_after; ///< of the stencils
  double m_maxWeightSum = 0.0;
};

} // namespace fenestra::core
