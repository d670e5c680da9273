#include "clip/portable/BandSolver.h"

#include <utility>

namespace fenestra::core {

BandSolver::BandSolver(std::size_t size, std::size_t width)
    : m_panels((size + panel - 1) / panel),
      m_width((width + panel - 1) / panel * panel),
      m_values(panel * m_panels * (m_width + panel), 0.0),
      m_inverse(panel * m_panels, 0.0) {
  for (std::size_t row = size; row < panel * m_panels; ++row) // completes the last panel
    at(row, row) = 1.0;
}

/// Replaces the panel's coefficients before its diagonal by those of L D.
void BandSolver::eliminate(std::size_t number) {
  const std::size_t first = firstColumn(number);
  for (std::size_t other = first / panel; other < number; ++other) {
    double sums[panel][panel] = {}; // per column of the other panel's diagonal, and own row
    const double* own = values(number, first);
    const double* factor = values(other, first);
    for (std::size_t column = first; column < panel * other; ++column) {
      for (std::size_t j = 0; j < panel; ++j)
        for (std::size_t i = 0; i < panel; ++i)
          sums[j][i] += factor[j] * own[i];
      own += panel;
      factor += panel;
    }
    double* const tile = values(number, panel * other);
    for (std::size_t j = 0; j < panel; ++j) {
      for (std::size_t k = 0; k < j; ++k)
        for (std::size_t i = 0; i < panel; ++i)
          sums[j][i] += factor[panel * k + j] * tile[panel * k + i];
      for (std::size_t i = 0; i < panel; ++i)
        tile[panel * j + i] -= sums[j][i];
    }
  }
}

/// Replaces the panel's coefficients, L D before its diagonal, by L; computes the inverse of D.
void BandSolver::factorizeDiagonal(std::size_t number) {
  double sums[panel][panel] = {};
  double* own = values(number, firstColumn(number));
  const auto addColumn = [&](std::size_t column) {
    double scaled[panel];
    for (std::size_t i = 0; i < panel; ++i)
      scaled[i] = own[i] * m_inverse[column];
    for (std::size_t j = 0; j < panel; ++j)
      for (std::size_t i = 0; i < panel; ++i)
        sums[j][i] += scaled[j] * own[i];
    for (std::size_t i = 0; i < panel; ++i)
      own[i] = scaled[i];
    own += panel;
  };
  for (std::size_t column = firstColumn(number); column < panel * number; ++column)
    addColumn(column);
  for (std::size_t j = 0; j < panel; ++j) {
    for (std::size_t i = j; i < panel; ++i)
      own[i] -= sums[j][i];
    m_inverse[panel * number + j] = 1.0 / own[j];
    addColumn(panel * number + j);
  }
}

std::vector<double> BandSolver::solve(std::vector<double> right) {
  const std::size_t size = right.size();
  right.resize(panel * m_panels);
  for (std::size_t number = 0; number < m_panels; ++number) {
    eliminate(number);
    factorizeDiagonal(number);
    for (std::size_t column = firstColumn(number); column < panel * (number + 1); ++column)
      for (std::size_t i = 0; i < panel; ++i)
        if (panel * number + i > column)
          right[panel * number + i] -= values(number, column)[i] * right[column];
  }
  for (std::size_t row = 0; row < right.size(); ++row)
    right[row] *= m_inverse[row];
  for (std::size_t number = m_panels; number-- > 0;) {
    double* const own = right.data() + panel * number;
    for (std::size_t column = panel * (number + 1); column-- > firstColumn(number);)
      for (std::size_t i = 0; i < panel; ++i)
        if (panel * number + i > column)
          right[column] -= values(number, column)[i] * own[i];
  }
  right.resize(size);
  return right;
}

} // namespace fenestra::core
