#include "clip/field/DepthPyramid.h"

#include <bit>

namespace fenestra::core {

/// Builds the level above one of columns * rows entries, whose entry i is below(i).
template <typename Below>
DepthPyramid::Level DepthPyramid::buildCoarser(std::int64_t columns, std::int64_t rows,
                                               const Below& below) {
  Level level{(columns + 1) / 2, (rows + 1) / 2, {}};
  level.extremes.reserve(static_cast<std::size_t>(level.columns * level.rows));
  for (std::int64_t row = 0; row < rows; row += 2) {
    const std::int64_t upper = row * columns;
    const std::int64_t lower = std::min(row + 1, rows - 1) * columns;
    for (std::int64_t column = 0; column < columns; column += 2) {
      const std::int64_t next = std::min(column + 1, columns - 1);
      level.extremes.push_back(enclose(enclose(below(upper + column), below(upper + next)),
                                       enclose(below(lower + column), below(lower + next))));
    }
  }
  return level;
}

DepthPyramid::DepthPyramid(const DepthBuffer& buffer, const SilhouetteCells* silhouette) {
  const std::vector<float>& depths = buffer.depthsFromReference();
  m_levels.push_back(buildCoarser(buffer.columns(), buffer.rows(), [&](std::int64_t sample) {
    const float depth = depths[static_cast<std::size_t>(sample)];
    const SilhouetteCells::DepthBounds own{depth, depth};
    const SilhouetteCells::DepthBounds* const bounds =
        silhouette ? silhouette->findDepthBounds(sample) : nullptr;
    return bounds ? enclose(own, *bounds) : own;
  }));
  while (m_levels.back().extremes.size() > 1) {
    const Level& below = m_levels.back();
    m_levels.push_back(buildCoarser(below.columns, below.rows, [&](std::int64_t entry) {
      return below.extremes[static_cast<std::size_t>(entry)];
    }));
  }
}

Interval DepthPyramid::bounds(const DepthBuffer& buffer, const Vec2& a, const Vec2& b) const {
  constexpr double slack = 1e-3; // in samples; larger than rounding
  const DepthAxis::SampleRange columns = buffer.xAxis().sampleRange(a.x(), b.x(), slack);
  const DepthAxis::SampleRange rows = buffer.yAxis().sampleRange(a.y(), b.y(), slack);
  // An entry of m_levels[l - 1] spans 2^l samples. Level l is chosen such that the range spans at
  // most 5 x 5 entries, which extend only slightly beyond it.
  const auto longest = std::max(columns.last - columns.first, rows.last - rows.first);
  const auto bits =
      static_cast<std::ptrdiff_t>(std::bit_width(static_cast<std::uint64_t>(longest)));
  const std::ptrdiff_t l = std::clamp<std::ptrdiff_t>(bits - 2, 1, std::ssize(m_levels));
  const Level& level = m_levels[static_cast<std::size_t>(l - 1)];
  constexpr float noDepth = std::numeric_limits<float>::infinity();
  SilhouetteCells::DepthBounds extremes{noDepth, -noDepth};
  for (std::int64_t row = rows.first >> l; row <= rows.last >> l; ++row)
    for (std::int64_t column = columns.first >> l; column <= columns.last >> l; ++column)
      extremes =
          enclose(extremes, level.extremes[static_cast<std::size_t>(row * level.columns + column)]);
  return {buffer.reference() + extremes.min, buffer.reference() + extremes.max};
}

} // namespace fenestra::core
