#include "ranks/SharedRender.h"

namespace fenestra::core {
namespace {

/// Part of a shard that a rank renders.
Shard findPart(const Shard& shard, int rank, int ranks) {
  return {shard.index + shard.count * rank, shard.count * ranks};
}

/// Calls each(pixel) for the pixels of tiles.
template <typename Each>
void forEachPixel(Film& film, std::span<const int> tiles, Each&& each) {
  const Tiles layout(film.width(), film.height());
  for (const int number : tiles) {
    const Tiles::Tile tile = layout.at(number);
    for (int row = tile.top; row < tile.bottom; ++row)
      for (int column = tile.left; column < tile.right; ++column)
        each(film.at(column, row));
  }
}

/// Sends the tiles of each rank, `parts`, to all others.
void joinFilms(const Ranks& ranks, std::span<const std::vector<int>> parts, Film& film) {
  for (int rank = 0; rank < ranks.count(); ++rank) {
    const std::vector<int>& tiles = parts[static_cast<std::size_t>(rank)];
    std::vector<PixelSums> pixels;
    pixels.reserve(tiles.size() * Tiles::size * Tiles::size);
    forEachPixel(film, tiles, [&](const PixelSums& pixel) { pixels.push_back(pixel); });
    ranks.broadcast(std::span(pixels), rank);
    auto next = pixels.begin();
    forEachPixel(film, tiles, [&](PixelSums& pixel) { pixel = *next++; });
  }
}

/// Adds up the work of all ranks on rank 0.
Counters addCounters(const Ranks& ranks, const Counters& own) {
  Counters sum;
  for (int rank = 0; rank < ranks.count(); ++rank) {
    Counters counters = own;
    ranks.broadcast(std::span(&counters, 1), rank);
    sum += counters;
  }
  return ranks.rank() == 0 ? sum : Counters();
}

} // namespace

void shareRender(const Ranks& ranks, const Tiles& tiles, RenderSettings& settings,
                 RenderMonitor& monitor) {
  constexpr double maxPassSeconds = 20.0; // a rank that dies costs at most the last pass
  std::vector<std::vector<int>> parts;
  for (int rank = 0; rank < ranks.count(); ++rank)
    parts.push_back(tiles.select(findPart(settings.shard, rank, ranks.count())));
  settings.shard = findPart(settings.shard, ranks.rank(), ranks.count());
  settings.passSeconds = maxPassSeconds;
  monitor.onPassEnd = [&ranks, parts = std::move(parts),
                       estimateNoise = monitor.onPassEnd](RenderResult& result, PassEnd& end) {
    std::uint64_t agreed[] = {end.isComplete, end.maxNextSamples};
    ranks.minimize(agreed);
    end.isComplete = agreed[0] != 0;
    end.maxNextSamples = agreed[1];
    joinFilms(ranks, parts, result.film);
    result.counters = addCounters(ranks, result.counters);
    if (!end.isComplete || !end.isNoiseDue)
      return;
    if (ranks.rank() == 0)
      estimateNoise(result, end);
    ranks.broadcast(std::span(&end.displayNoise, 1));
  };
}

} // namespace fenestra::core
