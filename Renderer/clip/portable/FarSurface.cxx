#include "clip/portable/FarSurface.h"

#include "clip/portable/BandSolver.h"
#include "clip/portable/FillAxis.h"
#include "clip/portable/SmoothFill.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace fenestra::core {
namespace {

/// Side of a known sample toward a sample that is not known.
struct BoundarySide {
  std::size_t column, row; ///< of the known sample
  bool isAlongX;           ///< the two samples are neighbors in x
  double length;           ///< mm
  double slope;            ///< of the known depths across the side, along x or y, limited
};

/// Slope of the depths from one sample to another, of which the latter is known, along an axis on
/// which they are `distance` (of either sign) apart: limited to maxFarSlope; 0 if the former is not
/// known.
double findSlope(const FillGrid& grid, std::size_t from, std::size_t to, double distance) {
  if (grid.isKnown[from] == 0)
    return 0.0;
  const double slope = (double{grid.depths[to]} - double{grid.depths[from]}) / distance;
  return std::clamp(slope, -maxFarSlope, maxFarSlope);
}

/// Calls function(side) for each side of the boundary.
template <typename Function>
void forEachBoundarySide(const FillGrid& grid, const Function& function) {
  const std::size_t columns = grid.x.size(), rows = grid.y.size();
  const FillAxis x(grid.x), y(grid.y);
  // The sides of a sample across an axis; `i`: its number on the axis, `stride`: to the next one.
  const auto visit = [&](BoundarySide side, const std::vector<double>& axis, std::size_t i,
                         std::size_t at, std::size_t stride) {
    const bool hasBefore = i > 0, hasAfter = i + 1 < axis.size();
    if (hasBefore && grid.isKnown[at - stride] == 0) {
      side.slope = hasAfter ? findSlope(grid, at + stride, at, axis[i] - axis[i + 1]) : 0.0;
      function(side);
    }
    if (hasAfter && grid.isKnown[at + stride] == 0) {
      side.slope = hasBefore ? findSlope(grid, at - stride, at, axis[i] - axis[i - 1]) : 0.0;
      function(side);
    }
  };
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column)
      if (const std::size_t at = row * columns + column; grid.isKnown[at] != 0) {
        visit({column, row, true, y.width(row), 0.0}, grid.x, column, at, 1);
        visit({column, row, false, x.width(column), 0.0}, grid.y, row, at, columns);
      }
}

/// The three splines at a position: their values, and slopes per pitch.
struct Splines {
  std::array<double, 3> values, slopes;

  explicit Splines(double t)
      : values{0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)},
        slopes{t - 0.5, -2.0 * t, t + 0.5} {}
};

/// Term of a linear combination of unknowns.
struct Term {
  std::size_t unknown;
  double factor;
};

} // namespace

/// Normal equations of a sum of squares.
struct FarSurface::Equations {
  Equations(std::size_t count, std::size_t width) : matrix(count, width), right(count, 0.0) {}

  /// Adds weight * (combination of the terms - value)².
  template <typename Terms>
  void addSquare(const Terms& terms, double weight, double value) {
    for (const Term& a : terms) {
      right[a.unknown] += weight * a.factor * value;
      for (const Term& b : terms)
        if (b.unknown <= a.unknown)
          matrix.at(a.unknown, b.unknown) += weight * a.factor * b.factor;
    }
  }

  BandSolver matrix;
  std::vector<double> right;
};

FarSurface::FarSurface(const FillGrid& grid, double length) {
  placeNodes(grid, length);
  Equations equations(m_x.count * m_y.count, 2 * std::min(m_x.count, m_y.count) + 2);
  addEnergy(equations, findOpenness(grid), length);
  if (addBoundary(equations, grid, length))
    m_weights = equations.matrix.solve(std::move(equations.right));
  else
    m_weights = std::move(equations.right); // 0
}

/// Nodes up to a few lengths from the known samples, where the surface is level. They are a quarter
/// of `length` apart, farther only if the samples are, or the view is much wider than the volume.
void FarSurface::placeNodes(const FillGrid& grid, double length) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  double left = infinite, right = -infinite, bottom = infinite, top = -infinite;
  const std::uint8_t* isKnown = grid.isKnown.data();
  for (const double y : grid.y)
    for (const double x : grid.x)
      if (*isKnown++ != 0) {
        left = std::min(left, x);
        right = std::max(right, x);
        bottom = std::min(bottom, y);
        top = std::max(top, y);
      }
  const double margin = 4.0 * length;
  const auto [minX, maxX] = std::minmax(grid.x.front(), grid.x.back());
  const auto [minY, maxY] = std::minmax(grid.y.front(), grid.y.back());
  left = std::max(left - margin, minX);
  right = std::min(right + margin, maxX);
  bottom = std::max(bottom - margin, minY);
  top = std::min(top + margin, maxY);
  constexpr double maxNodes = 96.0; // per axis
  m_pitch = std::max(0.25 * length, std::max(right - left, top - bottom) / maxNodes);
  const double spacing = std::min(FillAxis(grid.x).pitch(), FillAxis(grid.y).pitch());
  if (std::isfinite(spacing)) // else there is one sample
    m_pitch = std::max(m_pitch, spacing);
  m_x = makeAxis(left, right);
  m_y = makeAxis(bottom, top);
}

/// Nodes at multiples of the pitch, so that they do not move with the samples.
FarSurface::Axis FarSurface::makeAxis(double low, double high) const {
  const double first = std::round(low / m_pitch) - 1.0, last = std::round(high / m_pitch) + 1.0;
  return {first * m_pitch, static_cast<std::size_t>(last - first) + 1};
}

/// Positions beyond the nodes are moved to them.
FarSurface::Position FarSurface::locate(const Axis& axis, double at) const {
  const double last = static_cast<double>(axis.count) - 1.5;
  const double position = std::clamp((at - axis.first) / m_pitch, 0.5, last);
  const std::size_t first = std::min(static_cast<std::size_t>(position - 0.5), axis.count - 3);
  return {first, position - 1.0 - static_cast<double>(first)};
}

/// Per node, the fraction of its area that is not known, for the plate lies only there; a little
/// everywhere, so that all depths are defined.
std::vector<double> FarSurface::findOpenness(const FillGrid& grid) const {
  std::vector<double> openness(m_x.count * m_y.count, 1.0);
  const FillAxis columns(grid.x), rows(grid.y);
  std::vector<double> known(m_x.count); // integrals of the splines over the known part of a row
  for (std::size_t row = 0; row < grid.y.size(); ++row) {
    std::fill(known.begin(), known.end(), 0.0);
    for (std::size_t column = 0; column < grid.x.size(); ++column)
      if (grid.isKnown[row * grid.x.size() + column] != 0) {
        const auto [first, offset] = locate(m_x, grid.x[column]);
        const Splines x(offset);
        for (std::size_t i = 0; i < 3; ++i)
          known[first + i] += columns.width(column) * x.values[i];
      }
    const auto [first, offset] = locate(m_y, grid.y[row]);
    const Splines y(offset);
    for (std::size_t j = 0; j < 3; ++j) {
      const double weight = rows.width(row) * y.values[j] / (m_pitch * m_pitch);
      for (std::size_t column = 0; column < m_x.count; ++column)
        openness[index(column, first + j)] -= weight * known[column];
    }
  }
  constexpr double least = 1e-3;
  for (double& open : openness)
    open = std::max(open, least);
  return openness;
}

/// Finite differences of the splines' weights, which are their exact second derivatives along each
/// axis.
void FarSurface::addEnergy(Equations& equations, const std::vector<double>& openness,
                           double length) const {
  const double bending = 1.0 / (m_pitch * m_pitch); // of a squared difference
  const double tension = 1.0 / (length * length);
  std::vector<Term> terms;
  for (std::size_t row = 0; row < m_y.count; ++row)
    for (std::size_t column = 0; column < m_x.count; ++column) {
      const std::size_t at = index(column, row);
      terms.clear();
      const auto addNeighbor = [&](std::size_t neighbor) {
        terms.push_back({neighbor, 1.0});
        if (neighbor > at)
          equations.addSquare(std::array{Term{at, -1.0}, Term{neighbor, 1.0}},
                              tension * std::min(openness[at], openness[neighbor]), 0.0);
      };
      if (row > 0)
        addNeighbor(index(column, row - 1));
      if (column > 0)
        addNeighbor(index(column - 1, row));
      if (column + 1 < m_x.count)
        addNeighbor(index(column + 1, row));
      if (row + 1 < m_y.count)
        addNeighbor(index(column, row + 1));
      terms.push_back({at, -static_cast<double>(terms.size())});
      equations.addSquare(terms, bending * openness[at], 0.0);
    }
}

/// Returns whether there is a boundary.
bool FarSurface::addBoundary(Equations& equations, const FillGrid& grid, double length) const {
  const double a = 0.1 * length, b = 0.03 * length;
  bool hasBoundary = false;
  forEachBoundarySide(grid, [&](const BoundarySide& side) {
    hasBoundary = true;
    const auto [firstColumn, offsetX] = locate(m_x, grid.x[side.column]);
    const auto [firstRow, offsetY] = locate(m_y, grid.y[side.row]);
    const Splines x(offsetX), y(offsetY);
    std::array<Term, 9> depth, slope;
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t node = index(firstColumn + i, firstRow + j);
        depth[3 * j + i] = {node, x.values[i] * y.values[j]};
        slope[3 * j + i] = {
            node,
            (side.isAlongX ? x.slopes[i] * y.values[j] : x.values[i] * y.slopes[j]) / m_pitch};
      }
    equations.addSquare(depth, side.length / (a * a * a),
                        double{grid.depths[side.row * grid.x.size() + side.column]});
    equations.addSquare(slope, side.length / b, side.slope);
  });
  return hasBoundary;
}

void FarSurface::findRow(const std::vector<double>& x, double y, std::vector<float>& depths) const {
  const auto [firstRow, offsetY] = locate(m_y, y);
  const Splines down(offsetY);
  std::vector<double> weights(m_x.count, 0.0); // of the splines along x
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t column = 0; column < m_x.count; ++column)
      weights[column] += down.values[j] * m_weights[index(column, firstRow + j)];
  depths.clear();
  for (const double at : x) {
    const auto [first, offset] = locate(m_x, at);
    const Splines across(offset);
    depths.push_back(static_cast<float>(across.values[0] * weights[first] +
                                        across.values[1] * weights[first + 1] +
                                        across.values[2] * weights[first + 2]));
  }
}

} // namespace fenestra::core
