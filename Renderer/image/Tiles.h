#pragma once
// Tiles of a picture, and their share among parts that are rendered by themselves.

#include <vector>

namespace fenestra {

/// Part number `index`, from 0, of `count` of a picture.
struct Shard {
  int index = 0, count = 1;

  bool isComplete() const { return count == 1; }

  bool operator==(const Shard&) const = default;
};

inline constexpr int maxShards = 10000;

/// Squares of `size` pixels, cut off at the right and lower border; numbered row by row.
class Tiles {
public:
  static constexpr int size = 8;

  /// Columns left to right - 1 and rows top to bottom - 1.
  struct Tile {
    int left, top, right, bottom;
  };

  Tiles(int width, int height);

  int count() const { return m_columns * m_rows; }
  Tile at(int index) const;
  /// Numbers of a part's tiles, ascending. Successive tiles of a Morton curve (Morton 1966) belong
  /// to successive parts: each part has tiles from everywhere, and costs about the same.
  std::vector<int> select(const Shard& shard) const;

private:
  int m_width, m_height, m_columns, m_rows;
};

} // namespace fenestra
