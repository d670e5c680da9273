#pragma once
// Part of a raster of samples, by tiles: where work is worthwhile.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fenestra {

/// Samples [begin, end) of a row.
struct SampleRun {
  std::size_t row, begin, end;
};

/// Square tiles of a raster of samples, some of them marked.
class SampleTiles {
public:
  SampleTiles(std::size_t columns, std::size_t rows)
      : m_columns(columns),
        m_rows(rows),
        m_across((columns + edge - 1) / edge),
        m_marks(m_across * ((rows + edge - 1) / edge), 0) {}

  /// Marks the sample's tile and the tiles around it.
  void markAround(std::size_t column, std::size_t row) {
    const std::size_t x = column / edge, y = row / edge;
    for (std::size_t j = y > 0 ? y - 1 : 0; j < std::min(y + 2, m_marks.size() / m_across); ++j)
      for (std::size_t i = x > 0 ? x - 1 : 0; i < std::min(x + 2, m_across); ++i)
        m_marks[j * m_across + i] = 1;
  }

  /// Samples of marked tiles, and up to `margin`, 0 or 1, samples beside the tiles.
  std::vector<SampleRun> runs(std::size_t margin) const {
    std::vector<SampleRun> runs;
    for (std::size_t row = 0; row < m_rows; ++row) {
      const std::size_t above = (row - std::min(row, margin)) / edge;
      const std::size_t below = std::min(row + margin, m_rows - 1) / edge;
      const auto isMarked = [&](std::size_t tile) {
        return (m_marks[above * m_across + tile] | m_marks[row / edge * m_across + tile] |
                m_marks[below * m_across + tile]) != 0;
      };
      for (std::size_t tile = 0; tile < m_across; ++tile)
        if (isMarked(tile)) {
          const std::size_t begin = tile * edge - std::min(tile * edge, margin);
          const std::size_t end = std::min((tile + 1) * edge + margin, m_columns);
          if (!runs.empty() && runs.back().row == row && runs.back().end >= begin)
            runs.back().end = end;
          else
            runs.push_back({row, begin, end});
        }
    }
    return runs;
  }

private:
  static constexpr std::size_t edge = 16; ///< samples: as far as the finest levels still change

  std::size_t m_columns, m_rows, m_across;
  std::vector<std::uint8_t> m_marks;
};

} // namespace fenestra
