#include "transport/render/TileStream.h"

namespace fenestra {
namespace {

/// Ticket of a sample: the tile's place, and the sample's index in the tile.
std::uint64_t ticketOf(std::uint32_t tile, std::size_t sample) {
  return std::uint64_t{tile} << 32 | sample;
}

} // namespace

Pass::Pass(const SamplePlan::Stage& from, const SamplePlan::Stage& to, const EmptyPixels& empty,
           const NumberSource& source, Film& film, std::atomic<std::uint64_t>& paths)
    : m_from(from),
      m_to(to),
      m_empty(empty),
      m_source(source),
      m_film(film),
      m_paths(paths),
      m_tilesAcross((film.width() + tileSize - 1) / tileSize),
      m_tileCount(m_tilesAcross * ((film.height() + tileSize - 1) / tileSize)) {}

std::optional<PathStart> TileStream::next() {
  if (m_left == 0 && !openTile())
    return std::nullopt;
  const std::vector<Sample>& samples = m_tiles[m_current].samples;
  const std::size_t index = samples.size() - m_left--;
  const Sample& sample = samples[index];
  const SampleNumbers numbers =
      m_pass.m_source.numbers(m_pass.m_film.index(sample.column, sample.row), sample.number);
  const Vec2 jitter = uniform2Of(numbers.position);
  return PathStart{sample.column + jitter.x(), sample.row + jitter.y(), numbers,
                   ticketOf(m_current, index)};
}

void TileStream::deliver(std::uint64_t ticket, const PathSample& sample) {
  const auto place = static_cast<std::uint32_t>(ticket >> 32);
  Tile& tile = m_tiles[place];
  tile.results[ticket & 0xffffffffU] = sample;
  if (--tile.awaited > 0)
    return;
  close(tile);
  m_free.push_back(place);
}

/// Makes the next tile that has samples the current one; false if none is left.
bool TileStream::openTile() {
  if (m_free.empty()) {
    m_free.push_back(static_cast<std::uint32_t>(m_tiles.size()));
    m_tiles.emplace_back();
  }
  Tile& tile = m_tiles[m_free.back()];
  for (;;) {
    const int index = m_pass.m_nextTile.fetch_add(1, std::memory_order_relaxed);
    if (index >= m_pass.m_tileCount)
      return false;
    list(tile, index);
    if (!tile.samples.empty())
      break;
    close(tile);
  }
  tile.results.resize(tile.samples.size());
  tile.awaited = tile.samples.size();
  m_left = tile.samples.size();
  m_current = m_free.back();
  m_free.pop_back();
  return true;
}

/// Lists the samples of tile `index`, pixel by pixel.
void TileStream::list(Tile& tile, int index) const {
  tile.planned = 0;
  tile.samples.clear();
  const Film& film = m_pass.m_film;
  const int left = index % m_pass.m_tilesAcross * Pass::tileSize;
  const int top = index / m_pass.m_tilesAcross * Pass::tileSize;
  for (int row = top; row < std::min(top + Pass::tileSize, film.height()); ++row)
    for (int column = left; column < std::min(left + Pass::tileSize, film.width()); ++column) {
      const std::size_t here = film.index(column, row);
      const std::uint64_t begin = m_pass.m_from.count(here);
      const std::uint64_t end = m_pass.m_to.count(here);
      tile.planned += end - begin;
      const std::uint64_t enough = m_pass.m_empty.contains(column, row) ? 1 : end;
      for (std::uint64_t number = begin; number < std::min(end, enough); ++number)
        tile.samples.push_back({column, row, number});
    }
}

void TileStream::close(Tile& tile) {
  for (std::size_t i = 0; i < tile.samples.size(); ++i)
    m_pass.m_film.at(tile.samples[i].column, tile.samples[i].row).add(tile.results[i]);
  m_pass.m_paths.fetch_add(tile.planned, std::memory_order_relaxed);
  m_pass.m_tilesDone.fetch_add(1, std::memory_order_relaxed);
}

} // namespace fenestra
