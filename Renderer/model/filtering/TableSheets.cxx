#include "model/filtering/TableSheets.h"

#include "model/masks/Rows.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace fenestra::core {
namespace {

constexpr double cellEdge = 2.0;      ///< mm
constexpr double leastPresence = 0.5; ///< of the slices
constexpr double leastPiece = 30.0;   ///< mm, across; fingers are narrower
constexpr double leastWidth = 100.0;  ///< mm, of all pieces
constexpr std::size_t mostPieces = 16;
constexpr double mostConflict = 0.001; ///< of bodies above a top: their part below it

using Tops = std::vector<std::int64_t>;

struct Cells {
  explicit Cells(const SolidVoxels& solid) {
    for (int axis = 0; axis < 3; ++axis) {
      factor[axis] = std::max<std::int64_t>(1, std::llround(cellEdge / solid.spacing[axis]));
      size[axis] = (solid.size[axis] + factor[axis] - 1) / factor[axis];
      edge[axis] = solid.spacing[axis] * static_cast<double>(factor[axis]);
    }
    Marks empty(static_cast<std::size_t>(size.prod()), 1);
    forEachRow(size, [&](std::int64_t y, std::int64_t z, std::size_t row) {
      for (std::int64_t k = z * factor.z(); k < std::min((z + 1) * factor.z(), solid.size.z()); ++k)
        for (std::int64_t j = y * factor.y(); j < std::min((y + 1) * factor.y(), solid.size.y());
             ++j)
          for (std::int64_t i = 0; i < solid.size.x(); ++i)
            if (solid.at(i, j, k))
              empty[row + static_cast<std::size_t>(i / factor.x())] = 0;
    });
    separate(empty);
  }

  Size3 factor, size; ///< voxels per cell; cells
  Vec3 edge;          ///< mm
  Marks thick, thin;  ///< opening of the solid cells by a ball, and what that removes

private:
  void separate(const Marks& empty) {
    const Grid grid(size, Affine(Mat3::Diagonal(edge)));
    const auto radius = static_cast<float>(0.5 * thickestSheet);
    Marks eroded(empty.size());
    const float reach = radius + static_cast<float>(edge.maxCoeff()); // rounded corners, too
    std::ranges::transform(computeDistances(empty, grid, reach), eroded.begin(),
                           [&](float away) { return away > radius; });
    const std::vector<float> away = computeDistances(eroded, grid, 1.01F * reach);
    thick.resize(empty.size());
    thin.resize(empty.size());
    for (std::size_t i = 0; i < empty.size(); ++i) {
      thick[i] = !empty[i] && away[i] <= reach;
      thin[i] = !empty[i] && !thick[i];
    }
  }
};

/// Per column, the uppermost row with thin cells in enough slices; -1: none.
Tops findTops(const Cells& cells) {
  const Size3& size = cells.size;
  Tops tops(static_cast<std::size_t>(size.x()), -1);
  for (std::int64_t x = 0; x < size.x(); ++x)
    for (std::int64_t y = 0; y < size.y() && tops[static_cast<std::size_t>(x)] < 0; ++y) {
      std::int64_t present = 0;
      for (std::int64_t z = 0; z < size.z(); ++z)
        present += cells.thin[linearIndex({x, y, z}, size)];
      if (static_cast<double>(present) >= leastPresence * static_cast<double>(size.z()))
        tops[static_cast<std::size_t>(x)] = y;
    }
  return tops;
}

/// Adjacent columns whose tops differ by at most a cell.
struct Piece {
  std::size_t begin, end;
};

std::vector<Piece> findPieces(const Tops& tops, double edge) {
  std::vector<Piece> pieces;
  for (std::size_t begin = 0; begin < tops.size();) {
    std::size_t end = begin + 1;
    while (end < tops.size() && tops[begin] >= 0 && tops[end] >= 0 &&
           std::abs(tops[end] - tops[end - 1]) <= 1)
      ++end;
    if (tops[begin] >= 0 && static_cast<double>(end - begin) * edge >= leastPiece)
      pieces.push_back({begin, end});
    begin = end;
  }
  return pieces;
}

/// Columns on a parabola through two pieces, or one.
struct Candidate {
  double meanRow = 0.0;
  std::size_t columns = 0;
  std::vector<bool> onParabola = {};
  Parabola parabola = {};
};

Candidate makeCandidate(const Tops& tops, const Piece& a, const Piece& b) {
  std::vector<std::pair<double, double>> points;
  for (const Piece& piece : {a, b})
    for (std::size_t x = piece.begin; x < piece.end; ++x)
      points.emplace_back(static_cast<double>(x), static_cast<double>(tops[x]));
  const std::optional<Parabola> parabola = Parabola::fit(points);
  Candidate candidate;
  if (!parabola)
    return candidate;
  candidate.parabola = *parabola;
  candidate.onParabola.resize(tops.size());
  for (std::size_t x = 0; x < tops.size(); ++x) {
    const double distance = static_cast<double>(tops[x]) - parabola->at(static_cast<double>(x));
    if (tops[x] < 0 || !(std::abs(distance) <= 1.0))
      continue;
    candidate.onParabola[x] = true;
    candidate.meanRow += static_cast<double>(tops[x]);
    ++candidate.columns;
  }
  candidate.meanRow /= static_cast<double>(std::max<std::size_t>(1, candidate.columns));
  return candidate;
}

/// Wide candidates, the uppermost first.
std::vector<Candidate> findCandidates(const Tops& tops, double edge) {
  const std::vector<Piece> pieces = findPieces(tops, edge);
  std::vector<Candidate> candidates;
  if (pieces.size() > mostPieces)
    return candidates;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    for (std::size_t j = i; j < pieces.size(); ++j) {
      Candidate candidate = makeCandidate(tops, pieces[i], pieces[j]);
      if (static_cast<double>(candidate.columns) * edge >= leastWidth)
        candidates.push_back(std::move(candidate));
    }
  std::ranges::stable_sort(candidates, [](const Candidate& a, const Candidate& b) {
    // Rows closer than a cell are one sheet.
    return std::pair(std::floor(0.5 * a.meanRow), b.columns) <
           std::pair(std::floor(0.5 * b.meanRow), a.columns);
  });
  return candidates;
}

/// Keeps the columns' own tops on the parabola and at its raised edges; fills the columns between.
Tops completeTops(const Tops& tops, const Candidate& candidate) {
  Tops result(tops.size(), -1);
  const auto first = static_cast<std::size_t>(std::ranges::find(candidate.onParabola, true) -
                                              candidate.onParabola.begin());
  std::size_t last = tops.size() - 1;
  while (!candidate.onParabola[last])
    --last;
  for (std::size_t x = first; x <= last; ++x)
    result[x] = candidate.onParabola[x]
                    ? tops[x]
                    : std::llround(candidate.parabola.at(static_cast<double>(x)));
  for (std::size_t x = first; x-- > 0 && tops[x] >= 0;)
    result[x] = tops[x];
  for (std::size_t x = last + 1; x < tops.size() && tops[x] >= 0; ++x)
    result[x] = tops[x];
  return result;
}

/// Thick bodies, connected parts, that are above and below the top of a table.
class Conflict {
public:
  /// `below`: first rows below the table's sheet; -1: outside of it.
  Conflict(const Cells& cells, const Tops& below) : m_cells(cells), m_below(below) {
    Marks visited(cells.thick.size());
    for (std::size_t i = 0; i < visited.size(); ++i)
      if (cells.thick[i] && !visited[i])
        visit(i, visited);
  }

  bool isSmall() const { return m_conflict <= mostConflict * m_all; }

private:
  void visit(std::size_t seed, Marks& visited) {
    const Size3& size = m_cells.size;
    std::vector<std::size_t> part = {seed};
    visited[seed] = 1;
    double above = 0.0, under = 0.0;
    for (std::size_t k = 0; k < part.size(); ++k) {
      const auto i = static_cast<std::int64_t>(part[k]);
      const Size3 cell(i % size.x(), i / size.x() % size.y(), i / (size.x() * size.y()));
      const std::int64_t below = m_below[static_cast<std::size_t>(cell.x())];
      (below >= 0 && cell.y() >= below ? under : above) += 1.0;
      for (int axis = 0; axis < 3; ++axis)
        for (const int step : {-1, 1}) {
          const Size3 next = cell + step * Size3::Unit(axis);
          if (next[axis] < 0 || next[axis] >= size[axis])
            continue;
          const std::size_t to = linearIndex(next, size);
          if (m_cells.thick[to] && !visited[to]) {
            visited[to] = 1;
            part.push_back(to);
          }
        }
    }
    m_all += above;
    if (above > 0.0)
      m_conflict += std::min(above, under);
  }

  const Cells& m_cells;
  const Tops& m_below;
  double m_all = 0.0, m_conflict = 0.0;
};

} // namespace

std::optional<Parabola> Parabola::fit(const std::vector<std::pair<double, double>>& points) {
  if (points.size() < 3)
    return std::nullopt;
  const double middle = 0.5 * (points.front().first + points.back().first);
  const double scale = std::max(1.0, 0.5 * std::abs(points.back().first - points.front().first));
  Mat3 matrix = Mat3::Zero();
  Vec3 right = Vec3::Zero();
  for (const auto& [x, y] : points) {
    const double t = (x - middle) / scale;
    const Vec3 powers(1.0, t, t * t);
    for (int i = 0; i < 3; ++i)
      matrix.col(i) = matrix.col(i) + powers[i] * powers;
    right = right + y * powers;
  }
  if (!(std::abs(matrix.determinant()) > 1e-6))
    return std::nullopt;
  const Vec3 s = matrix.inverse() * right;
  const double b = s[1] / scale, c = s[2] / (scale * scale);
  return Parabola{s[0] - middle * (b - middle * c), b - 2.0 * middle * c, c};
}

bool mayHaveSheet(const SolidVoxels& solid) {
  const Size3& size = solid.size;
  std::vector<std::int64_t> present(static_cast<std::size_t>(size.x() * size.y()));
  tbb::parallel_for(std::int64_t{0}, size.y(), [&](std::int64_t y) {
    for (std::int64_t z = 0; z < size.z(); ++z)
      for (std::int64_t x = 0; x < size.x(); ++x)
        present[static_cast<std::size_t>(x + y * size.x())] += solid.at(x, y, z);
  });
  const auto isPresent = [&](std::int64_t x, std::int64_t y) {
    return y < size.y() &&
           static_cast<double>(present[static_cast<std::size_t>(x + y * size.x())]) >=
               leastPresence * static_cast<double>(size.z());
  };
  double width = 0.0;
  for (std::int64_t x = 0; x < size.x(); ++x) {
    bool isThin = false;
    for (std::int64_t y = 0; y < size.y() && !isThin; ++y) {
      const std::int64_t first = y;
      while (isPresent(x, y))
        ++y;
      isThin = y > first &&
               static_cast<double>(y - first) * solid.spacing.y() < thickestSheet + 2.0 * cellEdge;
    }
    width += isThin ? solid.spacing.x() : 0.0;
  }
  return width >= leastWidth;
}

std::int64_t Sheet::row(std::int64_t column) const {
  const auto cell = static_cast<std::size_t>(column / factor.x());
  const bool isContact = isBetweenPieces(column) && !onParabola[cell];
  return tops[cell] < 0 || isContact ? -1 : tops[cell] * factor.y();
}

bool Sheet::isFree(std::int64_t column, std::int64_t slice) const {
  const std::int64_t x = column / factor.x(), top = tops[static_cast<std::size_t>(x)];
  const auto reach = static_cast<std::int64_t>(greatestSag / cellEdge);
  for (std::int64_t y = std::max<std::int64_t>(0, top - reach);
       y <= std::min(top + reach, size.y() - 1); ++y)
    if (thick[linearIndex({x, y, slice / factor.z()}, size)])
      return false;
  return true;
}

bool Sheet::isBetweenPieces(std::int64_t column) const {
  const auto cell = static_cast<std::ptrdiff_t>(column / factor.x());
  return std::find(onParabola.begin(), onParabola.begin() + cell, true) !=
             onParabola.begin() + cell &&
         std::find(onParabola.begin() + cell, onParabola.end(), true) != onParabola.end();
}

std::optional<Sheet> findSheet(const SolidVoxels& solid) {
  Cells cells(solid);
  const Tops tops = findTops(cells);
  const auto thickest = static_cast<std::int64_t>(std::ceil(thickestSheet / cells.edge.y()));
  for (const Candidate& candidate : findCandidates(tops, cells.edge.x())) {
    Sheet sheet{cells.factor, cells.size, completeTops(tops, candidate), candidate.onParabola, {}};
    Tops below = sheet.tops;
    for (std::size_t x = 0; x < below.size(); ++x)
      if (below[x] >= 0 && !candidate.onParabola[x])
        below[x] += thickest; // the patient may lie on the sheet
    if (!Conflict(cells, below).isSmall())
      continue;
    sheet.thick = std::move(cells.thick);
    return sheet;
  }
  return std::nullopt;
}

} // namespace fenestra::core
