#include "transport/lanes/PathBatch.h"

#include "base/LaneTargets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/lanes/PathBatch.cxx"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include "base/LaneMath-inl.h"
HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {
namespace {

/// Moves lanes of columns to the front, from place `from` to place `to` on.
struct Packing {
  Shuffle pack;
  std::size_t from, to;

  template <typename T>
  HWY_INLINE void operator()(Column<T>& column) const {
    store(pack(load(&column[from])), &column[to]);
  }
  HWY_INLINE void operator()(Columns3& columns) const {
    for (Column<float>& column : columns)
      (*this)(column);
  }
  template <typename... Columns>
  HWY_INLINE void each(Columns&... columns) const {
    ((*this)(columns), ...);
  }
};

void dropEndedLanes(PathBatch& paths) {
  std::size_t left = 0;
  for (std::size_t i = 0; i < paths.rays.size; i += laneCount) {
    const LaneMask ended = LaneMask::fromBits(paths.ended[i / 64] >> i % 64);
    const LaneMask going = LaneMask::first(paths.rays.size - i).without(ended);
    // All that paths need after their first scattering.
    if (left != i || ended.any())
      Packing{Shuffle::packing(going), i, left}.each(
          paths.rays.origin, paths.rays.direction, paths.rays.length, paths.rays.depth,
          paths.rays.acceptance, paths.direction, paths.weight, paths.radiance, paths.scatterPdf,
          paths.bounces, paths.key, paths.counter, paths.tile, paths.ofTile, paths.firstDepth,
          paths.firstAlbedo, paths.firstNormal);
    left += going.count();
  }
  paths.rays.size = left;
}

} // namespace
} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fenestra {

HWY_EXPORT(dropEndedLanes);

void dropEnded(PathBatch& paths) {
  HWY_DYNAMIC_DISPATCH(dropEndedLanes)(paths);
}

} // namespace fenestra
#endif
