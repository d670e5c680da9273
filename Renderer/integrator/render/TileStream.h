#pragma once
// The samples of one pass, taken by threads path after path, from one tile into the next, so that a
// thread that follows many paths at once never runs short of paths before the pass ends.

#include "image/Film.h"
#include "image/Tiles.h"
#include "integrator/render/EmptyPixels.h"
#include "integrator/render/SamplePlan.h"
#include "integrator/simd/PathIntegrator.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <span>

namespace fenestra {

/// State shared by all threads of a pass: the samples that the pixels of `tiles` have in stage `to`
/// beyond those in the film.
class Pass {
public:
  /// A view of tiles, plan, empty pixels and film. Each finished tile adds the samples of stage
  /// `to` beyond stage `from` to `paths`, as if no pixel were empty.
  Pass(std::span<const int> tiles, const SamplePlan::Stage& from, const SamplePlan::Stage& to,
       const EmptyPixels& empty, const Sampler& source, Film& film,
       std::atomic<std::uint64_t>& paths);

  /// True once all tiles have been added to the film.
  bool isComplete() const { return m_tilesDone == m_tiles.size(); }

  /// Number of tiles that nobody has taken.
  std::size_t tilesLeft() const {
    return m_tiles.size() - std::min<std::size_t>(m_nextTile, m_tiles.size());
  }
  /// Takes the next tiles, `most` at most, for a thread or for another process.
  std::span<const int> take(std::size_t maxCount);
  /// Counts another process's tile, whose samples are in the film again, as added.
  void returnTile(int tile);

private:
  friend class TileStream;

  /// Calls visit(column, row, index in the film) for the pixels of a tile, and returns the samples
  /// that its plan adds to them, as if no pixel were empty.
  template <typename Visit>
  std::uint64_t forEachPixel(int tile, Visit&& visit) const {
    std::uint64_t planned = 0;
    const Tiles::Tile pixels = m_tileGrid.at(tile);
    for (int row = pixels.top; row < pixels.bottom; ++row)
      for (int column = pixels.left; column < pixels.right; ++column) {
        const std::size_t here = m_film.index(column, row);
        planned += m_to.count(here) - m_from.count(here);
        visit(column, row, here);
      }
    return planned;
  }
  void countTile(std::uint64_t planned) {
    m_paths.fetch_add(planned, std::memory_order_relaxed);
    m_tilesDone.fetch_add(1);
  }

  const std::span<const int> m_tiles;
  const Tiles m_tileGrid;
  const SamplePlan::Stage m_from, m_to;
  const EmptyPixels& m_empty;
  Sampler m_sampler;
  Film& m_film;
  std::atomic<std::uint64_t>& m_paths;
  std::atomic<std::size_t> m_nextTile = 0, m_tilesDone = 0;
};

/// One thread's part of a pass: a source of paths for SimdPathIntegrator::trace.
class TileStream {
public:
  /// Takes no more tiles once `pauses` returns true, which must outlive the stream; empty: never.
  TileStream(Pass& pass, const std::function<bool()>& isPaused)
      : m_pass(pass), m_isPaused(isPaused) {}

  /// Random numbers of the starts.
  const Sampler& numbers() const { return m_pass.m_sampler; }
  /// Replaces `starts` by the next ones, `most` at most: fewer only if no more are left.
  void fill(CameraSamples& samples, std::size_t maxCount);
  /// Takes the samples of starts in any order. A tile is added to the film as a whole, with its
  /// last sample; each pixel's samples in the order of their numbers.
  void deliver(std::uint32_t slot, std::uint32_t tileSample, const PathSample& sample) {
    Tile& tile = m_tiles[slot];
    tile.results[tileSample] = sample;
    if (--tile.pending > 0)
      return;
    close(tile);
    m_freeSlots.push_back(slot);
  }

private:
  /// Successive samples of a pixel.
  struct Run {
    int column, row;
    std::uint64_t begin, end;
  };
  struct Tile {
    std::uint64_t planned = 0; ///< number of samples if no pixel were empty
    std::vector<Run> runs;
    std::vector<PathSample> results; ///< of all runs, one after the other
    std::size_t pending = 0;
  };

  bool takeTiles();
  bool openTile();
  void listSamples(Tile& tile, int index) const;
  void close(Tile& tile);

  Pass& m_pass;
  const std::function<bool()>& m_isPaused;
  std::span<const int> m_taken;           ///< tiles that are not yet open
  std::vector<Tile> m_tiles;              ///< open tiles, and free places
  std::vector<std::uint32_t> m_freeSlots; ///< free places in m_tiles
  std::uint32_t m_current = 0;            ///< place of the tile of the next samples
  std::size_t m_left = 0;                 ///< samples left in that tile
  std::size_t m_run = 0;                  ///< their first run there
  std::uint64_t m_next = 0;               ///< its next sample
};

} // namespace fenestra
