#pragma once
// Label weights (partial-volume fractions): how much of each voxel belongs to which component of
// the medium. The integrators see a segmentation only in this form.
//
// Most voxels belong to a single component, and most others to two. The grid is divided into bricks
// of 4^3 cells, each stored with all 5^3 voxels that interpolation inside it reads, so that a
// look-up reads one brick. A pure brick is stored as the number of its component. A mixed brick of
// k components has k - 1 consecutive planes of 128 bytes, each with the weights of one component.
// The component of the highest number gets the rest, computed per voxel in integers, so that it is
// exactly zero where the component is absent.

#include "model/volume/Field.h"
#include "model/volume/Mask.h"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace fenestra::core {

class LabelWeights {
public:
  /// Voxels of one or several segments that belong to one component.
  struct Part {
    Mask mask; ///< all masks are on the same label map's lattice
    int priority;
    std::uint8_t component; ///< 0: outside all segments
  };

  static constexpr std::int64_t brickEdge = 4; ///< cells of a brick along each axis
  static constexpr std::size_t voxelsInBrick = (brickEdge + 1) * (brickEdge + 1) * (brickEdge + 1);

  /// Weights of one component in a mixed brick. The size lets SIMD lanes load 32 bits starting at
  /// any voxel, and the three bytes after the weights in one load.
  struct alignas(64) Plane {
    std::array<std::uint8_t, voxelsInBrick> weights; ///< in 255ths, x fastest
    std::uint8_t component;
    std::uint8_t rest;   ///< component that gets the rest; the same in all planes of the brick
    std::uint8_t isLast; ///< 1 in the brick's last plane; 0: another of its planes follows
  };
  static_assert(sizeof(Plane) == 128);

  /// Assigns weights by decreasing priority. Let `rest` = 1, and U be the sum of the indicators u
  /// of one priority: each part gets u min(1, rest / U), and `rest` decreases by min(rest, U).
  /// Component 0 gets the final rest. Weights are rounded to 255ths that sum to 255. Parts of one
  /// priority may come in any order and belong to different components. `count`: number of parts,
  /// at least one. getPart(i) is called one at a time, to limit memory.
  LabelWeights(std::size_t count, const std::function<Part(std::size_t)>& getPart);

  /// Grid that covers all masks. Outside of it the outermost voxels repeat.
  const Grid& grid() const { return m_grid; }
  const Size3& brickCount() const { return m_brickCount; }
  /// A pure brick's component; a mixed brick's ~n, n being the index of its first plane. x fastest.
  const std::vector<std::int32_t>& bricks() const { return m_bricks; }
  const std::vector<Plane>& planes() const { return m_planes; }
  /// Fraction of pure bricks, 0 to 1.
  double pureFraction() const;
  std::size_t bytes() const {
    return m_bricks.size() * sizeof(std::int32_t) + m_planes.size() * sizeof(Plane);
  }

  /// Calls visit(component) for each component of a brick, given by its index in bricks().
  template <typename Visit>
  void forEachInBrick(std::size_t brick, Visit&& visit) const;

  /// Calls visit(component) for all components that may have weight in a box (the grid's index
  /// space); may repeat components.
  template <typename Visit>
  void forEachInBox(const Box& box, Visit&& visit) const;

  /// Calls visit(component, weight) for the components at a point (the grid's index space). Weights
  /// are trilinear between voxels, > 0, and sum to 1. Each component comes once, by number.
  template <typename Visit>
  void forEachWeight(const Vec3& index, Visit&& visit) const;

private:
  Grid m_grid;
  Size3 m_brickCount;
  std::vector<std::int32_t> m_bricks;
  std::vector<Plane> m_planes;
};

template <typename Visit>
void LabelWeights::forEachInBrick(std::size_t brick, Visit&& visit) const {
  const std::int32_t code = m_bricks[brick];
  if (code >= 0) {
    visit(static_cast<std::uint8_t>(code));
    return;
  }
  auto plane = m_planes.begin() + ~code;
  visit(plane->rest);
  visit(plane->component);
  while (!plane->isLast)
    visit((++plane)->component);
}

template <typename Visit>
void LabelWeights::forEachInBox(const Box& box, Visit&& visit) const {
  const Vec3 last = (m_brickCount.array() - 1).cast<double>();
  const auto findBrick = [&](const Vec3& index) -> Size3 {
    const Vec3 brick = (index / static_cast<double>(brickEdge)).array().floor();
    return brick.cwiseMax(0.0).cwiseMin(last).cast<std::int64_t>();
  };
  const Size3 first = findBrick(box.lower), end = findBrick(box.upper).array() + 1;
  for (std::int64_t z = first.z(); z < end.z(); ++z)
    for (std::int64_t y = first.y(); y < end.y(); ++y)
      for (std::int64_t x = first.x(); x < end.x(); ++x)
        forEachInBrick(linearIndex(Size3(x, y, z), m_brickCount), visit);
}

template <typename Visit>
void LabelWeights::forEachWeight(const Vec3& index, Visit&& visit) const {
  const Vec3 last = (m_grid.size.array() - 1).cast<double>();
  const Vec3 inside = index.cwiseMax(0.0).cwiseMin(last);
  const Size3 cell =
      inside.cast<std::int64_t>().cwiseMin((m_grid.size.array() - 2).max(0).matrix());
  const Size3 brick = cell.array() / brickEdge;
  const std::int32_t code = m_bricks[linearIndex(brick, m_brickCount)];
  if (code >= 0) {
    visit(static_cast<std::uint8_t>(code), 1.0);
    return;
  }
  const Vec3 f = inside - cell.cast<double>();
  const std::size_t first =
      linearIndex(cell.array() - brickEdge * brick.array(), Size3::Constant(brickEdge + 1));
  // Integer weights at the eight voxels around the point.
  constexpr std::size_t up = brickEdge + 1, deep = up * up;
  constexpr std::array<std::size_t, 8> corners = {0,    1,        up,        up + 1,
                                                  deep, deep + 1, deep + up, deep + up + 1};
  using CornerValues = std::array<int, 8>;
  const auto visitOne = [&](std::uint8_t component, const CornerValues& v) {
    const double weight =
        scalar::lerp(scalar::interpolate(v[0], v[1], v[2], v[3], f.x(), f.y()),
                     scalar::interpolate(v[4], v[5], v[6], v[7], f.x(), f.y()), f.z()) /
        255.0;
    if (weight > 0.0)
      visit(component, weight);
  };
  CornerValues rest;
  rest.fill(255);
  for (auto plane = m_planes.begin() + ~code;; ++plane) {
    CornerValues values;
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = plane->weights[first + corners[i]];
      rest[i] -= values[i];
    }
    visitOne(plane->component, values);
    if (plane->isLast)
      return visitOne(plane->rest, rest);
  }
}

} // namespace fenestra::core
