#include "image/Tiles.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace fenestra {
namespace {

/// Bits of a number below 2^16, a zero after each.
std::uint32_t spread(int number) {
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
      m_across((width + size - 1) / size),
      m_down((height + size - 1) / size) {}

Tiles::Tile Tiles::at(int index) const {
  const int left = index % m_across * size, top = index / m_across * size;
  return {left, top, std::min(left + size, m_width), std::min(top + size, m_height)};
}

std::vector<int> Tiles::of(const Shard& shard) const {
  std::vector<int> tiles(static_cast<std::size_t>(count()));
  std::iota(tiles.begin(), tiles.end(), 0);
  if (shard.isWhole())
    return tiles;
  std::ranges::sort(
      tiles, {}, [&](int tile) { return spread(tile % m_across) | spread(tile / m_across) << 1; });
  std::vector<int> part;
  for (auto i = static_cast<std::size_t>(shard.index); i < tiles.size();
       i += static_cast<std::size_t>(shard.count))
    part.push_back(tiles[i]);
  std::ranges::sort(part);
  return part;
}

} // namespace fenestra
