#include "model/masks/ContourFill.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <tuple>
#include <utility>

namespace fenestra::core {
namespace {

constexpr std::size_t noPlane = std::numeric_limits<std::size_t>::max();

/// The planes from which a slice is interpolated; equal: its outline is that of one plane.
struct SlicePlanes {
  std::size_t lower = noPlane, upper = noPlane;
  double fraction = 0.0; ///< of the way from lower to upper
};

SlicePlanes findPlanes(const std::vector<ContourPlane>& planes, double z,
                       const ContourReach& reach) {
  const auto after = std::ranges::lower_bound(planes, z, {}, &ContourPlane::z);
  const auto upper = static_cast<std::size_t>(after - planes.begin());
  const bool hasUpper = upper < planes.size();
  const bool hasLower = upper > 0;
  if (hasUpper && planes[upper].z == z)
    return {upper, upper};
  if (hasUpper && hasLower) {
    const double gap = planes[upper].z - planes[upper - 1].z;
    if (gap <= reach.widestGap)
      return {upper - 1, upper, (z - planes[upper - 1].z) / gap};
  }
  if (hasLower && z - planes[upper - 1].z < reach.halfSlab)
    return {upper - 1, upper - 1};
  if (hasUpper && planes[upper].z - z <= reach.halfSlab)
    return {upper, upper};
  return {};
}

/// Voxels inside prisms over the planes' polygons: each slice has the outline of one plane.
std::optional<std::vector<VoxelRun>> fillPrisms(const std::vector<ContourPlane>& planes,
                                                const std::vector<SlicePlanes>& slices,
                                                std::size_t SlicePlanes::*plane,
                                                const Size3& size) {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const auto addWalls = [&](const std::vector<Vec2>& polygon, double bottom, double top) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const auto first = static_cast<std::uint32_t>(points.size());
      for (const double z : {bottom, top}) {
        points.emplace_back(a.x(), a.y(), z);
        points.emplace_back(b.x(), b.y(), z);
      }
      triangles.push_back({first, first + 1, first + 2});
      triangles.push_back({first + 1, first + 3, first + 2});
    }
  };
  for (std::size_t begin = 0, end = 0; begin < slices.size(); begin = end) {
    const std::size_t index = slices[begin].*plane;
    for (end = begin + 1; end < slices.size() && slices[end].*plane == index;)
      ++end;
    if (index != noPlane)
      for (const std::vector<Vec2>& polygon : planes[index].polygons)
        addWalls(polygon, static_cast<double>(begin) - 0.5, static_cast<double>(end) - 0.5);
  }
  constexpr std::size_t maxPoints = std::numeric_limits<std::uint32_t>::max();
  return points.size() < maxPoints ? voxelizeSurface(points, triangles, size) : std::nullopt;
}

/// Distances to a plane's outline. Edges that occur twice, as those to a keyhole do, are no part of
/// it.
class Outline {
public:
  Outline(const ContourPlane& plane, const Vec2& spacing, std::int64_t rows)
      : m_spacing(spacing), m_edgesOfRow(static_cast<std::size_t>(rows)) {
    for (const std::vector<Vec2>& polygon : plane.polygons)
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        m_edges.push_back(std::minmax(std::array{a.x(), a.y()}, std::array{b.x(), b.y()}));
      }
    std::ranges::sort(m_edges);
    removePairs();
    for (std::size_t i = 0; i < m_edges.size(); ++i) {
      const auto [low, high] = std::minmax(m_edges[i].first[1], m_edges[i].second[1]);
      const std::size_t last = toRow(high);
      for (std::size_t row = toRow(low); row <= last && m_work <= maxWork; ++row, ++m_work)
        m_edgesOfRow[row].push_back(i);
    }
  }

  /// False: distances would take too long.
  bool isUsable() const { return m_work <= maxWork; }

  /// Distance of a voxel center to the outline, mm.
  double distance(std::int64_t x, std::int64_t y) {
    double least = infinity;
    const auto rows = static_cast<std::int64_t>(m_edgesOfRow.size());
    for (std::int64_t r = 0; r < rows && static_cast<double>(r - 1) * m_spacing.y() <= least; ++r)
      for (const std::int64_t row : {y - r, y + r})
        if (row >= 0 && row < rows && (r > 0 || row == y))
          least = std::min(least, distanceToRow(static_cast<std::size_t>(row), x, y));
    return least;
  }

private:
  using Point = std::array<double, 2>;
  static constexpr std::int64_t maxWork = 2'000'000'000;

  void removePairs() {
    std::size_t count = 0;
    for (std::size_t i = 0; i < m_edges.size();)
      if (i + 1 < m_edges.size() && m_edges[i] == m_edges[i + 1])
        i += 2;
      else
        m_edges[count++] = m_edges[i++];
    m_edges.resize(count);
  }

  std::size_t toRow(double y) const {
    return static_cast<std::size_t>(
        std::clamp(std::floor(y), 0.0, static_cast<double>(m_edgesOfRow.size() - 1)));
  }

  double distanceToRow(std::size_t row, std::int64_t x, std::int64_t y) {
    const Vec2 at(static_cast<double>(x) * m_spacing.x(), static_cast<double>(y) * m_spacing.y());
    double least = infinity;
    for (const std::size_t i : m_edgesOfRow[row]) {
      const auto& [first, second] = m_edges[i];
      const Vec2 a(first[0] * m_spacing.x(), first[1] * m_spacing.y());
      const Vec2 b(second[0] * m_spacing.x(), second[1] * m_spacing.y());
      const Vec2 edge = b - a;
      const double length2 = edge.dot(edge);
      const double t = length2 > 0.0 ? std::clamp((at - a).dot(edge) / length2, 0.0, 1.0) : 0.0;
      least = std::min(least, (at - a - t * edge).norm());
    }
    m_work += static_cast<std::int64_t>(m_edgesOfRow[row].size());
    return least;
  }

  Vec2 m_spacing;
  std::vector<std::pair<Point, Point>> m_edges;
  std::vector<std::vector<std::size_t>> m_edgesOfRow; ///< that cross y to y + 1
  std::int64_t m_work = 0;
};

/// Combines the runs of two planes in one row.
class RowInterpolation {
public:
  RowInterpolation(const std::vector<ContourPlane>& planes, const Size3& size, const Vec2& spacing)
      : m_planes(planes), m_size(size), m_spacing(spacing), m_sides(std::size_t(size.x())) {}

  /// Appends the runs inside to `runs`. Returns false if that takes too long.
  bool append(const SlicePlanes& slice, std::span<const VoxelRun> lower,
              std::span<const VoxelRun> upper, std::vector<VoxelRun>& runs) {
    std::int64_t first = m_size.x(), last = 0;
    for (const auto& [list, bit] : {std::pair(lower, 1), std::pair(upper, 2)})
      for (const VoxelRun& run : list) {
        first = std::min(first, run.first);
        last = std::max(last, run.last);
        for (std::int64_t x = run.first; x < run.last; ++x)
          m_sides[static_cast<std::size_t>(x)] |= static_cast<std::uint8_t>(bit);
      }
    const VoxelRun& any = lower.empty() ? upper.front() : lower.front();
    for (std::int64_t x = first; x < last; ++x) {
      const int sides = std::exchange(m_sides[static_cast<std::size_t>(x)], std::uint8_t{0});
      if (sides == 0 || (sides != 3 && !isInside(slice, sides == 1, x, any.y)))
        continue;
      if (!runs.empty() && runs.back().z == any.z && runs.back().y == any.y &&
          runs.back().last == x)
        ++runs.back().last;
      else
        runs.push_back({any.y, any.z, x, x + 1});
    }
    return m_isUsable;
  }

private:
  /// For a voxel inside the outline of one plane only.
  bool isInside(const SlicePlanes& slice, bool isInLower, std::int64_t x, std::int64_t y) {
    Outline &lower = findOutline(slice.lower), &upper = findOutline(slice.upper);
    m_isUsable = m_isUsable && lower.isUsable() && upper.isUsable();
    if (!m_isUsable)
      return false;
    const double a = (1.0 - slice.fraction) * lower.distance(x, y),
                 b = slice.fraction * upper.distance(x, y);
    return isInLower ? a > b : b > a;
  }

  Outline& findOutline(std::size_t plane) {
    auto& outline = m_outlines[plane];
    if (!outline) {
      if (m_outlines.size() > 3) // rows are sorted by slice: earlier planes are not needed
        std::erase_if(m_outlines, [&](const auto& one) { return one.first + 1 < plane; });
      m_outlines[plane] = std::make_unique<Outline>(m_planes[plane], m_spacing, m_size.y());
    }
    return *m_outlines[plane];
  }

  const std::vector<ContourPlane>& m_planes;
  Size3 m_size;
  Vec2 m_spacing;
  std::vector<std::uint8_t> m_sides; ///< of each voxel in the row; bits: in lower, in upper
  std::map<std::size_t, std::unique_ptr<Outline>> m_outlines;
  bool m_isUsable = true;
};

/// The runs at the start of `runs` that are in one row; removes them from it.
std::span<const VoxelRun> takeRow(std::span<const VoxelRun>& runs, std::int64_t y, std::int64_t z) {
  std::size_t count = 0;
  while (count < runs.size() && runs[count].y == y && runs[count].z == z)
    ++count;
  const auto row = runs.first(count);
  runs = runs.subspan(count);
  return row;
}

} // namespace

std::optional<std::vector<VoxelRun>> fillContours(const std::vector<ContourPlane>& planes,
                                                  const Size3& size, const Vec2& spacing,
                                                  const ContourReach& reach) {
  std::vector<SlicePlanes> slices;
  for (std::int64_t z = 0; z < size.z(); ++z)
    slices.push_back(findPlanes(planes, static_cast<double>(z), reach));
  const auto lower = fillPrisms(planes, slices, &SlicePlanes::lower, size),
             upper = fillPrisms(planes, slices, &SlicePlanes::upper, size);
  if (!lower || !upper)
    return std::nullopt;
  std::vector<VoxelRun> runs;
  RowInterpolation rows(planes, size, spacing);
  std::span<const VoxelRun> lowerLeft = *lower, upperLeft = *upper;
  const auto place = [](const VoxelRun& run) { return std::tuple(run.z, run.y); };
  while (!lowerLeft.empty() || !upperLeft.empty()) {
    const bool isLowerNext =
        upperLeft.empty() || (!lowerLeft.empty() && place(lowerLeft[0]) <= place(upperLeft[0]));
    const auto [z, y] = place(isLowerNext ? lowerLeft[0] : upperLeft[0]);
    const auto lowerRow = takeRow(lowerLeft, y, z), upperRow = takeRow(upperLeft, y, z);
    const SlicePlanes& slice = slices[static_cast<std::size_t>(z)];
    if (slice.lower == slice.upper)
      runs.insert(runs.end(), lowerRow.begin(), lowerRow.end());
    else if (!rows.append(slice, lowerRow, upperRow, runs))
      return std::nullopt;
  }
  return runs;
}

} // namespace fenestra::core
