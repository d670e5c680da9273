#pragma once
// Shares: how much of each voxel belongs to which component of the medium. The only thing that
// transport knows of a segmentation.
//
// Most voxels belong to one component alone, and most others to two. A grid of voxels is cut into
// bricks of 4^3 cells, which hold all 5^3 voxels that interpolation inside them reads: a look-up
// reads one brick. A pure brick is one number. A mixed one of k components is k - 1 planes, one
// after the other, each of one component's shares in 128 bytes; the component of the greatest
// number gets what they leave, voxel by voxel in whole numbers, and so nothing where it has
// nothing.

#include "model/volume/Mask.h"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace fenestra {

class LabelWeights {
public:
  /// Voxels of a segment, or of several of one component.
  struct Part {
    Mask mask; ///< all on voxels of one labelmap
    int priority;
    std::uint8_t component; ///< 0: what is in no segment
  };

  static constexpr std::int64_t brickEdge = 4; ///< cells of a brick along each axis
  static constexpr std::size_t voxelsInBrick = (brickEdge + 1) * (brickEdge + 1) * (brickEdge + 1);

  /// A component of a mixed brick. Its size lets lanes read 32 bits from any voxel on, and the
  /// three numbers behind the shares in one load.
  struct alignas(64) Plane {
    std::array<std::uint8_t, voxelsInBrick> weights; ///< of 255, x fastest
    std::uint8_t component;
    std::uint8_t rest;   ///< component that gets what the brick's planes leave: the same in all
    std::uint8_t isLast; ///< 1: the brick's last plane; else 0, and the next one is its, too
  };
  static_assert(sizeof(Plane) == 128);

  /// Shares in order of the parts' priority, the greater first: with `left` = 1, and U the sum of
  /// the indicators u of a priority, each gets u min(1, left / U), and `left` loses min(left, U);
  /// component 0 gets the rest. Rounded to 255ths that sum to 255. Parts of one priority may come
  /// in any order, and be of different components. `count`: of parts, at least one; one at a time
  /// is held.
  LabelWeights(std::size_t count, const std::function<Part(std::size_t)>& getPart);

  /// Voxels that the parts' masks cover. Beyond them the outermost voxels repeat.
  const Grid& grid() const { return m_grid; }
  const Size3& brickCount() const { return m_brickCount; }
  /// A pure brick's component; for a mixed brick ~n, its first plane's number n. x fastest.
  const std::vector<std::int32_t>& bricks() const { return m_bricks; }
  const std::vector<Plane>& planes() const { return m_planes; }
  /// Share of pure bricks, 0 to 1.
  double pureFraction() const;
  std::size_t bytes() const {
    return m_bricks.size() * sizeof(std::int32_t) + m_planes.size() * sizeof(Plane);
  }

  /// Calls visit(component) for the components of a brick, given by its number in bricks().
  template <typename Visit>
  void forEachInBrick(std::size_t brick, Visit&& visit) const;

  /// Calls visit(component) for all components that may have a share in a box (the grid's index
  /// space); some more than once.
  template <typename Visit>
  void forEachInBox(const Box& box, Visit&& visit) const;

  /// Calls visit(component, share) for the components at a point (the grid's index space): shares
  /// are trilinear between voxels, > 0, and sum to 1. Each comes once, by number.
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
  // Whole numbers at the eight voxels around the point.
  constexpr std::size_t up = brickEdge + 1, deep = up * up;
  constexpr std::array<std::size_t, 8> corners = {0,    1,        up,        up + 1,
                                                  deep, deep + 1, deep + up, deep + up + 1};
  using CornerValues = std::array<int, 8>;
  const auto visitOne = [&](std::uint8_t component, const CornerValues& values) {
    const auto row = [&](std::size_t i) {
      const double a = values[i], b = values[i + 1];
      return a + f.x() * (b - a);
    };
    const auto slice = [&](std::size_t i) { return row(i) + f.y() * (row(i + 2) - row(i)); };
    if (const double weight = (slice(0) + f.z() * (slice(4) - slice(0))) / 255.0; weight > 0.0)
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

} // namespace fenestra
