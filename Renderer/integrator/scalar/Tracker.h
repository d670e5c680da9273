#pragma once
// Free-flight sampling and transmittance in the clipped, classified volume, by null collisions
// against a majorant grid (Woodcock et al. 1965; terms as in Novák et al. 2018). Unbiased: there is
// no step size.

#include "base/Random.h"
#include "base/ScalarMath.h"
#include "base/StopFlag.h"
#include "integrator/scalar/Counters.h"
#include "integrator/scalar/MajorantGrid.h"
#include "model/medium/Medium.h"
#include "model/volume/Domain.h"
#include "model/volume/GridWalk.h"

#include <utility>

namespace fenestra::core::scalar {
#include "formulas/Tracking.inl"
} // namespace fenestra::core::scalar

namespace fenestra::core {

/// Delta tracking: t of the first real collision, or infinity. `walk(visit)` calls visit(t,
/// probability of a real collision) at each tentative collision until visit returns false.
/// `acceptance`, uniform in [0, 1), decides about the first one.
template <typename Walk>
double findRealCollision(Walk&& walk, double acceptance, Random& random) {
  double distance = infinity;
  walk([&](double t, double realProbability) {
    if (std::exchange(acceptance, random.uniform()) >= realProbability)
      return true; // a null collision
    distance = t;
    return false;
  });
  return distance;
}

/// Transmittance by ratio tracking (Novák et al. 2014), with Russian roulette below 0.4.
template <typename Walk>
double trackRatio(Walk&& walk, Random& random) {
  double ratio = 1.0;
  walk([&](double, double realProbability) {
    ratio = scalar::attenuate(ratio, realProbability, 1.0);
    if (ratio < scalar::leastRatio)
      ratio = scalar::playRatioRoulette(ratio, random.uniform());
    return ratio > 0.0;
  });
  return ratio;
}

/// Non-owning: medium, majorants, clip and stop must outlive the tracker. Rays are in world space,
/// unit direction. Once `stop` is true, walks end early and results are meaningless.
template <typename Voxel>
class Tracker {
public:
  Tracker(const Domain& domain, const Medium<Voxel>& medium, const MajorantGrid& majorants,
          const Clip& clip, const StopFlag& stop = neverStopped)
      : m_domain(domain), m_medium(medium), m_majorants(majorants), m_clip(clip), m_stop(stop) {}

  /// Distance (mm) to the next real collision within `range`, or infinity. `first`: random numbers
  /// of the first tentative collision, for its optical depth and its acceptance.
  double sampleCollision(const Ray& ray, const Interval& range, const Vec2& first, Random& random,
                         Counters& counters) const {
    const auto walk = [&](auto&& visit) {
      walkTentative(ray, range, toExponential(first.x()), random, counters, visit);
    };
    return findRealCollision(walk, first.y(), random);
  }

  /// Unbiased estimate of the transmittance over `range`.
  double transmittance(const Ray& ray, const Interval& range, Random& random,
                       Counters& counters) const {
    const auto walk = [&](auto&& visit) {
      walkTentative(ray, range, random.exponential(), random, counters, visit);
    };
    return trackRatio(walk, random);
  }

private:
  /// Calls visit(t, extinction / majorant) at each tentative collision until it returns false. An
  /// exponential optical depth is used up across cells, and sampled again after each collision.
  template <typename Visit>
  void walkTentative(const Ray& ray, const Interval& range, double opticalDepth, Random& random,
                     Counters& counters, Visit&& visit) const {
    const Affine& worldToIndex = m_domain.grid().worldToIndex;
    // Cells may extend beyond the volume and its crop, so the domain bounds the walk.
    const Interval inside = m_domain.clip(transformRay(worldToIndex, ray), range);
    if (inside.isEmpty())
      return;
    // Lengths count from the entry into the domain, so that free paths keep their precision even if
    // the ray's origin is far away.
    const Ray entering{ray.at(inside.begin), ray.direction};
    const Ray indexRay = transformRay(worldToIndex, entering);
    GridWalk walk(transformRay(m_majorants.worldToCell(), entering),
                  {0.0, inside.end - inside.begin}, m_majorants.cellCount());
    std::uint32_t steps = 0;
    for (; !walk.isDone(); walk.next()) {
      const MajorantGrid::Cell& cell = m_majorants.cell(walk.cell());
      const double majorant = cell.majorant;
      ++counters.cells;
      if (majorant == 0.0) {
        ++counters.skippedCells;
        continue;
      }
      double t = walk.interval().begin;
      for (;;) {
        const double depthToExit = (walk.interval().end - t) * majorant;
        if (opticalDepth >= depthToExit) {
          opticalDepth -= depthToExit;
          break;
        }
        t += opticalDepth / majorant;
        const double weight = cell.isCut ? clipWeight(m_clip, entering.at(t)) : 1.0;
        double extinction = 0.0;
        if (m_medium.canCollide(weight)) {
          ++counters.lookups;
          extinction = m_medium.extinction(indexRay.at(t), weight);
        }
        if (!visit(inside.begin + t, extinction / majorant))
          return;
        if (++steps % stopPollInterval == 0 && m_stop.load(std::memory_order_relaxed))
          return;
        opticalDepth = random.exponential();
      }
    }
  }

  Domain m_domain;
  const Medium<Voxel>& m_medium;
  const MajorantGrid& m_majorants;
  const Clip& m_clip;
  const StopFlag& m_stop;
};

} // namespace fenestra::core
