#pragma once
// Direct solver of symmetric linear equations in which unknowns depend on near ones only.

#include <cstddef>
#include <vector>

namespace fenestra::core {

/// Factorizes a positive definite matrix into L D L' (Golub and Van Loan 2013, section 4.1), in
/// panels of four rows: the processor reads each coefficient once for four sums.
class BandSolver {
public:
  /// `width`: coefficients farther from the diagonal are 0.
  BandSolver(std::size_t size, std::size_t width);

  /// A coefficient; row - width <= column <= row.
  double& at(std::size_t row, std::size_t column) {
    return values(row / panel, column)[row % panel];
  }

  /// Solves for one right-hand side, once.
  std::vector<double> solve(std::vector<double> right);

private:
  static constexpr std::size_t panel = 4; ///< rows

  /// The coefficients of a column in the rows of a panel.
  double* values(std::size_t number, std::size_t column) {
    return m_values.data() + panel * (number * m_width + m_width + column);
  }
  std::size_t firstColumn(std::size_t number) const {
    return panel * number < m_width ? 0 : panel * number - m_width;
  }
  void eliminate(std::size_t number);
  void factorizeDiagonal(std::size_t number);

  std::size_t m_panels;
  std::size_t m_width; ///< columns of a panel before its diagonal: a multiple of its rows
  /// Per panel, the columns from `m_width` before the diagonal to its end, of four rows each.
  std::vector<double> m_values;
  std::vector<double> m_inverse; ///< of D
};

} // namespace fenestra::core
