#include "image/Tiles.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace fenestra::core {
namespace {

/// Interleaves the bits of a number below 2^16 with zeros.
std::uint32_t spreadBits(int number) {
  auto bits = static_cast<std::uint32_t>(number);
  bits = (bits | bits << 8) & 0x00ff00ffU;
  bits = (bits | bits << 4) & 0x0f0f0f0fU;
  bits = (bits | bits << 2) & 0x33333333U;
  return (bits | bits << 1) & 0x55555555U;
}

} // namespace

Tiles::Tiles(int width, int height)
    : m_width(width),
      m_height(height),
      m_columns((width + size - 1) / size),
      m_rows((height + size - 1) / size) {}

Tiles::Tile Tiles::at(int index) const {
  const int left = index % m_columns * size, top = index / m_columns * size;
  return {left, top, std::min(left + size, m_width), std::min(top + size, m_height)};
}

std::vector<int> Tiles::select(const Shard& shard) const {
  std::vector<int> tiles(static_cast<std::size_t>(count()));
  std::iota(tiles.begin(), tiles.end(), 0);
  if (shard.isComplete())
    return tiles;
  std::ranges::sort(tiles, {}, [&](int tile) {
    return spreadBits(tile % m_columns) | spreadBits(tile / m_columns) << 1;
  });
  std::vector<int> selected;
  for (auto i = static_cast<std::size_t>(shard.index); i < tiles.size();
       i += static_cast<std::size_t>(shard.count))
    selected.push_back(tiles[i]);
  std::ranges::sort(selected);
  return selected;
}

} // namespace fenestra::core
