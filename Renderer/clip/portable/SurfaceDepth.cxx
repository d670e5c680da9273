#include "clip/portable/SurfaceDepth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace fenestra::core {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Indices of samples: the first and last.
struct Range {
  int first, last;
};

/// The samples between three positions, of `count`. Not with std::ceil, which can be a slow call.
Range findSamples(double a, double b, double c, int count) {
  // Clamped before the conversion: far points exceed the range of int.
  const double low = std::clamp(std::min(std::min(a, b), c), -1.0, static_cast<double>(count));
  const double high = std::clamp(std::max(std::max(a, b), c), -1.0, count - 0.5);
  const int first = static_cast<int>(low), last = static_cast<int>(high);
  return {std::max(first < low ? first + 1 : first, 0), last > high ? last - 1 : last};
}

/// Linear function of a sample's column and row.
struct Plane {
  double atOrigin, perColumn, perRow;

  double operator()(int column, int row) const {
    return atOrigin + perColumn * column + perRow * row;
  }
};

/// A corner of a triangle, in samples.
struct SampleCorner {
  double x, y, nearness;
};

/// Raises the nearness to that of a triangle, at the samples in the triangle.
void drawTriangle(const std::array<SampleCorner, 3>& c, const SampleGrid& grid,
                  std::vector<float>& nearness) {
  const Range rows = findSamples(c[0].y, c[1].y, c[2].y, grid.rows);
  const Range columns = findSamples(c[0].x, c[1].x, c[2].x, grid.columns);
  const double x1 = c[1].x - c[0].x, y1 = c[1].y - c[0].y;
  const double x2 = c[2].x - c[0].x, y2 = c[2].y - c[0].y;
  const double area = x1 * y2 - y1 * x2;
  if (rows.first > rows.last || columns.first > columns.last || area == 0.0)
    return;
  const auto makePlane = [&](double perColumn, double perRow) { // 0 at the first corner
    return Plane{-perColumn * c[0].x - perRow * c[0].y, perColumn, perRow};
  };
  // Fractions of the way from the first corner to the others.
  const double perArea = 1.0 / area;
  const Plane first = makePlane(y2 * perArea, -x2 * perArea);
  const Plane second = makePlane(-y1 * perArea, x1 * perArea);
  const double rise1 = c[1].nearness - c[0].nearness, rise2 = c[2].nearness - c[0].nearness;
  constexpr double tolerance = 1e-9; // so that rounding opens no gaps between triangles
  for (int row = rows.first; row <= rows.last; ++row) {
    float* const line =
        &nearness[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns)];
    for (int column = columns.first; column <= columns.last; ++column) {
      const double f1 = first(column, row), f2 = second(column, row);
      if (std::min(std::min(f1, f2), 1.0 - f1 - f2) >= -tolerance)
        line[column] =
            std::max(line[column], static_cast<float>(c[0].nearness + f1 * rise1 + f2 * rise2));
    }
  }
}

} // namespace

ClosedSurface::ClosedSurface(SurfaceTriangles triangles) : m_triangles(std::move(triangles)) {
  struct Side {
    std::uint32_t low, high, triangle;
    bool isSameEdge(const Side& other) const { return low == other.low && high == other.high; }
  };
  std::vector<Side> sides;
  sides.reserve(corners().size());
  for (std::size_t i = 0; i + 2 < corners().size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(corners()[i + k], corners()[i + (k + 1) % 3]);
      sides.push_back({low, high, static_cast<std::uint32_t>(i / 3)});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  for (std::size_t first = 0; first < sides.size();) {
    std::size_t end = first + 1;
    while (end < sides.size() && sides[end].isSameEdge(sides[first]))
      ++end;
    if (end - first == 2)
      m_edges.push_back({{sides[first].low, sides[first].high},
                         {sides[first].triangle, sides[first + 1].triangle}});
    first = end;
  }
}

ProjectedSurface::ProjectedSurface(const ClosedSurface& surface, const ViewFrame& view)
    : m_surface(surface),
      m_isPerspective(view.isPerspective),
      m_bounds{infinite, -infinite, infinite, -infinite} {
  const std::vector<float>& points = surface.points();
  m_corners.reserve(points.size() / 3);
  for (std::size_t i = 0; i + 2 < points.size(); i += 3) {
    std::array<double, 3> at;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto& row = view.toView[axis];
      at[axis] = row[0] * double{points[i]} + row[1] * double{points[i + 1]} +
                 row[2] * double{points[i + 2]} + row[3];
    }
    addPoint(at[0], at[1], at[2], view.targetDepth);
  }
  m_isFacing.resize(surface.corners().size() / 3);
  for (std::size_t triangle = 0; triangle < m_isFacing.size(); ++triangle)
    m_isFacing[triangle] = isFacing(triangle) ? 1 : 0;
}

void ProjectedSurface::addPoint(double right, double up, double depth, double targetDepth) {
  const double perDepth = depth > 0.0 ? 1.0 / depth : 0.0; // 0: behind the camera
  const double scale = m_isPerspective ? targetDepth * perDepth : 1.0;
  const Corner corner{scale * right, scale * up, m_isPerspective ? perDepth : -depth};
  m_corners.push_back(corner);
  if (!isInFront(corner)) {
    m_isCameraOutside = false;
    return;
  }
  m_bounds.lowerX = std::min(m_bounds.lowerX, corner.x);
  m_bounds.upperX = std::max(m_bounds.upperX, corner.x);
  m_bounds.lowerY = std::min(m_bounds.lowerY, corner.y);
  m_bounds.upperY = std::max(m_bounds.upperY, corner.y);
}

bool ProjectedSurface::isFacing(std::size_t triangle) const {
  const std::uint32_t* const corners = &m_surface.corners()[3 * triangle];
  const Corner &a = m_corners[corners[0]], &b = m_corners[corners[1]], &c = m_corners[corners[2]];
  return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y) > 0.0;
}

std::vector<ProjectedSurface::ContourEdge> ProjectedSurface::findContour() const {
  std::vector<ContourEdge> contour;
  for (const ClosedSurface::Edge& edge : m_surface.edges()) {
    if (m_isFacing[edge.triangles[0]] == m_isFacing[edge.triangles[1]])
      continue;
    const Corner &a = m_corners[edge.points[0]], &b = m_corners[edge.points[1]];
    if (isInFront(a) && isInFront(b))
      contour.push_back({{{{a.x, a.y, toDepth(a.nearness)}, {b.x, b.y, toDepth(b.nearness)}}}});
  }
  return contour;
}

std::vector<float> ProjectedSurface::findDepths(const SampleGrid& grid) const {
  const float farthest = m_isPerspective ? 0.0F : -std::numeric_limits<float>::infinity();
  std::vector<float> depths(
      static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows), farthest);
  const double perMm = 1.0 / grid.pitch;
  const std::vector<std::uint32_t>& corners = m_surface.corners();
  for (std::size_t triangle = 0; triangle < m_isFacing.size(); ++triangle) {
    if (m_isCameraOutside && m_isFacing[triangle] == 0) // hidden by others
      continue;
    std::array<SampleCorner, 3> c;
    bool areInFront = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner& corner = m_corners[corners[3 * triangle + k]];
      areInFront = areInFront && isInFront(corner);
      c[k] = {(corner.x - grid.x) * perMm, (grid.y - corner.y) * perMm, corner.nearness};
    }
    if (areInFront)
      drawTriangle(c, grid, depths);
  }
  for (float& depth : depths)
    depth = toDepth(depth);
  return depths;
}

} // namespace fenestra::core
