#include "denoise/filter/BoxSums.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace fenestra::core {
namespace {

/// Running sums along a row.
void sumRow(const float* in, float* out, int count, int radius) {
  double sum = 0.0;
  for (int i = 0; i < std::min(radius, count); ++i)
    sum += static_cast<double>(in[i]);
  for (int i = 0; i < count; ++i) {
    if (i + radius < count)
      sum += static_cast<double>(in[i + radius]);
    if (i - radius - 1 >= 0)
      sum -= static_cast<double>(in[i - radius - 1]);
    out[i] = static_cast<float>(sum);
  }
}

/// Columns that are summed together, since they are adjacent in memory.
constexpr std::size_t columnBlock = 64;

/// Running sums along `columns` columns; `row`: length of a row.
void sumColumns(const float* in, float* out, std::size_t columns, std::size_t row, int height,
                int radius) {
  std::array<double, columnBlock> sums = {};
  const auto add = [&](int y, double sign) {
    const float* from = in + static_cast<std::size_t>(y) * row;
    for (std::size_t x = 0; x < columns; ++x)
      sums[x] += sign * static_cast<double>(from[x]);
  };
  for (int y = 0; y < std::min(radius, height); ++y)
    add(y, 1.0);
  for (int y = 0; y < height; ++y) {
    if (y + radius < height)
      add(y + radius, 1.0);
    if (y - radius - 1 >= 0)
      add(y - radius - 1, -1.0);
    float* to = out + static_cast<std::size_t>(y) * row;
    for (std::size_t x = 0; x < columns; ++x)
      to[x] = static_cast<float>(sums[x]);
  }
}

} // namespace

Plane computeBoxSums(const Plane& plane, int width, int height, int radius) {
  Plane rowSums(plane.size()), sums(plane.size());
  const auto row = static_cast<std::size_t>(width);
  tbb::parallel_for(0, height, [&](int y) {
    const std::size_t start = static_cast<std::size_t>(y) * row;
    sumRow(&plane[start], &rowSums[start], width, radius);
  });
  const std::size_t blocks = (row + columnBlock - 1) / columnBlock;
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    const std::size_t start = block * columnBlock;
    sumColumns(&rowSums[start], &sums[start], std::min(columnBlock, row - start), row, height,
               radius);
  });
  return sums;
}

MaskedMean::MaskedMean(const Plane& active, int width, int height, int radius, int innerRadius)
    : m_width(width),
      m_height(height),
      m_radius(radius),
      m_innerRadius(innerRadius),
      m_count(sum(active)) {}

Plane MaskedMean::operator()(const Plane& plane) const {
  Plane means = sum(plane);
  for (std::size_t i = 0; i < means.size(); ++i)
    means[i] = m_count[i] > 0.5F ? means[i] / m_count[i] : 0.0F;
  return means;
}

Plane MaskedMean::sum(const Plane& plane) const {
  Plane sums = computeBoxSums(plane, m_width, m_height, m_radius);
  if (m_innerRadius < 0)
    return sums;
  const Plane middle = computeBoxSums(plane, m_width, m_height, m_innerRadius);
  for (std::size_t i = 0; i < sums.size(); ++i)
    sums[i] -= middle[i];
  return sums;
}

} // namespace fenestra::core
