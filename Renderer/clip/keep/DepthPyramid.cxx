#include "clip/keep/DepthPyramid.h"

#include <bit>

namespace fenestra {

namespace {

/// Samples that interpolation between two coordinates reads; rounding included.
struct SampleRange {
  std::int64_t first, last;

  SampleRange(const DepthAxis& axis, double a, double b) {
    constexpr double slack = 1e-3;
    const auto [low, high] = std::minmax({axis.index(a), axis.index(b)});
    first = static_cast<std::int64_t>(std::max(0.0, low - slack));
    last = std::min(axis.size() - 1, static_cast<std::int64_t>(std::ceil(high + slack)));
  }
};

} // namespace

/// Level above one of columns * rows entries; below(i): its entry i.
template <typename Below>
DepthPyramid::Level DepthPyramid::halved(std::int64_t columns, std::int64_t rows,
                                         const Below& below) {
  Level level{(columns + 1) / 2, (rows + 1) / 2, {}};
  level.extremes.reserve(static_cast<std::size_t>(level.columns * level.rows));
  const auto both = [](const Extremes& a, const Extremes& b) {
    return Extremes{std::min(a.least, b.least), std::max(a.greatest, b.greatest)};
  };
  for (std::int64_t row = 0; row < rows; row += 2) {
    const std::int64_t upper = row * columns;
    const std::int64_t lower = std::min(row + 1, rows - 1) * columns;
    for (std::int64_t column = 0; column < columns; column += 2) {
      const std::int64_t next = std::min(column + 1, columns - 1);
      level.extremes.push_back(both(both(below(upper + column), below(upper + next)),
                                    both(below(lower + column), below(lower + next))));
    }
  }
  return level;
}

DepthPyramid::DepthPyramid(const DepthBuffer& buffer, const Seams* seams) {
  const std::vector<float>& depths = buffer.depthsFromReference();
  m_levels.push_back(halved(buffer.columns(), buffer.rows(), [&](std::int64_t sample) {
    const float depth = depths[static_cast<std::size_t>(sample)];
    Extremes extremes{depth, depth};
    if (seams)
      if (const std::int32_t seam = seams->numbers()[static_cast<std::size_t>(sample)]; seam >= 0) {
        const auto& [least, greatest] = seams->reaches()[static_cast<std::size_t>(seam)];
        extremes = {std::min(extremes.least, least), std::max(extremes.greatest, greatest)};
      }
    return extremes;
  }));
  while (m_levels.back().extremes.size() > 1) {
    const Level& below = m_levels.back();
    m_levels.push_back(halved(below.columns, below.rows, [&](std::int64_t entry) {
      return below.extremes[static_cast<std::size_t>(entry)];
    }));
  }
}

DepthPyramid::Bounds DepthPyramid::bounds(const DepthBuffer& buffer, const Vec2& a,
                                          const Vec2& b) const {
  const SampleRange columns(buffer.xAxis(), a.x(), b.x());
  const SampleRange rows(buffer.yAxis(), a.y(), b.y());
  // An entry of m_levels[l - 1] spans 2^l samples. Level l is chosen so that the range spans at
  // most 5 x 5 entries, and the entries reach little beyond the range.
  const auto longest = std::max(columns.last - columns.first, rows.last - rows.first);
  const auto bits =
      static_cast<std::ptrdiff_t>(std::bit_width(static_cast<std::uint64_t>(longest)));
  const std::ptrdiff_t l = std::clamp<std::ptrdiff_t>(bits - 2, 1, std::ssize(m_levels));
  const Level& level = m_levels[static_cast<std::size_t>(l - 1)];
  Extremes extremes{std::numeric_limits<float>::infinity(),
                    -std::numeric_limits<float>::infinity()};
  for (std::int64_t row = rows.first >> l; row <= rows.last >> l; ++row)
    for (std::int64_t column = columns.first >> l; column <= columns.last >> l; ++column) {
      const Extremes& entry =
          level.extremes[static_cast<std::size_t>(row * level.columns + column)];
      extremes.least = std::min(extremes.least, entry.least);
      extremes.greatest = std::max(extremes.greatest, entry.greatest);
    }
  return {buffer.reference() + extremes.least, buffer.reference() + extremes.greatest};
}

} // namespace fenestra
