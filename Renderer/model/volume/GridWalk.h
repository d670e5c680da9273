#pragma once
// Traversal of the cells of a regular grid along a ray (Amanatides and Woo 1987, "A Fast Voxel
// Traversal Algorithm for Ray Tracing").

#include "base/Vector.h"

#include <cstdint>

namespace fenestra::core {

/// Iterates over the cells along a ray. The ray is in cell space, where cell c fills [c, c + 1] in
/// each axis. The caller chooses the unit of t (usually world mm).
///
///     for (GridWalk walk(ray, range, cellCount); !walk.isDone(); walk.next())
///       visit(walk.cell(), walk.interval());
///
/// Guarantees for every finite ray: the traversal ends, and visits only cells of the grid. Its
/// intervals tile the part of `range` inside the grid exactly: each begins where the previous one
/// ended. An interval may have zero length (rays through edges and corners). A ray along a face
/// between two cells visits one of the two. After the last cell only isDone() is valid.
class GridWalk {
public:
  GridWalk(const Ray& ray, const Interval& range, const Size3& cellCount)
      : m_cells(cellCount), m_origin(ray.origin) {
    const Box box{Vec3::Zero(), cellCount.cast<double>()};
    const Interval inside = box.clip(ray, range);
    m_interval = {inside.begin, inside.begin};
    m_end = inside.isEmpty() ? inside.begin : inside.end;
    if (isDone())
      return;
    for (int axis = 0; axis < 3; ++axis)
      enter(axis, ray.direction[axis], inside.begin);
    m_cell =
        m_coordinates.x() + m_cells.x() * (m_coordinates.y() + m_cells.y() * m_coordinates.z());
    findEnd();
  }

  bool isDone() const { return !(m_interval.begin < m_end); }

  void next() {
    m_interval.begin = m_interval.end;
    if (m_next[0] < m_next[1] && m_next[0] < m_next[2])
      step<0>();
    else if (m_next[1] < m_next[2])
      step<1>();
    else
      step<2>();
    findEnd();
  }

  /// Linear index, x fastest.
  std::int64_t cell() const { return m_cell; }
  const Size3& coordinates() const { return m_coordinates; }
  const Interval& interval() const { return m_interval; }

private:
  /// Initializes one axis just after t: the cell's coordinate and the next face.
  void enter(int axis, double direction, double t) {
    const bool up = direction > 0.0;
    const double position = direction == 0.0 ? m_origin[axis] : m_origin[axis] + t * direction;
    const double cell = direction < 0.0 ? std::ceil(position) - 1.0 : std::floor(position);
    const std::int64_t last = m_cells[axis] - 1;
    // This order of min and max maps NaN (infinity times zero) to a valid cell.
    const double inGrid = std::max(0.0, std::min(static_cast<double>(last), cell));
    m_coordinates[axis] = static_cast<std::int64_t>(inGrid);

    const double inverse = 1.0 / direction;
    const bool moves = std::isfinite(inverse); // false for zero and the smallest subnormals
    m_inverse[axis] = inverse;
    m_step[axis] = up ? 1 : -1;
    m_remaining[axis] = moves ? (up ? last - m_coordinates[axis] : m_coordinates[axis]) : 0;
    m_face[axis] = static_cast<double>(m_coordinates[axis] + (up ? 1 : 0));
    m_next[axis] = faceDistance(axis);
    const std::int64_t stride = axis == 0 ? 1 : axis == 1 ? m_cells.x() : m_cells.x() * m_cells.y();
    m_stride[axis] = m_step[axis] * stride;
  }

  /// The axis is a template argument, since a constant axis halves the time.
  template <int axis>
  void step() {
    m_coordinates[axis] += m_step[axis];
    m_cell += m_stride[axis];
    m_face[axis] += static_cast<double>(m_step[axis]);
    --m_remaining[axis];
    m_next[axis] = faceDistance(axis);
  }

  /// t at the next face of an axis; infinity at the grid's outer faces: m_end ends the traversal,
  /// so that rounding cannot leave the grid. t is computed from the face's coordinate rather than
  /// by adding steps, so that errors do not accumulate along the ray.
  double faceDistance(int axis) const {
    return m_remaining[axis] > 0 ? (m_face[axis] - m_origin[axis]) * m_inverse[axis] : infinity;
  }

  void findEnd() {
    m_interval.end = std::min(m_end, std::max(m_interval.begin, m_next.minCoeff()));
  }

  Size3 m_cells;
  Vec3 m_origin;
  Vec3 m_inverse = Vec3::Zero(); ///< 1 / direction
  Vec3 m_face = Vec3::Zero();    ///< coordinate of the next face in each axis
  Vec3 m_next = Vec3::Zero();    ///< t at m_face
  Size3 m_coordinates = Size3::Zero();
  Size3 m_remaining = Size3::Zero(); ///< remaining cells in each axis
  Size3 m_step = Size3::Zero(), m_stride = Size3::Zero();
  std::int64_t m_cell = 0;
  Interval m_interval;
  double m_end; ///< t at which the traversal ends
};

} // namespace fenestra::core
