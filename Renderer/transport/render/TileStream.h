#pragma once
// The samples of one pass as threads take them: path after path, from one tile into the next, so
// that a thread that follows many paths at once never runs short of them before the pass ends.

#include "image/Film.h"
#include "transport/lanes/PathEstimator.h"
#include "transport/render/EmptyPixels.h"
#include "transport/render/SamplePlan.h"

#include <atomic>
#include <memory>
#include <optional>

namespace fenestra {

/// Shared by all threads of a pass: the samples that a stage of the plan has beyond the stage
/// before, cut into tiles.
class Pass {
public:
  /// A view of plan, empty pixels and film. Tiles that are done add to `paths` as many samples as
  /// were planned for them.
  Pass(const SamplePlan::Stage& from, const SamplePlan::Stage& to, const EmptyPixels& empty,
       std::uint64_t seed, Film& film, std::atomic<std::uint64_t>& paths);

  /// Whether all tiles have been added to the film.
  bool whole() const { return m_tilesDone == m_tileCount; }

private:
  friend class TileStream;
  static constexpr int tileSize = 8; ///< pixels: all samples of a tile are kept until it is done

  const SamplePlan::Stage m_from, m_to;
  const EmptyPixels& m_empty;
  std::uint64_t m_seed;
  Film& m_film;
  std::atomic<std::uint64_t>& m_paths;
  int m_tilesAcross, m_tileCount;
  std::atomic<int> m_nextTile = 0, m_tilesDone = 0;
};

/// One thread's part of a pass: what PathWave and others trace.
class TileStream {
public:
  explicit TileStream(Pass& pass) : m_pass(pass) {}

  /// Where the next path begins; nothing where there is none left.
  std::optional<PathStart> next();
  /// In any order. A tile whose last sample comes in is added to the film: whole, and the samples
  /// of each pixel in their own order.
  void deliver(std::uint64_t ticket, const PathSample& sample);

private:
  struct Sample {
    int column, row;
    std::uint64_t number; ///< of its pixel's
  };
  struct Tile {
    std::uint64_t planned = 0; ///< as many samples as there would be if no pixel were empty
    std::vector<Sample> samples;
    std::vector<PathSample> results;
    std::size_t awaited = 0;
  };

  std::size_t pixel(const Sample& sample) const;
  bool openTile();
  void list(Tile& tile, int index) const;
  void close(Tile& tile);

  Pass& m_pass;
  std::vector<Tile> m_tiles;         ///< those that are open, and room for others
  std::vector<std::uint32_t> m_free; ///< places in m_tiles
  std::uint32_t m_current = 0;       ///< of which the next samples are,
  std::size_t m_left = 0;            ///< and how many of them
};

} // namespace fenestra
