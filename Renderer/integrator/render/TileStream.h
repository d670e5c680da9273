#pragma once
// The samples of one pass. Threads take them path by path, from one tile into the next, so that a
// thread that traces many paths at once has enough of them until the pass ends.

#include "image/Film.h"
#include "image/Tiles.h"
#include "integrator/render/EmptyPixels.h"
#include "integrator/render/SamplePlan.h"
#include "integrator/simd/PathIntegrator.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <span>

namespace fenestra::core {

/// State of a pass that all threads share: the samples up to stage `to` of the plan that pixels of
/// `tiles` lack in the film.
class Pass {
public:
  /// Non-owning: tiles, plan, empty pixels and film must outlive the pass. Each finished tile adds
  /// its samples from stage `from` to `to` to `paths`; empty pixels count in full.
  Pass(std::span<const int> tiles, const SamplePlan::Stage& from, const SamplePlan::Stage& to,
       const EmptyPixels& empty, const Sampler& sampler, Film& film,
       std::atomic<std::uint64_t>& paths);

  /// True once all tiles have been added to the film.
  bool isComplete() const { return m_tilesDone == m_tiles.size(); }

private:
  friend class TileStream;

  /// Takes the next tiles for a thread: neighboring ones, which read similar parts of the volume;
  /// one at a time near the end, so that all threads get some. Empty: none is left.
  std::span<const int> takeTiles();
  /// Calls visit(column, row, index in the film) for the pixels of a tile. Returns the samples that
  /// the pass adds to them; empty pixels count in full.
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

/// One thread's part of a pass: the source of paths for SimdPathIntegrator::trace.
class TileStream {
public:
  using Clock = std::chrono::steady_clock;

  /// From `pauseAt` on, which must outlive the stream, takes tiles only once.
  TileStream(Pass& pass, const std::atomic<Clock::time_point>& pauseAt)
      : m_pass(pass), m_pauseAt(pauseAt) {}

  /// Generator of the samples' random numbers.
  const Sampler& sampler() const { return m_pass.m_sampler; }
  /// Replaces `samples` by the next ones, at most `maxCount`; fewer only if no more are left.
  void fill(CameraSamples& samples, std::size_t maxCount);
  /// Accepts results in any order. A tile is added to the film as a unit, with its last result, and
  /// each pixel's samples in the order of their indices.
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
    std::uint64_t planned = 0; ///< number of samples; empty pixels count in full
    std::vector<Run> runs;
    std::vector<PathSample> results; ///< of all runs, in order
    std::size_t pending = 0;
  };

  bool openTile();
  void listSamples(Tile& tile, int index) const;
  void close(Tile& tile);

  Pass& m_pass;
  const std::atomic<Clock::time_point>& m_pauseAt;
  bool m_hasTaken = false;                ///< any tiles
  std::span<const int> m_taken;           ///< tiles not yet open
  std::vector<Tile> m_tiles;              ///< open tiles, and free slots
  std::vector<std::uint32_t> m_freeSlots; ///< free slots in m_tiles
  std::uint32_t m_current = 0;            ///< slot of the tile that gives the next samples
  std::size_t m_left = 0;                 ///< samples left in that tile
  std::size_t m_run = 0;                  ///< index of its current run
  std::uint64_t m_next = 0;               ///< next sample in that run
};

} // namespace fenestra::core
