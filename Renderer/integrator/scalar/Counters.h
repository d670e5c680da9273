#pragma once
// Work counters of an integrator: one set per thread, added up after each pass.

#include <cstdint>

namespace fenestra::core {

struct Counters {
  std::uint64_t paths = 0;
  std::uint64_t collisions = 0;   ///< real collisions of camera and scattered rays
  std::uint64_t lookups = 0;      ///< evaluations of the extinction
  std::uint64_t cells = 0;        ///< majorant cells traversed
  std::uint64_t skippedCells = 0; ///< those of `cells` whose majorant is 0
  std::uint64_t shadowRays = 0;
  std::uint64_t gradients = 0; ///< gradients evaluated at collisions

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

} // namespace fenestra::core
