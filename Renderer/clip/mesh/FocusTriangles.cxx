#include "clip/mesh/FocusTriangles.h"

#include <array>

namespace fenestra::core {
namespace {

/// Cells between voxel centers, including those between the outermost voxels and the 0 around them:
/// cell (1, 1, 1) begins at voxel (0, 0, 0).
class SurfaceNet {
public:
  SurfaceNet(const Mask& mask, const Grid& volume)
      : m_mask(mask),
        m_volume(volume),
        m_cells(mask.grid.size.array() + 1),
        m_level(0.5 * mask.maxValue) {
    const auto cellsPerSlice = static_cast<std::size_t>(m_cells.x() * m_cells.y());
    m_below.resize(cellsPerSlice);
    m_slice.resize(cellsPerSlice);
  }

  SurfaceMesh build() {
    for (std::int64_t z = 0; z < m_cells.z(); ++z) {
      for (std::int64_t y = 0; y < m_cells.y(); ++y)
        for (std::int64_t x = 0; x < m_cells.x(); ++x)
          addCell({x, y, z});
      std::swap(m_below, m_slice);
    }
    return std::move(m_surface);
  }

private:
  double value(const Size3& voxel) const {
    const bool isInside =
        (voxel.array() >= 0).all() && (voxel.array() < m_mask.grid.size.array()).all();
    return isInside ? m_mask.voxels[linearIndex(voxel, m_mask.grid.size)] : 0.0;
  }
  bool isFocus(double value) const { return value >= m_level; }

  /// Adds the point of a cell, and the triangles around the edges from its first corner, whose
  /// other cells have their points.
  void addCell(const Size3& cell) {
    const Size3 first = cell.array() - 1;
    std::array<double, 8> corners;
    int inside = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      corners[i] = value(first + offset(i));
      inside += isFocus(corners[i]) ? 1 : 0;
    }
    if (inside == 0 || inside == 8)
      return;
    addPoint(first, corners);
    for (int axis = 0; axis < 3; ++axis) {
      const bool isFirst = isFocus(corners[0]);
      if (isFirst != isFocus(corners[std::size_t{1} << axis]))
        addQuad(cell, axis, isFirst);
    }
  }

  static Size3 offset(std::size_t corner) {
    const auto i = static_cast<std::int64_t>(corner);
    return {i & 1, i >> 1 & 1, i >> 2};
  }

  void addPoint(const Size3& first, const std::array<double, 8>& corners) {
    Vec3 sum = Vec3::Zero();
    double count = 0.0;
    for (std::size_t a = 0; a < 8; ++a)
      for (const std::size_t step : {1U, 2U, 4U}) {
        const std::size_t b = a | step;
        if (b == a || isFocus(corners[a]) == isFocus(corners[b]))
          continue;
        const double fraction = (m_level - corners[a]) / (corners[b] - corners[a]);
        sum += offset(a).cast<double>() + fraction * (offset(b) - offset(a)).cast<double>();
        count += 1.0;
      }
    const Vec3 inCell = moveToLevel(sum / count, corners);
    const Vec3 world = m_mask.grid.indexToWorld * Vec3(first.cast<double>() + inCell);
    const Vec3 last = m_volume.size.cast<double>() - Vec3::Constant(0.5);
    const Vec3 inVolume = m_volume.worldToIndex * world;
    slot(first.array() + 1, m_slice) = static_cast<std::uint32_t>(m_surface.points.size());
    m_surface.points.push_back(m_volume.indexToWorld *
                               Vec3(inVolume.cwiseMax(Vec3::Constant(-0.5)).cwiseMin(last)));
  }

  /// A step of Newton's method toward the level, within the cell: the mean of the crossings lies on
  /// the inner side of a curved surface.
  Vec3 moveToLevel(const Vec3& at, const std::array<double, 8>& corners) const {
    double value = 0.0;
    Vec3 gradient = Vec3::Zero();
    for (std::size_t i = 0; i < 8; ++i) {
      Vec3 weights, slopes;
      for (int axis = 0; axis < 3; ++axis) {
        const bool isUpper = (i >> axis & 1U) != 0;
        weights[axis] = isUpper ? at[axis] : 1.0 - at[axis];
        slopes[axis] = isUpper ? corners[i] : -corners[i];
      }
      value += corners[i] * weights[0] * weights[1] * weights[2];
      gradient += Vec3(slopes[0] * weights[1] * weights[2], slopes[1] * weights[2] * weights[0],
                       slopes[2] * weights[0] * weights[1]);
    }
    const double square = gradient.dot(gradient);
    if (!(square > 0.0))
      return at;
    const Vec3 moved = at + (m_level - value) / square * gradient;
    return moved.cwiseMax(Vec3::Zero()).cwiseMin(Vec3::Constant(1.0));
  }

  std::uint32_t& slot(const Size3& cell, std::vector<std::uint32_t>& slice) const {
    return slice[static_cast<std::size_t>(cell.y() * m_cells.x() + cell.x())];
  }

  /// Two triangles between the points of the four cells around the edge along `axis` from the
  /// cell's first corner, which is in the focus if `isOutward`.
  void addQuad(const Size3& cell, int axis, bool isOutward) {
    const Size3 u = Size3::Unit((axis + 1) % 3), v = Size3::Unit((axis + 2) % 3);
    const auto find = [&](const Size3& at) {
      return slot(at, at.z() == cell.z() ? m_slice : m_below);
    };
    const bool isMirrored = m_mask.grid.indexToWorld.linear().determinant() < 0.0;
    std::array<std::uint32_t, 4> quad = {find(cell - u - v), find(cell - v), find(cell),
                                         find(cell - u)};
    if (isOutward == isMirrored)
      std::swap(quad[1], quad[3]);
    m_surface.triangles.push_back({quad[0], quad[1], quad[2]});
    m_surface.triangles.push_back({quad[0], quad[2], quad[3]});
  }

  const Mask& m_mask;
  const Grid& m_volume;
  Size3 m_cells;
  double m_level;
  std::vector<std::uint32_t> m_below, m_slice; ///< points of the cells of two slices
  SurfaceMesh m_surface;
};

} // namespace

SurfaceMesh triangulate(const Mask& mask, const Grid& volume) {
  return SurfaceNet(mask, volume).build();
}

} // namespace fenestra::core
