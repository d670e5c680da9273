#include "Segments.h"

#include "Matter.h"

#include <set>

namespace fenestra::oracle {

Rgb Segments::albedo(const Vec3& world, double scalar, const Rgb& own) const {
  const Vec3 index = m_tint.segments.front().mask.grid.indexToWorld.inverse() * world;
  const Vec3 base = index.array().floor();
  Rgb mean = Rgb::Zero();
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    Vec3 voxel = base;
    for (int axis = 0; axis < 3; ++axis) {
      const bool upper = corner >> axis & 1;
      weight *= upper ? index[axis] - base[axis] : 1.0 - index[axis] + base[axis];
      voxel[axis] += upper;
    }
    const std::vector<double> shares = sharesAt(voxel);
    for (std::size_t c = 0; c < shares.size(); ++c) {
      const auto& colors = m_tint.albedo[c];
      mean += weight * shares[c] / 255.0 * (colors ? Rgb(valueAt(*colors, scalar)) : own);
    }
  }
  return mean;
}

std::vector<double> Segments::sharesAt(const Vec3& voxel) const {
  const Vec3 world = m_tint.segments.front().mask.grid.indexToWorld * voxel;
  const auto indicator = [&](const TintDescription::Segment& segment) {
    const Grid& grid = segment.mask.grid;
    const Vec3 index = (grid.indexToWorld.inverse() * world).array().round();
    for (int axis = 0; axis < 3; ++axis)
      if (index[axis] < 0.0 || index[axis] >= static_cast<double>(grid.size[axis]))
        return 0.0;
    const Vec3 strides(1.0, static_cast<double>(grid.size[0]),
                       static_cast<double>(grid.size[0] * grid.size[1]));
    const auto at = static_cast<std::size_t>(index.dot(strides));
    return 255.0 * segment.mask.voxels[at] / segment.mask.full;
  };
  std::set<int, std::greater<>> priorities;
  for (const auto& segment : m_tint.segments)
    priorities.insert(segment.priority);

  std::vector<double> shares(m_tint.albedo.size(), 0.0);
  double left = 255.0;
  for (const int priority : priorities) {
    double all = 0.0;
    for (const auto& segment : m_tint.segments)
      all += segment.priority == priority ? indicator(segment) : 0.0;
    for (const auto& segment : m_tint.segments)
      if (segment.priority == priority && all > 0.0)
        shares[segment.component] += indicator(segment) * std::min(1.0, left / all);
    left = std::max(left - all, 0.0);
  }
  shares[0] += left;

  // Whole 255ths; the greatest share takes the rest.
  const auto greatest = std::ranges::max_element(shares) - shares.begin();
  double sum = 0.0;
  for (double& share : shares)
    sum += share = std::round(share);
  shares[static_cast<std::size_t>(greatest)] += 255.0 - sum;
  return shares;
}

} // namespace fenestra::oracle
