#pragma once
// Direct solver of symmetric linear equations in which unknowns depend on near ones only.

#include <cstddef>
#include <vector>

namespace fenestra::core {

/// Factorizes a positive definite matrix into L D L' (Golub and Van Loan 2013, section 4.1).
class BandSolver {
public:
  /// `width`: coefficients farther from the diagonal are 0.
  BandSolver(std::size_t size, std::size_t width);

  /// A coefficient; row - width <= column <= row.
  double& at(std::size_t row, std::size_t column) { return values(row)[column]; }

  /// Solves for one right-hand side, once.
  std::vector<double> solve(std::vector<double> right);

private:
  /// The coefficients of a row, by column.
  double* values(std::size_t row) { return m_values.data() + (row + 1) * m_width; }
  std::size_t firstColumn(std::size_t row) const { return row < m_width ? 0 : row - m_width; }
  void factorize();

  std::size_t m_size, m_width;
  /// Per row, width + 1 coefficients, up to the diagonal: row r and column c are at
  /// r * (width + 1) + width + c - r = (r + 1) * width + c.
  std::vector<double> m_values;
};

} // namespace fenestra::core
