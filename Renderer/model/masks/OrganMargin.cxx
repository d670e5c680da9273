#include "model/masks/OrganMargin.h"

#include "base/Distribution.h"
#include "model/masks/Distances.h"
#include "model/masks/Rows.h"
#include "model/volume/Field.h"

#include <algorithm>
#include <array>
#include <span>

namespace fenestra::core {
namespace {

constexpr double deep = 8.0;              ///< mm below the surface, where voxels are surely organ
constexpr std::size_t fewestDeep = 500;   ///< voxels, for a robust standard deviation
constexpr double maxDeviation = 60.0;     ///< HU, of one tissue
constexpr double maxAirDeviation = 120.0; ///< HU, of lung: more blood lies in its lower parts
constexpr float maxDepth = 6.0F;          ///< mm below the surface, of removed voxels
constexpr double maxRemoved = 1.0 / 3.0;  ///< fraction of the voxels; more: not this organ's label
constexpr double mostBright = 1.0 / 3.0;  ///< of what is removed; more: cortex of a bone
constexpr double deviations = 3.5;        ///< robust standard deviations that belong to the tissue
constexpr double leastDifference = 25.0;  ///< HU; differences within an organ
constexpr double tested = 1.0;            ///< mm below the new surface, where it must be organ
/// Radius, mm, of a ball that fits into lesions: those up to `mostExtent`, larger ones, and those
/// of fat or air.
constexpr double lesionRadius = 1.25, largeRadius = 2.5, fatRadius = 4.0;
constexpr double lesionRim = 3.0;       ///< mm, around a lesion
constexpr float leastSoft = -30.0F;     ///< HU; fat, lung and air are below
constexpr double greatestLung = -500.0; ///< HU
constexpr double lesionFraction = 0.6;  ///< of the range: partial volume around a lesion
/// Centers of balls in thin lesions: volume, mm^3, to exclude noise; fraction inside; extent, mm.
/// Neighboring organs have less than 0.05 inside; sheets extend farther, and larger lesions are
/// thicker inside.
constexpr double leastSize = 12.0, leastInside = 1.0 / 3.0, mostExtent = 20.0;
constexpr double maxMoved = 12.0; ///< mm, measured

/// Calls visit(voxel, index) for each voxel.
template <typename Visitor>
void forEachVoxel(const Size3& size, const Visitor& visit) {
  std::size_t i = 0;
  for (std::int64_t z = 0; z < size.z(); ++z)
    for (std::int64_t y = 0; y < size.y(); ++y)
      for (std::int64_t x = 0; x < size.x(); ++x)
        visit(Size3(x, y, z), i++);
}

/// Calls visit(neighbor, its index, axis) for the six voxels with a common face.
template <typename Visitor>
void forEachNeighbor(const Size3& voxel, const Size3& size, const Visitor& visit) {
  for (int axis = 0; axis < 3; ++axis)
    for (const int step : {-1, 1}) {
      const Size3 next = voxel + step * Size3::Unit(axis);
      if (next[axis] >= 0 && next[axis] < size[axis])
        visit(next, linearIndex(next, size), axis);
    }
}

/// Volume at the voxels of another grid.
std::vector<float> resample(const Volume& volume, const Grid& grid) {
  std::vector<float> result(static_cast<std::size_t>(grid.voxelCount()));
  const Affine toVolume = volume.grid.worldToIndex * grid.indexToWorld;
  const auto fill = [&](const auto& voxels) {
    const Field field(volume.grid, voxels);
    forEachRow(grid.size, [&](std::int64_t y, std::int64_t z, std::size_t row) {
      for (std::int64_t x = 0; x < grid.size.x(); ++x)
        result[row + static_cast<std::size_t>(x)] =
            static_cast<float>(field.value(toVolume * Size3(x, y, z).cast<double>()));
    });
  };
  std::visit(fill, volume.voxels);
  return result;
}

/// Median of the up to 27 values around a voxel.
float computeLocalMedian(const std::vector<float>& values, const Size3& voxel, const Size3& size) {
  std::array<float, 27> near{};
  const Size3 first = (voxel.array() - 1).max(0), last = (voxel.array() + 1).min(size.array() - 1);
  auto end = near.begin();
  for (std::int64_t z = first.z(); z <= last.z(); ++z)
    for (std::int64_t y = first.y(); y <= last.y(); ++y)
      for (std::int64_t x = first.x(); x <= last.x(); ++x)
        *end++ = values[linearIndex({x, y, z}, size)];
  return findMedian(std::span(near.begin(), end));
}

/// Values of one tissue: within `difference` of the median.
struct TissueRange {
  double median = 0.0, deviation = 0.0, difference = 0.0;

  /// `values` must not be empty.
  explicit TissueRange(std::vector<float> values)
      : median(static_cast<double>(findMedian(values))) {
    for (float& value : values)
      value = std::abs(value - static_cast<float>(median));
    deviation = 1.4826 * static_cast<double>(findMedian(values));
    difference = std::max(leastDifference, deviations * deviation);
  }

  /// `fraction`: of the range.
  bool contains(float value, double fraction = 1.0) const {
    return std::abs(static_cast<double>(value) - median) <= fraction * difference;
  }
};

/// Finds the voxels to remove.
class OrganTrimmer {
public:
  OrganTrimmer(const Mask& segment, const Volume& volume)
      : m_grid(segment.grid),
        m_resolution(volume.grid.spacing().maxCoeff()),
        m_inside(segment.voxels),
        m_isBeside(segment.voxels.size()),
        m_isNear(segment.voxels.size()),
        m_values(resample(volume, m_grid)),
        m_medians(segment.voxels.size()) {
    Marks outside(m_inside.size());
    std::ranges::transform(m_inside, outside.begin(), [](std::uint8_t voxel) { return !voxel; });
    m_depth = computeDistances(outside, m_grid, deep);
    std::ranges::transform(computeDistances(m_inside, m_grid, 2.0 * deep), m_isNear.begin(),
                           [](float away) { return away <= static_cast<float>(deep); });
    forEachVoxel(m_grid.size, [&](const Size3& voxel, std::size_t i) {
      if (!m_inside[i])
        forEachNeighbor(voxel, m_grid.size, [&](const Size3&, std::size_t next, int) {
          m_isBeside[i] |= m_inside[next];
        });
    });
    forEachRow(m_grid.size, [&](std::int64_t y, std::int64_t z, std::size_t row) {
      for (std::int64_t x = 0; x < m_grid.size.x(); ++x)
        if (const std::size_t i = row + static_cast<std::size_t>(x); m_isNear[i])
          m_medians[i] = computeLocalMedian(m_values, {x, y, z}, m_grid.size);
    });
  }

  /// Marks of the removed voxels; empty: not one tissue.
  Marks findRemoved() const {
    const std::vector<float> deepValues = selectDeep(m_values);
    if (deepValues.size() < fewestDeep)
      return {};
    const TissueRange values(deepValues), medians(selectDeep(m_medians));
    const bool isSoft = values.median > static_cast<double>(leastSoft);
    const bool isLung = values.median < greatestLung;
    if (!(isSoft && values.deviation <= maxDeviation) &&
        !(isLung && values.deviation <= maxAirDeviation))
      return {};
    const Marks lesions = findLesions(values, medians);
    Marks removed(m_inside.size());
    std::vector<Size3> front;
    const auto removeBeside = [&](const Size3& from, std::size_t i) {
      forEachNeighbor(from, m_grid.size, [&](const Size3& voxel, std::size_t next, int axis) {
        if (!m_inside[next] || removed[next] || lesions[next] || m_depth[next] > maxDepth ||
            isOrgan(next, i, axis, values, medians))
          return;
        removed[next] = 1;
        front.push_back(voxel);
      });
    };
    forEachVoxel(m_grid.size, [&](const Size3& voxel, std::size_t i) {
      if (m_isBeside[i])
        removeBeside(voxel, i);
    });
    while (!front.empty()) {
      const Size3 voxel = front.back();
      front.pop_back();
      removeBeside(voxel, linearIndex(voxel, m_grid.size));
    }
    return isSoft && hasBrightShell(removed, values) ? Marks() : removed;
  }

  /// Distances, mm, from the segment's surface voxels to the nearest voxel that is kept; sorted.
  std::vector<float> measureMovement(const Marks& kept) const {
    const std::vector<float> distances = computeDistances(kept, m_grid, maxMoved);
    std::vector<float> moved;
    forEachVoxel(m_grid.size, [&](const Size3& voxel, std::size_t i) {
      bool isSurface = false;
      if (m_inside[i])
        forEachNeighbor(voxel, m_grid.size,
                        [&](const Size3&, std::size_t next, int) { isSurface |= !m_inside[next]; });
      if (isSurface)
        moved.push_back(distances[i]);
    });
    std::ranges::sort(moved);
    return moved;
  }

private:
  std::vector<float> selectDeep(const std::vector<float>& from) const {
    std::vector<float> selected;
    for (std::size_t i = 0; i < from.size(); ++i)
      if (m_inside[i] && m_depth[i] >= static_cast<float>(deep))
        selected.push_back(from[i]);
    return selected;
  }

  /// True if much of what would be removed is brighter than the tissue, as the cortex of a bone is.
  bool hasBrightShell(const Marks& removed, const TissueRange& values) const {
    std::size_t all = 0, bright = 0;
    for (std::size_t i = 0; i < removed.size(); ++i) {
      all += removed[i];
      bright += removed[i] && static_cast<double>(m_values[i]) > values.median + values.difference;
    }
    return static_cast<double>(bright) > mostBright * static_cast<double>(all);
  }

  /// True if the volume is of the organ `tested` mm below the face between a voxel and `beyond`.
  /// Single voxels differ from it if there is little noise, medians if there is much.
  bool isOrgan(std::size_t i, std::size_t beyond, int axis, const TissueRange& values,
               const TissueRange& medians) const {
    const auto weight = static_cast<float>(std::max(0.0, 0.5 - tested / m_grid.spacing()[axis]));
    const auto isIn = [&](const std::vector<float>& from, const TissueRange& range) {
      return range.contains(from[i] + weight * (from[beyond] - from[i]));
    };
    return isIn(m_values, values) && isIn(m_medians, medians);
  }

  /// Bodies of other tissue, in contrast to sheets: opening of it by a ball, with a rim. Those of
  /// soft tissue are also searched beyond the label, since many end at the organ's capsule.
  Marks findLesions(const TissueRange& values, const TissueRange& medians) const {
    Marks lesions(m_inside.size());
    const auto isSoft = [&](std::size_t i) {
      return m_medians[i] > leastSoft && !medians.contains(m_medians[i], lesionFraction);
    };
    const auto isBrighter = [&](std::size_t i) {
      return static_cast<double>(m_medians[i]) > medians.median;
    };
    const auto isSoftInside = [&](std::size_t i) { return m_inside[i] && isSoft(i); };
    addBodies(findSmallParts(findCores(lesionRadius, isSoftInside)), lesionRadius, lesions);
    addBodies(findCores(largeRadius, isSoftInside), largeRadius, lesions);
    for (const bool bright : {false, true}) {
      const auto isSoftNear = [&](std::size_t i) {
        return m_isNear[i] && isSoft(i) && isBrighter(i) == bright;
      };
      addBodies(findSmallParts(findCores(lesionRadius, isSoftNear)), lesionRadius, lesions);
    }
    const auto isOther = [&](std::size_t i) {
      return m_inside[i] && (!medians.contains(m_medians[i]) || !values.contains(m_values[i]));
    };
    addBodies(findCores(fatRadius, isOther), fatRadius, lesions);
    return lesions;
  }

  /// Distance, mm, between the center of a ball of `radius` mm in a body and voxels beside it:
  /// wider than partial volume of two voxels, also diagonally.
  double findReach(double radius) const {
    const Vec3 spacing = m_grid.spacing();
    const double edge = spacing.maxCoeff();
    const double middle = spacing.sum() - edge - spacing.minCoeff();
    return std::max({radius + 0.5 * edge, 1.01 * std::max(edge, m_resolution), 1.45 * middle});
  }

  /// Centers of balls of `radius` mm in a set of voxels.
  template <typename Predicate>
  Marks findCores(double radius, const Predicate& isOther) const {
    const double reach = findReach(radius);
    Marks rest(m_inside.size()), cores(rest.size());
    for (std::size_t i = 0; i < rest.size(); ++i)
      rest[i] = !isOther(i);
    std::ranges::transform(computeDistances(rest, m_grid, reach + m_grid.spacing().maxCoeff()),
                           cores.begin(),
                           [reach](float away) { return away > static_cast<float>(reach); });
    return cores;
  }

  /// Adds balls of `radius` mm around the centers.
  void addBalls(const Marks& centers, double radius, Marks& balls) const {
    if (std::ranges::find(centers, std::uint8_t{1}) == centers.end())
      return;
    const std::vector<float> away =
        computeDistances(centers, m_grid, radius + m_grid.spacing().maxCoeff());
    for (std::size_t i = 0; i < away.size(); ++i)
      balls[i] |= away[i] <= static_cast<float>(radius);
  }

  /// Adds bodies with a rim, from their centers of balls of `radius` mm.
  void addBodies(const Marks& cores, double radius, Marks& bodies) const {
    addBalls(cores, findReach(radius) + lesionRim, bodies);
  }

  /// Centers of balls of `lesionRadius` without those whose connected balls are mostly outside, or
  /// extend far, as neighboring organs and sheets do.
  Marks findSmallParts(Marks cores) const {
    Marks balls(cores.size());
    addBalls(cores, findReach(lesionRadius), balls);
    std::vector<Size3> part;
    const auto visit = [&](const Size3& voxel, std::size_t i) {
      if (balls[i])
        part.push_back(voxel);
      balls[i] = 0;
    };
    forEachVoxel(m_grid.size, [&](const Size3& voxel, std::size_t seed) {
      part.clear();
      visit(voxel, seed);
      for (std::size_t k = 0; k < part.size(); ++k) {
        const Size3 ball = part[k];
        forEachNeighbor(ball, m_grid.size,
                        [&](const Size3& next, std::size_t i, int) { visit(next, i); });
      }
      if (!isSmall(part, cores))
        for (const Size3& ball : part)
          cores[linearIndex(ball, m_grid.size)] = 0;
    });
    return cores;
  }

  /// True if the cores in a part are at least a third inside, and not larger than lesions.
  bool isSmall(const std::vector<Size3>& part, const Marks& cores) const {
    Size3 lower = m_grid.size, upper = Size3::Zero();
    double count = 0.0, inside = 0.0;
    for (const Size3& voxel : part)
      if (const std::size_t i = linearIndex(voxel, m_grid.size); cores[i]) {
        lower = lower.cwiseMin(voxel);
        upper = upper.cwiseMax(voxel);
        count += 1.0;
        inside += m_inside[i];
      }
    const Vec3 extent = (upper - lower).cast<double>().cwiseProduct(m_grid.spacing());
    return count * m_grid.spacing().prod() >= leastSize && inside >= leastInside * count &&
           extent.maxCoeff() <= mostExtent;
  }

  const Grid& m_grid;
  double m_resolution; ///< edge of the volume's voxels, mm
  const Marks& m_inside;
  Marks m_isBeside; ///< outside, with a face in common with the segment
  Marks m_isNear;   ///< inside or at most `deep` outside
  std::vector<float> m_values, m_medians, m_depth;
};

} // namespace

OrganMargin findOrganMargin(const Mask& segment, const Volume& volume) {
  constexpr double mostSteps = 64.0; // of a distance, and 2^28 voxels: bounds time and memory
  const Vec3 spacing = segment.grid.spacing();
  if (spacing.maxCoeff() >= thickestVoxel || deep > mostSteps * spacing.minCoeff() ||
      segment.grid.voxelCount() > std::int64_t{1} << 28)
    return {.isApplied = false, .kept = segment};
  const OrganTrimmer trimmer(segment, volume);
  const Marks removed = trimmer.findRemoved();
  OrganMargin margin{.isApplied = false, .kept = segment};
  const auto count = std::ranges::count(removed, std::uint8_t{1});
  if (removed.empty() ||
      static_cast<double>(count) > maxRemoved * static_cast<double>(segment.count))
    return margin;
  margin.isApplied = true;
  for (std::size_t i = 0; i < removed.size(); ++i)
    margin.kept.voxels[i] = segment.voxels[i] && !removed[i];
  margin.kept.count -= count;
  margin.volume =
      static_cast<double>(count) * std::abs(segment.grid.indexToWorld.linear().determinant());
  const std::vector<float> moved = trimmer.measureMovement(margin.kept.voxels);
  for (const float distance : moved)
    margin.mean += static_cast<double>(distance) / static_cast<double>(moved.size());
  if (!moved.empty())
    margin.p95 = static_cast<double>(moved[moved.size() * 95 / 100]);
  return margin;
}

} // namespace fenestra::core
