#pragma once
// Tiles of an image, and their distribution among shards that are rendered separately.

#include <vector>

namespace fenestra::core {

/// Shard `index`, from 0, of `count` shards of an image.
struct Shard {
  int index = 0, count = 1;

  bool isComplete() const { return count == 1; }

  bool operator==(const Shard&) const = default;
};

inline constexpr int maxShards = 10000;

/// Squares of `size` pixels, clipped at the right and lower edge; numbered row by row.
class Tiles {
public:
  static constexpr int size = 8;

  /// Columns [left, right) and rows [top, bottom).
  struct Tile {
    int left, top, right, bottom;
  };

  Tiles(int width, int height);

  int count() const { return m_columns * m_rows; }
  Tile at(int index) const;
  /// Indices of a shard's tiles, ascending. Successive tiles of a Morton curve (Morton 1966) belong
  /// to successive shards, so that all shards cover the image evenly and cost about the same.
  std::vector<int> select(const Shard& shard) const;

private:
  int m_width, m_height, m_columns, m_rows;
};

} // namespace fenestra::core
