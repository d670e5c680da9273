#include "integrator/render/TileStream.h"

#include <utility>

namespace fenestra::core {

Pass::Pass(std::span<const int> tiles, const SamplePlan::Stage& from, const SamplePlan::Stage& to,
           const EmptyPixels& empty, const Sampler& sampler, Film& film,
           std::atomic<std::uint64_t>& paths)
    : m_tiles(tiles),
      m_tileGrid(film.width(), film.height()),
      m_from(from),
      m_to(to),
      m_empty(empty),
      m_sampler(sampler),
      m_film(film),
      m_paths(paths) {}

std::span<const int> Pass::takeTiles() {
  const std::size_t left = m_tiles.size() - std::min<std::size_t>(m_nextTile, m_tiles.size());
  const std::size_t maxCount = std::min<std::size_t>(4, 1 + left / 64);
  const std::size_t first = std::min(m_nextTile.fetch_add(maxCount), m_tiles.size());
  return m_tiles.subspan(first, std::min(maxCount, m_tiles.size() - first));
}

void TileStream::fill(CameraSamples& samples, std::size_t maxCount) {
  const Sampler& sampler = m_pass.m_sampler;
  samples.size = 0;
  samples.isStratified = sampler.isStratified();
  while (samples.size < maxCount && (m_left > 0 || openTile())) {
    const Tile& tile = m_tiles[m_current];
    const Run& run = tile.runs[m_run];
    const Sampler::Stream stream = sampler.stream(m_pass.m_film.index(run.column, run.row), m_next);
    const auto first = static_cast<std::uint32_t>(m_next % stream.maxSamples); // in the stream
    const std::size_t count = std::min(
        {maxCount - samples.size, run.end - m_next, std::size_t{stream.maxSamples} - first});
    const auto begun = static_cast<std::uint32_t>(tile.results.size() - m_left); // in the tile
    const std::size_t size = samples.size;
    for (std::uint32_t i = 0; i < count; ++i) {
      samples.column[size + i] = static_cast<float>(run.column);
      samples.row[size + i] = static_cast<float>(run.row);
      samples.start[size + i] = stream.start;
      samples.key[size + i] = stream.key;
      samples.number[size + i] = first + i;
      samples.tile[size + i] = m_current;
      samples.tileSample[size + i] = begun + i;
    }
    samples.size += count;
    m_left -= count;
    m_next += count;
    if (m_next == run.end && m_left > 0)
      m_next = tile.runs[++m_run].begin;
  }
}

/// Opens the next tile that lacks samples; false if none is left or the pass pauses.
bool TileStream::openTile() {
  if (m_freeSlots.empty()) {
    m_freeSlots.push_back(static_cast<std::uint32_t>(m_tiles.size()));
    m_tiles.emplace_back();
  }
  Tile& tile = m_tiles[m_freeSlots.back()];
  for (;;) {
    if (m_taken.empty()) {
      if (std::exchange(m_hasTaken, true) && Clock::now() >= m_pauseAt.load())
        return false;
      m_taken = m_pass.takeTiles();
      if (m_taken.empty())
        return false;
    }
    listSamples(tile, m_taken.front());
    m_taken = m_taken.subspan(1);
    if (tile.pending > 0)
      break;
    close(tile);
  }
  tile.results.resize(tile.pending);
  m_left = tile.pending;
  m_run = 0;
  m_next = tile.runs[0].begin;
  m_current = m_freeSlots.back();
  m_freeSlots.pop_back();
  return true;
}

/// Lists the samples of tile `index` that the film lacks, pixel by pixel.
void TileStream::listSamples(Tile& tile, int index) const {
  tile.pending = 0;
  tile.runs.clear();
  tile.planned = m_pass.forEachPixel(index, [&](int column, int row, std::size_t here) {
    const std::uint64_t begin = m_pass.m_film.pixels()[here].samples;
    const std::uint64_t end = m_pass.m_to.count(here);
    const std::uint64_t target =
        m_pass.m_empty.contains(column, row) ? std::min<std::uint64_t>(1, end) : end;
    if (begin >= target)
      return;
    tile.runs.push_back({column, row, begin, target});
    tile.pending += target - begin;
  });
}

void TileStream::close(Tile& tile) {
  const PathSample* result = tile.results.data();
  for (const Run& run : tile.runs) {
    PixelSums& sums = m_pass.m_film.at(run.column, run.row);
    for (std::uint64_t number = run.begin; number < run.end; ++number)
      sums.add(*result++);
  }
  m_pass.countTile(tile.planned);
}

} // namespace fenestra::core
