#include "filter/Boxes.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace fenestra {
namespace {

/// Running sums of a line of `count` values that lie `stride` apart.
void sumLine(const float* in, float* out, std::size_t stride, int count, int radius) {
  const auto at = [stride](int i) { return static_cast<std::size_t>(i) * stride; };
  double sum = 0.0;
  for (int i = 0; i < std::min(radius, count); ++i)
    sum += static_cast<double>(in[at(i)]);
  for (int i = 0; i < count; ++i) {
    if (i + radius < count)
      sum += static_cast<double>(in[at(i + radius)]);
    if (i - radius - 1 >= 0)
      sum -= static_cast<double>(in[at(i - radius - 1)]);
    out[at(i)] = static_cast<float>(sum);
  }
}

} // namespace

Plane boxSum(const Plane& plane, int width, int height, int radius) {
  Plane across(plane.size()), sums(plane.size());
  const auto row = static_cast<std::size_t>(width);
  tbb::parallel_for(0, height, [&](int y) {
    const std::size_t start = static_cast<std::size_t>(y) * row;
    sumLine(&plane[start], &across[start], 1, width, radius);
  });
  tbb::parallel_for(0, width, [&](int x) {
    const auto start = static_cast<std::size_t>(x);
    sumLine(&across[start], &sums[start], row, height, radius);
  });
  return sums;
}

OpenMean::OpenMean(const Plane& open, int width, int height, int radius, int hole)
    : m_width(width), m_height(height), m_radius(radius), m_hole(hole), m_count(sum(open)) {}

Plane OpenMean::operator()(const Plane& plane) const {
  Plane means = sum(plane);
  for (std::size_t i = 0; i < means.size(); ++i)
    means[i] = m_count[i] > 0.5F ? means[i] / m_count[i] : 0.0F;
  return means;
}

Plane OpenMean::sum(const Plane& plane) const {
  Plane sums = boxSum(plane, m_width, m_height, m_radius);
  if (m_hole < 0)
    return sums;
  const Plane middle = boxSum(plane, m_width, m_height, m_hole);
  for (std::size_t i = 0; i < sums.size(); ++i)
    sums[i] -= middle[i];
  return sums;
}

} // namespace fenestra
