#include "model/volume/Domain.h"

namespace fenestra::core {
namespace {

/// Adds the points (index space) where edges of `box` enter and leave `other`. `toOther` maps from
/// the space of `box` to that of `other`. `other` is enlarged by 1e-9, since rounding could
/// otherwise lose a corner that the boxes have in common.
void addEdgeIntersections(const Box& box, const Box& other, const Affine& toOther,
                          const Affine& toIndex, std::vector<Vec3>& points) {
  const Vec3 slack = 1e-9 * (other.upper - other.lower);
  const Box grown{other.lower - slack, other.upper + slack};
  for (int corner = 0; corner < 8; ++corner)
    for (int axis = 0; axis < 3; ++axis) {
      if (corner >> axis & 1)
        continue; // each edge once, from its lower end
      const Vec3 from = box.corner(corner);
      const Ray edge{from, box.corner(corner | 1 << axis) - from};
      const Interval inside = grown.clip(transformRay(toOther, edge), {0.0, 1.0});
      if (inside.isEmpty())
        continue;
      points.push_back(toIndex * edge.at(inside.begin));
      points.push_back(toIndex * edge.at(inside.end));
    }
}

} // namespace

Domain::Domain(const Grid& grid, const std::optional<CropBox>& crop)
    : m_grid(grid), m_box(grid.indexBox()) {
  if (crop)
    m_crop = Crop{crop->worldToBox * grid.indexToWorld, grid.worldToIndex * crop->boxToWorld};
}

Domain Domain::intersect(const Box& box) const {
  Domain part = *this;
  part.m_box = {m_box.lower.cwiseMax(box.lower), m_box.upper.cwiseMin(box.upper)};
  return part;
}

std::vector<Vec3> Domain::indexCorners() const {
  std::vector<Vec3> points;
  if ((m_box.lower.array() > m_box.upper.array()).any())
    return points;
  if (!m_crop) {
    for (int i = 0; i < 8; ++i)
      points.push_back(m_box.corner(i));
    return points;
  }
  addEdgeIntersections(m_box, m_crop->box, m_crop->fromIndex, Affine::Identity(), points);
  addEdgeIntersections(m_crop->box, m_box, m_crop->toIndex, m_crop->toIndex, points);
  return points;
}

} // namespace fenestra::core
