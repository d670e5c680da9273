// Right-triangulated irregular network (Evans, Kirkpatrick and Townsend, Algorithmica 30, 2001).
// Squares are split along a diagonal. Right triangles are split recursively, from the right angle
// to the midpoint of the hypotenuse. The two triangles at a hypotenuse are split together, so that
// the mesh has no T-junctions.

#include "clip/mesh/SurfaceMesh.h"

#include "clip/focus/Footprints.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace fenestra::core {

namespace {

constexpr double noDepth = std::numeric_limits<double>::quiet_NaN();

/// Bounding rectangle of the samples that have a depth. Columns and rows are relative to it.
class MeshSamples {
public:
  MeshSamples(const ClipDepth& clip, const Domain& volume)
      : m_camera(clip.camera), m_clip(clip), m_buffer(*clip.buffer) {
    const DomainFootprint footprint(m_camera, volume);
    for (std::int64_t row = 0; row < m_buffer.rows(); ++row)
      m_footprint.push_back(footprint.columns(m_buffer, row));
    findRectangle();
    if (m_rows == 0)
      return;
    for (std::int64_t row = 0; row < m_rows; ++row) {
      m_y.push_back(m_buffer.yAxis().coordinate(m_firstRow + row));
      for (std::int64_t column = 0; column < m_columns; ++column)
        m_depths.push_back(findDepth(m_firstColumn + column, m_firstRow + row));
    }
    for (std::int64_t column = 0; column < m_columns; ++column)
      m_x.push_back(m_buffer.xAxis().coordinate(m_firstColumn + column));
  }

  std::int64_t columns() const { return m_columns; }
  std::int64_t rows() const { return m_rows; }
  std::size_t sample(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>(row * m_columns + column);
  }
  /// Depth of a sample, mm; NaN if it has none.
  double depth(std::int64_t column, std::int64_t row) const {
    return m_depths[sample(column, row)];
  }
  const double* rowDepths(std::int64_t row) const { return m_depths.data() + sample(0, row); }
  Vec2 position(std::int64_t column, std::int64_t row) const {
    return {x()[column], m_y[static_cast<std::size_t>(row)]};
  }
  /// Coordinates of all columns, mm.
  const double* x() const { return m_x.data(); }
  /// Continuous column at x, mm.
  double column(double x) const {
    return m_buffer.xAxis().index(x) - static_cast<double>(m_firstColumn);
  }

  Vec3 point(std::int64_t column, std::int64_t row) const {
    const Vec2 at = position(column, row);
    return fromBuffer(m_camera, {at.x(), at.y(), depth(column, row)});
  }
  bool isPerspective() const { return m_camera.pose().projection == Projection::perspective; }

private:
  /// Bounds all samples of the footprint that have a depth.
  void findRectangle() {
    std::int64_t endColumn = 0, endRow = 0;
    m_firstColumn = m_buffer.columns();
    m_firstRow = m_buffer.rows();
    for (std::int64_t row = 0; row < m_buffer.rows(); ++row) {
      const DomainFootprint::Columns covered = m_footprint[static_cast<std::size_t>(row)];
      for (std::int64_t column = covered.first; column < covered.end; ++column)
        if (hasDepth(column, row)) {
          m_firstColumn = std::min(m_firstColumn, column);
          endColumn = std::max(endColumn, column + 1);
          m_firstRow = std::min(m_firstRow, row);
          endRow = row + 1;
        }
    }
    m_columns = std::max(std::int64_t{0}, endColumn - m_firstColumn);
    m_rows = std::max(std::int64_t{0}, endRow - m_firstRow);
  }

  bool hasDepth(std::int64_t column, std::int64_t row) const {
    const double depth = m_buffer.at(m_buffer.sample(column, row));
    return std::isfinite(depth) && !isBehindCamera(m_camera, depth);
  }

  /// Depth of a buffer sample, mm; NaN if none, or if no cell of the footprint has this corner.
  double findDepth(std::int64_t column, std::int64_t row) const {
    DomainFootprint::Columns nearby{m_buffer.columns(), 0};
    for (std::int64_t near = std::max(std::int64_t{0}, row - 1);
         near < std::min(m_buffer.rows(), row + 2); ++near) {
      const DomainFootprint::Columns covered = m_footprint[static_cast<std::size_t>(near)];
      if (covered.first < covered.end)
        nearby = {std::min(nearby.first, covered.first), std::max(nearby.end, covered.end)};
    }
    const bool isCorner = column + 1 >= nearby.first && column <= nearby.end;
    if (!isCorner || !hasDepth(column, row))
      return noDepth;
    return m_clip.silhouette ? m_clip.surfaceDepth(m_buffer.position(column, row))
                             : m_buffer.at(m_buffer.sample(column, row));
  }

  const Camera& m_camera;
  const ClipDepth& m_clip;
  const DepthBuffer& m_buffer;
  std::vector<DomainFootprint::Columns> m_footprint; ///< per row of the buffer
  std::int64_t m_firstColumn = 0, m_firstRow = 0, m_columns = 0, m_rows = 0;
  std::vector<double> m_x, m_y;
  std::vector<double> m_depths; ///< row by row
};

/// Corner of a triangle: column and row of a sample. Squares may extend beyond the samples; such
/// corners are clamped to the last column and row, and triangles without area are skipped.
struct Corner {
  std::int64_t column, row;
};

/// Right triangle with its right angle at `apex`. Split from the apex to the midpoint of a and b.
struct Triangle {
  Corner a, b, apex;
};

/// Two triangles with the common hypotenuse a-b, which are split together.
struct Pair {
  Corner a, b;
  std::array<Corner, 2> apexes;
};

/// Square (column, row) among squares of edge `side`. Its diagonal starts at the corner that is
/// also the midpoint of the parent square, so that split triangles nest.
Pair makeSquarePair(std::int64_t column, std::int64_t row, std::int64_t side) {
  const bool isLeft = column % 2 != 0, isUpper = row % 2 != 0;
  const std::int64_t left = column * side, upper = row * side;
  const Corner odd{isLeft ? left : left + side, isUpper ? upper : upper + side};
  const Corner even{isLeft ? left + side : left, isUpper ? upper + side : upper};
  return {odd, even, {{{odd.column, even.row}, {even.column, odd.row}}}};
}

/// Triangles on both sides of the edge of length 2 s, between two squares, with this midpoint.
Pair makeEdgePair(const Corner& middle, std::int64_t s) {
  const Corner left{middle.column - s, middle.row}, right{middle.column + s, middle.row};
  const Corner upper{middle.column, middle.row - s}, lower{middle.column, middle.row + s};
  return middle.column / s % 2 != 0 ? Pair{left, right, {upper, lower}}
                                    : Pair{upper, lower, {left, right}};
}

/// Plane of a triangle. Its height, linear in (x, y), is the depth, in perspective 1 / depth.
class MeshPlane {
public:
  MeshPlane(const std::array<Vec3, 3>& corners, bool isPerspective)
      : m_isPerspective(isPerspective), m_origin(corners[0].head<2>()) {
    const auto height = [&](const Vec3& at) { return isPerspective ? 1.0 / at.z() : at.z(); };
    const Vec2 u = (corners[1] - corners[0]).head<2>(), v = (corners[2] - corners[0]).head<2>();
    m_height = height(corners[0]);
    const double du = height(corners[1]) - m_height, dv = height(corners[2]) - m_height;
    const double area = u.x() * v.y() - u.y() * v.x();
    m_slope = Vec2(du * v.y() - dv * u.y(), dv * u.x() - du * v.x()) / area;
  }

  /// True if all samples of a row segment at y have a depth within `tolerance` of the plane.
  bool isNear(const double* x, const double* depths, std::int64_t count, double y,
              double tolerance) const {
    const double start = m_height + m_slope.y() * (y - m_origin.y()) - m_slope.x() * m_origin.x();
    std::int64_t near = 0;
    for (std::int64_t i = 0; i < count; ++i) {
      const double height = start + m_slope.x() * x[i];
      // |1 / height - depth| <= tolerance, without a division
      const double error = m_isPerspective ? 1.0 - height * depths[i] : height - depths[i];
      near += std::abs(error) <= (m_isPerspective ? tolerance * height : tolerance) ? 1 : 0;
    }
    return near == count;
  }

private:
  bool m_isPerspective;
  Vec2 m_origin, m_slope;
  double m_height;
};

class MeshBuilder {
public:
  MeshBuilder(const MeshSamples& samples, double tolerance)
      : m_samples(samples),
        m_tolerance(tolerance),
        m_lastColumn(samples.columns() - 1),
        m_lastRow(samples.rows() - 1),
        m_side(static_cast<std::int64_t>(
            std::bit_ceil(static_cast<std::uint64_t>(std::min(m_lastColumn, m_lastRow))))),
        m_squaresAcross((m_lastColumn + m_side - 1) / m_side),
        m_squaresDown((m_lastRow + m_side - 1) / m_side),
        m_isSplit(static_cast<std::size_t>((m_squaresAcross * m_side + 1) *
                                           (m_squaresDown * m_side + 1))),
        m_pointIndices(samples.sample(0, samples.rows()), noPoint) {}

  SurfaceMesh build() {
    markSplits();
    for (std::int64_t row = 0; row < m_squaresDown; ++row)
      for (std::int64_t column = 0; column < m_squaresAcross; ++column) {
        const auto [a, b, apexes] = makeSquarePair(column, row, m_side);
        for (const Corner& apex : apexes)
          addTriangles(area({a, b, apex}) > 0 ? Triangle{a, b, apex} : Triangle{b, a, apex});
      }
    return std::move(m_mesh);
  }

private:
  static constexpr auto noPoint = std::numeric_limits<std::uint32_t>::max();

  /// Marks the pairs to split, from the smallest to the largest: all inaccurate pairs, and all
  /// pairs that contain a marked one.
  void markSplits() {
    for (std::int64_t s = 1; s < m_side; s *= 2) {
      for (std::int64_t row = 0; row - s < m_lastRow; row += s)
        for (std::int64_t column = row / s % 2 == 0 ? s : 0; column - s < m_lastColumn;
             column += 2 * s)
          markSplit({column, row}, makeEdgePair({column, row}, s));
      for (std::int64_t row = 0; 2 * s * row < m_lastRow; ++row)
        for (std::int64_t column = 0; 2 * s * column < m_lastColumn; ++column)
          markSplit({(2 * column + 1) * s, (2 * row + 1) * s}, makeSquarePair(column, row, 2 * s));
    }
  }

  void markSplit(const Corner& middle, const Pair& pair) {
    const auto mustSplit = [&](const Corner& apex) {
      return isInside(apex) && !isAccurate({pair.a, pair.b, apex});
    };
    if (!isSplit(middle) && !std::ranges::any_of(pair.apexes, mustSplit))
      return;
    m_isSplit[index(middle)] = true;
    for (const Corner& apex : pair.apexes) // an apex is the midpoint of the parent pair
      if (isInside(apex))
        m_isSplit[index(apex)] = true;
  }

  /// True if the corner lies in the squares, which may extend beyond the samples.
  bool isInside(const Corner& corner) const {
    return corner.column >= 0 && corner.column <= m_squaresAcross * m_side && corner.row >= 0 &&
           corner.row <= m_squaresDown * m_side;
  }
  std::size_t index(const Corner& corner) const {
    return static_cast<std::size_t>(corner.row * (m_squaresAcross * m_side + 1) + corner.column);
  }
  bool isSplit(const Corner& middle) const { return m_isSplit[index(middle)]; }

  Corner clampToSamples(const Corner& corner) const {
    return {std::min(corner.column, m_lastColumn), std::min(corner.row, m_lastRow)};
  }
  Triangle clampToSamples(const Triangle& t) const {
    return {clampToSamples(t.a), clampToSamples(t.b), clampToSamples(t.apex)};
  }
  double depth(const Corner& corner) const {
    const Corner sample = clampToSamples(corner);
    return m_samples.depth(sample.column, sample.row);
  }
  /// Twice the area, in samples; > 0: counterclockwise as seen from the camera.
  static std::int64_t area(const Triangle& triangle) {
    const auto& [a, b, apex] = triangle;
    return (b.row - a.row) * (apex.column - a.column) - (b.column - a.column) * (apex.row - a.row);
  }

  /// True if no split is needed: all samples are within tolerance, or none has a depth.
  bool isAccurate(const Triangle& triangle) const {
    const auto [a, b, apex] = clampToSamples(triangle);
    if (area({a, b, apex}) == 0)
      return true;
    std::array corners{a, b, apex};
    const auto missing =
        std::ranges::count_if(corners, [&](const Corner& c) { return std::isnan(depth(c)); });
    if (missing == 1 || missing == 2)
      return false;
    std::ranges::sort(corners, {}, &Corner::row);
    std::array<Vec3, 3> points;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec2 at = m_samples.position(corners[i].column, corners[i].row);
      points[i] = {at.x(), at.y(), depth(corners[i])};
    }
    const MeshPlane plane(points, m_samples.isPerspective());
    for (std::int64_t row = corners[0].row; row <= corners[2].row; ++row) {
      const double y = m_samples.position(0, row).y();
      const auto [first, end] = findColumns(points, y);
      const double* depths = m_samples.rowDepths(row);
      const bool isRowAccurate =
          missing == 0
              ? plane.isNear(m_samples.x() + first, depths + first, end - first, y, m_tolerance)
              : std::all_of(depths + first, depths + end, [](double d) { return std::isnan(d); });
      if (!isRowAccurate)
        return false;
    }
    return true;
  }

  /// Columns [first, end) in and on a triangle at y. `points`: sorted by row.
  std::pair<std::int64_t, std::int64_t> findColumns(const std::array<Vec3, 3>& points,
                                                    double y) const {
    constexpr double rounding = 1e-6; // of a column
    const auto interpolateX = [&](const Vec3& from, const Vec3& to) {
      const double height = to.y() - from.y();
      return height == 0.0 ? from.x() : from.x() + (to.x() - from.x()) * (y - from.y()) / height;
    };
    const double longEdge = interpolateX(points[0], points[2]);
    const bool isUpper = std::abs(y - points[0].y()) < std::abs(points[1].y() - points[0].y());
    const double shortEdge =
        isUpper ? interpolateX(points[0], points[1]) : interpolateX(points[1], points[2]);
    return {static_cast<std::int64_t>(
                std::ceil(m_samples.column(std::min(longEdge, shortEdge)) - rounding)),
            static_cast<std::int64_t>(
                std::floor(m_samples.column(std::max(longEdge, shortEdge)) + rounding)) +
                1};
  }

  void addTriangles(const Triangle& triangle) {
    const auto& [a, b, apex] = triangle;
    const bool isSmallest = std::abs(a.column - b.column) == 1;
    const Corner middle{(a.column + b.column) / 2, (a.row + b.row) / 2};
    if (!isSmallest && isSplit(middle)) {
      addTriangles({apex, a, middle});
      addTriangles({b, apex, middle});
    } else if (!std::isnan(depth(a)) && !std::isnan(depth(b)) && !std::isnan(depth(apex))) {
      add(triangle);
    } else if (isSmallest) {
      addCornerTriangle(triangle);
    }
  }

  /// Adds the triangle of a cell whose diagonal has a depth at only one end: that end and both
  /// apexes. Called for both halves of the cell; only the upper half adds it.
  void addCornerTriangle(const Triangle& half) {
    const auto& [a, b, apex] = half;
    const Corner opposite{a.column + b.column - apex.column, a.row + b.row - apex.row};
    if (apex.row > opposite.row || std::isnan(depth(apex)) || std::isnan(depth(opposite)))
      return;
    if (!std::isnan(depth(a)))
      add({a, opposite, apex});
    else if (!std::isnan(depth(b)))
      add({b, apex, opposite});
  }

  void add(const Triangle& triangle) {
    if (area(clampToSamples(triangle)) != 0)
      m_mesh.triangles.push_back(
          {pointIndex(triangle.a), pointIndex(triangle.b), pointIndex(triangle.apex)});
  }

  /// Index of the corner's point, which is added on first use.
  std::uint32_t pointIndex(const Corner& corner) {
    const Corner sample = clampToSamples(corner);
    std::uint32_t& point = m_pointIndices[m_samples.sample(sample.column, sample.row)];
    if (point == noPoint) {
      point = static_cast<std::uint32_t>(m_mesh.points.size());
      m_mesh.points.push_back(m_samples.point(sample.column, sample.row));
      m_mesh.depths.push_back(static_cast<float>(depth(sample)));
    }
    return point;
  }

  const MeshSamples& m_samples;
  double m_tolerance;
  std::int64_t m_lastColumn, m_lastRow;
  std::int64_t m_side; ///< edge of the initial squares, in samples; a power of two
  std::int64_t m_squaresAcross, m_squaresDown;
  std::vector<bool> m_isSplit;               ///< per midpoint of a pair
  std::vector<std::uint32_t> m_pointIndices; ///< per sample: index of its point
  SurfaceMesh m_mesh;
};

} // namespace

SurfaceMesh buildSurfaceMesh(const ClipDepth& clip, const Domain& volume, double tolerance) {
  const MeshSamples samples(clip, volume);
  if (samples.columns() < 2 || samples.rows() < 2)
    return {};
  return MeshBuilder(samples, tolerance).build();
}

} // namespace fenestra::core
