#include "Segments.h"

#include <algorithm>
#include <set>
#include <stdexcept>

namespace fenestra::core::oracle {
namespace {

/// First voxel of a mask in the label map's index space.
Vec3 findFirst(const Mask& mask, const Affine& worldToIndex) {
  return (worldToIndex * mask.grid.indexToWorld.translation()).array().round();
}

} // namespace

Segments::Segments(const ComponentsDescription& description)
    : m_description(description),
      m_worldToIndex(description.segments.front().mask.grid.indexToWorld.inverse()) {
  if (description.components.size() > maxComponents)
    throw std::invalid_argument("the oracle supports at most 16 components");
  Box box = Box::makeEmpty();
  for (const auto& segment : description.segments) {
    const Vec3 first = findFirst(segment.mask, m_worldToIndex);
    box.extend(first);
    box.extend(first + segment.mask.grid.size.cast<double>());
  }
  m_first = box.lower;
  m_count = box.upper - box.lower;
  for (double z = 0.0; z < m_count.z(); ++z)
    for (double y = 0.0; y < m_count.y(); ++y)
      for (double x = 0.0; x < m_count.x(); ++x)
        m_voxels.push_back(computeVoxel(m_first + Vec3(x, y, z)));
}

Segments::Weights Segments::atIndex(const Vec3& index) const {
  const Vec3 base = index.array().floor();
  const std::size_t count = m_description.components.size();
  Weights sum{};
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    Vec3 from = base - m_first; // the voxel, relative to the first one
    for (int axis = 0; axis < 3; ++axis) {
      const bool upper = corner >> axis & 1;
      weight *= upper ? index[axis] - base[axis] : 1.0 - index[axis] + base[axis];
      from[axis] += upper;
    }
    if (from.minCoeff() < 0.0 || (m_count - from).minCoeff() < 1.0) {
      sum[0] += weight;
      continue;
    }
    const double number = from.x() + m_count.x() * (from.y() + m_count.y() * from.z());
    const Weights& weights = m_voxels[static_cast<std::size_t>(number)];
    for (std::size_t c = 0; c < count; ++c)
      sum[c] += weight * weights[c] / 255.0;
  }
  return sum;
}

Vec3 Segments::gradient(std::size_t component, const Vec3& world) const {
  const Vec3 index = m_worldToIndex * world;
  Vec3 perVoxel;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = Vec3::Unit(axis);
    perVoxel[axis] = (atIndex(index + step)[component] - atIndex(index - step)[component]) / 2.0;
  }
  return m_worldToIndex.linear().transpose() * perVoxel; // chain rule
}

Segments::Weights Segments::computeVoxel(const Vec3& at) const {
  const auto indicator = [&](const ComponentsDescription::Segment& segment) {
    const Size3& size = segment.mask.grid.size;
    const Vec3 from = at - findFirst(segment.mask, m_worldToIndex);
    for (int axis = 0; axis < 3; ++axis)
      if (from[axis] < 0.0 || from[axis] >= static_cast<double>(size[axis]))
        return 0.0;
    const Vec3 strides(1.0, static_cast<double>(size[0]), static_cast<double>(size[0] * size[1]));
    const auto number = static_cast<std::size_t>(from.dot(strides));
    return 255.0 * segment.mask.voxels[number] / segment.mask.maxValue;
  };
  std::set<int, std::greater<>> priorities;
  for (const auto& segment : m_description.segments)
    priorities.insert(segment.priority);

  Weights weights{};
  double left = 255.0;
  for (const int priority : priorities) {
    double all = 0.0;
    for (const auto& segment : m_description.segments)
      all += segment.priority == priority ? indicator(segment) : 0.0;
    for (const auto& segment : m_description.segments)
      if (segment.priority == priority && all > 0.0)
        weights[segment.component] += indicator(segment) * std::min(1.0, left / all);
    left = std::max(left - all, 0.0);
  }
  weights[0] += left;

  // Rounds to integers that sum to 255; the largest weight absorbs the difference.
  const auto greatest = std::ranges::max_element(weights) - weights.begin();
  double sum = 0.0;
  for (double& weight : weights)
    sum += weight = std::round(weight);
  weights[static_cast<std::size_t>(greatest)] += 255.0 - sum;
  return weights;
}

} // namespace fenestra::core::oracle
