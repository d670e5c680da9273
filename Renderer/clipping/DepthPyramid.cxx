#include "clipping/DepthPyramid.h"

#include <bit>

namespace fenestra {

namespace {

/// The samples that interpolation between two coordinates reads; rounding included.
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

DepthPyramid::DepthPyramid(const DepthBuffer& buffer) {
  const auto halve = [](std::int64_t columns, std::int64_t rows, const auto& bounds) {
    Level level{(columns + 1) / 2, (rows + 1) / 2, {}};
    level.bounds.reserve(static_cast<std::size_t>(level.columns * level.rows));
    for (std::int64_t row = 0; row < rows; row += 2)
      for (std::int64_t column = 0; column < columns; column += 2) {
        Bounds block;
        for (std::int64_t r = row; r < std::min(row + 2, rows); ++r)
          for (std::int64_t c = column; c < std::min(column + 2, columns); ++c)
            block.include(bounds(r * columns + c));
        level.bounds.push_back(block);
      }
    return level;
  };
  m_levels.push_back(halve(buffer.columns(), buffer.rows(), [&](std::int64_t sample) {
    return Bounds{buffer.at(sample), buffer.at(sample)};
  }));
  while (m_levels.back().bounds.size() > 1) {
    const Level& below = m_levels.back();
    m_levels.push_back(halve(below.columns, below.rows, [&](std::int64_t entry) {
      return below.bounds[static_cast<std::size_t>(entry)];
    }));
  }
}

DepthPyramid::Bounds DepthPyramid::bounds(const DepthBuffer& buffer, const Vec2& a,
                                          const Vec2& b) const {
  const SampleRange columns(buffer.xAxis(), a.x(), b.x());
  const SampleRange rows(buffer.yAxis(), a.y(), b.y());
  // An entry of m_levels[l - 1] spans 2^l samples: a quarter of the range or more, which so meets
  // five at most along each axis, and hardly more than itself.
  const auto longest = std::max(columns.last - columns.first, rows.last - rows.first);
  const auto bits =
      static_cast<std::ptrdiff_t>(std::bit_width(static_cast<std::uint64_t>(longest)));
  const std::ptrdiff_t l = std::clamp<std::ptrdiff_t>(bits - 2, 1, std::ssize(m_levels));
  const Level& level = m_levels[static_cast<std::size_t>(l - 1)];
  Bounds result;
  for (std::int64_t row = rows.first >> l; row <= rows.last >> l; ++row)
    for (std::int64_t column = columns.first >> l; column <= columns.last >> l; ++column)
      result.include(level.bounds[static_cast<std::size_t>(row * level.columns + column)]);
  return result;
}

} // namespace fenestra
