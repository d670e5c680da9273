#include "clip/portable/BandSolver.h"

#include <algorithm>

namespace fenestra::core {
namespace {

/// Sum of products. Several partial sums, so that the processor does not wait for each addition.
double dot(const double* a, const double* b, std::size_t count) {
  constexpr std::size_t parts = 8;
  double sums[parts] = {};
  std::size_t i = 0;
  for (; i + parts <= count; i += parts)
    for (std::size_t part = 0; part < parts; ++part)
      sums[part] += a[i + part] * b[i + part];
  double sum = 0.0;
  for (; i < count; ++i)
    sum += a[i] * b[i];
  for (const double part : sums)
    sum += part;
  return sum;
}

} // namespace

BandSolver::BandSolver(std::size_t size, std::size_t width)
    : m_size(size), m_width(width), m_values(size * (width + 1), 0.0) {}

/// Replaces the coefficients by those of L, and the diagonal by D.
void BandSolver::factorize() {
  for (std::size_t row = 0; row < m_size; ++row) {
    double* const own = values(row);
    const std::size_t first = firstColumn(row);
    for (std::size_t column = first; column < row; ++column) // L D
      own[column] -= dot(own + first, values(column) + first, column - first);
    for (std::size_t column = first; column < row; ++column) {
      const double scaled = own[column];
      own[column] /= values(column)[column];
      own[row] -= scaled * own[column];
    }
  }
}

std::vector<double> BandSolver::solve(std::vector<double> right) {
  factorize();
  for (std::size_t row = 0; row < m_size; ++row) {
    const std::size_t first = firstColumn(row);
    right[row] -= dot(values(row) + first, right.data() + first, row - first);
  }
  for (std::size_t row = 0; row < m_size; ++row)
    right[row] /= at(row, row);
  for (std::size_t row = m_size; row-- > 0;)
    for (std::size_t column = firstColumn(row); column < row; ++column)
      right[column] -= at(row, column) * right[row];
  return right;
}

} // namespace fenestra::core
