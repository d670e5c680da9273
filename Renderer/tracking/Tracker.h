#pragma once
// Free paths and transmittance through the clipped, classified volume, by null collisions against a
// majorant grid (Woodcock et al. 1965; Novak et al. 2018 for the terms). Exact: no step size.

#include "clipping/Clip.h"
#include "medium/MajorantGrid.h"
#include "medium/Medium.h"
#include "tracking/Counters.h"
#include "volume/GridWalk.h"

namespace fenestra {

/// A view: grid, medium, majorants and clip outlive it. Rays are in world space, unit direction.
template <typename Voxel>
class Tracker {
public:
  Tracker(const Grid& grid, const Medium<Voxel>& medium, const MajorantGrid& majorants,
          const Clip& clip)
      : m_worldToIndex(grid.worldToIndex),
        m_box(grid.indexBox()),
        m_medium(medium),
        m_majorants(majorants),
        m_clip(clip) {}

  /// Distance (mm) to the next real collision within `range`, or infinity.
  double sampleCollision(const Ray& ray, const Interval& range, Random& random,
                         Counters& counters) const {
    const Ray indexRay = transformed(m_worldToIndex, ray);
    double distance = infinity;
    walkTentative(ray, m_box.clip(indexRay, range), random, counters,
                  [&](double t, double majorant) {
                    if (random.uniform() * majorant >= keptExtinction(ray, indexRay, t, counters))
                      return true; // a null collision
                    distance = t;
                    return false;
                  });
    return distance;
  }

  /// Unbiased estimate of the transmittance over `range`: ratio tracking (Novak et al. 2014), with
  /// Russian roulette where little is left.
  double transmittance(const Ray& ray, const Interval& range, Random& random,
                       Counters& counters) const {
    constexpr double rouletteBelow = 0.1;
    const Ray indexRay = transformed(m_worldToIndex, ray);
    double ratio = 1.0;
    walkTentative(
        ray, m_box.clip(indexRay, range), random, counters, [&](double t, double majorant) {
          ratio *= std::max(0.0, 1.0 - keptExtinction(ray, indexRay, t, counters) / majorant);
          if (ratio < rouletteBelow)
            ratio = random.uniform() * rouletteBelow < ratio ? rouletteBelow : 0.0;
          return ratio > 0.0;
        });
    return ratio;
  }

private:
  /// Calls visit(t, majorant) at each tentative collision until it returns false. One exponential
  /// optical depth is spent across cell borders and drawn anew after each collision. `range` lies
  /// inside the volume: the last cells of an axis may reach beyond it.
  template <typename Visit>
  void walkTentative(const Ray& ray, const Interval& range, Random& random, Counters& counters,
                     Visit&& visit) const {
    double opticalDepth = random.exponential();
    GridWalk walk(transformed(m_majorants.worldToCell(), ray), range, m_majorants.cellCount());
    for (; !walk.done(); walk.next()) {
      const double majorant = m_majorants.majorant(static_cast<std::size_t>(walk.cell()));
      ++counters.cells;
      if (majorant == 0.0) {
        ++counters.skippedCells;
        continue;
      }
      double t = walk.interval().begin;
      for (;;) {
        const double toBorder = (walk.interval().end - t) * majorant;
        if (opticalDepth >= toBorder) {
          opticalDepth -= toBorder;
          break;
        }
        t += opticalDepth / majorant;
        if (!visit(t, majorant))
          return;
        opticalDepth = random.exponential();
      }
    }
  }

  double keptExtinction(const Ray& ray, const Ray& indexRay, double t, Counters& counters) const {
    const double kept = keep(m_clip, ray.at(t));
    if (kept == 0.0)
      return 0.0;
    ++counters.lookups;
    return kept * m_medium.extinction(indexRay.at(t));
  }

  Affine m_worldToIndex;
  Box m_box; ///< of the volume, in index space
  const Medium<Voxel>& m_medium;
  const MajorantGrid& m_majorants;
  const Clip& m_clip;
};

} // namespace fenestra
