#pragma once
// Counts of tracking's work: plain sums, one set a thread, added up after each pass.

#include <cstdint>

namespace fenestra {

struct Counters {
  std::uint64_t paths = 0;
  std::uint64_t collisions = 0;   ///< real ones, of eye and scatter rays
  std::uint64_t lookups = 0;      ///< of the extinction
  std::uint64_t cells = 0;        ///< majorant cells walked through
  std::uint64_t skippedCells = 0; ///< part of `cells`: those with majorant 0
  std::uint64_t shadowRays = 0;
  std::uint64_t gradients = 0; ///< computed at collisions

  Counters& operator+=(const Counters& o) {
    paths += o.paths;
    collisions += o.collisions;
    lookups += o.lookups;
    cells += o.cells;
    skippedCells += o.skippedCells;
    shadowRays += o.shadowRays;
    gradients += o.gradients;
    return *this;
  }
};

} // namespace fenestra
