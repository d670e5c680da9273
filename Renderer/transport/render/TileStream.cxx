#include "transport/render/TileStream.h"

namespace fenestra {

Pass::Pass(std::span<const int> tiles, const SamplePlan::Stage& from, const SamplePlan::Stage& to,
           const EmptyPixels& empty, const Sampler& source, Film& film,
           std::atomic<std::uint64_t>& paths)
    : m_tiles(tiles),
      m_cut(film.width(), film.height()),
      m_from(from),
      m_to(to),
      m_empty(empty),
      m_source(source),
      m_film(film),
      m_paths(paths) {}

std::span<const int> Pass::take(std::size_t most) {
  const std::size_t first = std::min(m_nextTile.fetch_add(most), m_tiles.size());
  return m_tiles.subspan(first, std::min(most, m_tiles.size() - first));
}

void Pass::takeBack(int tile) {
  added(forPixels(tile, [](int, int, std::size_t) {}));
}

void TileStream::fill(CameraSamples& starts, std::size_t most) {
  const Sampler& source = m_pass.m_source;
  starts.size = 0;
  starts.isStratified = source.isStratified();
  while (starts.size < most && (m_left > 0 || openTile())) {
    const Tile& tile = m_tiles[m_current];
    const Run& run = tile.runs[m_run];
    const Sampler::Stream stream = source.stream(m_pass.m_film.index(run.column, run.row), m_next);
    const auto first = static_cast<std::uint32_t>(m_next % stream.maxSamples);
    const std::size_t count =
        std::min({most - starts.size, run.end - m_next, std::size_t{stream.maxSamples} - first});
    const auto begun = static_cast<std::uint32_t>(tile.results.size() - m_left);
    const std::size_t size = starts.size;
    for (std::uint32_t i = 0; i < count; ++i) {
      starts.column[size + i] = static_cast<float>(run.column);
      starts.row[size + i] = static_cast<float>(run.row);
      starts.start[size + i] = stream.start;
      starts.key[size + i] = stream.key;
      starts.number[size + i] = first + i;
      starts.tile[size + i] = m_current;
      starts.tileSample[size + i] = begun + i;
    }
    starts.size += count;
    m_left -= count;
    m_next += count;
    if (m_next == run.end && m_left > 0)
      m_next = tile.runs[++m_run].begin;
  }
}

/// Takes neighbouring tiles, which meet much of the same matter; one by one when few are left, so
/// that all threads get some. Returns false if none is left, or for a pause.
bool TileStream::takeTiles() {
  if (m_pauses && m_pauses())
    return false;
  m_taken = m_pass.take(std::min<std::size_t>(4, 1 + m_pass.left() / 64));
  return !m_taken.empty();
}

/// Makes the next tile that has samples the current one; false if none is left, or for a pause.
bool TileStream::openTile() {
  if (m_free.empty()) {
    m_free.push_back(static_cast<std::uint32_t>(m_tiles.size()));
    m_tiles.emplace_back();
  }
  Tile& tile = m_tiles[m_free.back()];
  for (;;) {
    if (m_taken.empty() && !takeTiles())
      return false;
    list(tile, m_taken.front());
    m_taken = m_taken.subspan(1);
    if (tile.awaited > 0)
      break;
    close(tile);
  }
  tile.results.resize(tile.awaited);
  m_left = tile.awaited;
  m_run = 0;
  m_next = tile.runs[0].begin;
  m_current = m_free.back();
  m_free.pop_back();
  return true;
}

/// Lists the samples of tile `index` that the film lacks, pixel by pixel.
void TileStream::list(Tile& tile, int index) const {
  tile.awaited = 0;
  tile.runs.clear();
  tile.planned = m_pass.forPixels(index, [&](int column, int row, std::size_t here) {
    const std::uint64_t begin = m_pass.m_film.pixels()[here].samples;
    const std::uint64_t end = m_pass.m_to.count(here);
    const std::uint64_t enough =
        m_pass.m_empty.contains(column, row) ? std::min<std::uint64_t>(1, end) : end;
    if (begin >= enough)
      return;
    tile.runs.push_back({column, row, begin, enough});
    tile.awaited += enough - begin;
  });
}

void TileStream::close(Tile& tile) {
  const PathSample* result = tile.results.data();
  for (const Run& run : tile.runs) {
    PixelSums& sums = m_pass.m_film.at(run.column, run.row);
    for (std::uint64_t number = run.begin; number < run.end; ++number)
      sums.add(*result++);
  }
  m_pass.added(tile.planned);
}

} // namespace fenestra
