#include "denoise/features/SimdRayMarcher.h"

#include "base/SimdTargets.h"
#include "denoise/features/RayMarcher.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "denoise/features/SimdRayMarcher.cxx"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include "integrator/simd/Lookups-inl.h"
HWY_BEFORE_NAMESPACE();
namespace fenestra::core::HWY_NAMESPACE {
namespace {

/// One ray per lane. Neighboring rays form a group, since they need a similar number of steps.
template <typename Voxel>
class Walk {
public:
  /// Rays from index `first` on.
  Walk(const SimdMedium& medium, const RayBatch& rays, std::size_t first, double stepScale,
       bool usesClip)
      : m_medium(medium),
        m_origin(load3(rays.origin, first)),
        m_direction(load3(rays.direction, first)),
        m_way{makeDdaAxis(medium.axes[0], m_origin.x, m_direction.x),
              makeDdaAxis(medium.axes[1], m_origin.y, m_direction.y),
              makeDdaAxis(medium.axes[2], m_origin.z, m_direction.z)},
        m_end(load(&rays.length[first])),
        m_minStep(narrow(stepScale * MarchAccuracy::minVoxels) /
                  sqrt(dot(m_direction, m_direction))),
        m_opticalDepth(narrow(stepScale * MarchAccuracy::opticalDepth)),
        m_usesClip(usesClip && medium.clipKind != SimdMedium::ClipKind::none),
        m_busy(LaneMask::first(rays.size - first) & (m_end > 0.0F)) {}

  bool isDone() const { return !m_busy.any(); }
  Float transmittance() const { return m_transmittance; }
  Float distance50() const { return m_distance50; }
  const Float3& direction() const { return m_direction; }
  HWY_INLINE Float3 pointAt(Float t) const { return m_origin + t * m_direction; }

  /// Each lane skips empty cells, or takes one step in a cell that is not empty. Returns the lanes
  /// whose ray ends.
  HWY_INLINE LaneMask step() {
    LaneCells cell;
    const Float toFace = findCellExit(m_medium, m_way, m_t, cell);
    const Float stop = min(toFace, m_end);
    // Slightly past the face, so that rounding cannot keep the next point in this cell.
    const Float beyond = fma(m_minStep, 0.02F, max(stop, m_t));
    const LaneMask filled = m_busy & (cell.majorant > 0.0F);
    const Float wanted = max(m_minStep, m_opticalDepth / cell.majorant);
    const Float next = select(filled, min(m_t + wanted, beyond), beyond);
    if (filled.any())
      attenuate(filled, cell, next);
    m_t = select(m_busy, next, m_t);
    const LaneMask lit = m_transmittance > narrow(MarchAccuracy::minTransmittance);
    const LaneMask active = m_busy & lit & (m_t < m_end);
    const LaneMask ended = m_busy.without(active);
    m_busy = active;
    return ended;
  }

  /// Collisions not yet collected: their probability and mean distance.
  struct Pending {
    Float probability, middle;
  };
  HWY_INLINE LaneMask hasPending(Float least) const { return m_pending > least; }
  /// Takes those of the lanes of `which`; probability 0 in the others.
  HWY_INLINE Pending take(LaneMask which) {
    const Float t = m_moment / select(which, m_pending, 1.0F);
    const Pending taken{zeroUnless(which, m_pending), select(which, t, m_t)};
    m_pending = select(which, 0.0F, m_pending);
    m_moment = select(which, 0.0F, m_moment);
    return taken;
  }

private:
  /// ln(2 T) for T from 1/2 to 1, by its Padé approximant at 1/2; error below 0.001.
  static HWY_INLINE Float lnOfTwice(Float transmittance) {
    const Float x = 2.0F * transmittance;
    return 3.0F * (x * x - 1.0F) / (x * x + 4.0F * x + 1.0F);
  }

  /// Attenuates the light between m_t and `next`, by the extinction at the center.
  HWY_INLINE void attenuate(LaneMask filled, const LaneCells& cell, Float next) {
    const Float length = next - m_t;
    const Float middle = fma(0.5F, length, m_t);
    const Float3 p = pointAt(middle);
    const Float scalar = interpolateScalar<Voxel>(m_medium.field, p);
    LaneExtinctions all = m_medium.mixture ? evalExtinctions<true>(m_medium, filled, p, scalar)
                                           : evalExtinctions<false>(m_medium, filled, p, scalar);
    if (m_usesClip) {
      const LaneMask cut = filled & cell.isCut;
      if (cut.any())
        all.clipped.setIf(cut, all.clipped * clipWeight(m_medium, p, cut));
    }
    const Float extinction = all.clipped + all.unclipped;
    const Float passed = exp(-(extinction * length));
    const Float stopped = zeroUnless(filled, m_transmittance * (1.0F - passed));
    const Float left = m_transmittance - stopped;
    const LaneMask halved = (m_transmittance > 0.5F).without(left > 0.5F);
    m_distance50 = select(halved, m_t + lnOfTwice(m_transmittance) / extinction, m_distance50);
    m_transmittance = left;
    m_pending = m_pending + stopped;
    m_moment = fma(stopped, middle, m_moment);
  }

  const SimdMedium& m_medium;
  Float3 m_origin, m_direction; ///< index space; direction per mm
  DdaAxis m_way[3];
  Float m_end, m_minStep; ///< mm
  Float m_opticalDepth;   ///< of a step
  bool m_usesClip;
  LaneMask m_busy;
  Float m_t = 0.0F, m_transmittance = 1.0F;
  Float m_pending = 0.0F, m_moment = 0.0F;
  Float m_distance50 = std::numeric_limits<float>::infinity();
};

template <typename Voxel>
class Sums {
public:
  Sums(const SimdMedium& medium, const SimdShading& shading)
      : m_medium(medium), m_shading(shading) {}

  /// Adds the pending collisions of the lanes of `which`, with the medium at their mean distance.
  void collect(Walk<Voxel>& walk, LaneMask which) {
    const auto [probability, middle] = walk.take(which);
    const Float3 p = walk.pointAt(middle);
    const Float scalar = interpolateScalar<Voxel>(m_medium.field, p);
    const Mean mean =
        m_medium.mixture ? evaluateMixture(which, p, scalar) : evaluateSingle(which, p, scalar);
    Float3 albedo = mean.albedo;
    if (m_medium.context)
      albedo = desaturate(*m_medium.context, p, albedo);
    m_albedo = m_albedo + probability * albedo;
    const Float3 difference = scalarDifference<Voxel>(m_shading, m_medium.field, p);
    Float3 gradient = mapDirection(m_shading.indexDifferenceToGradient, difference);
    Float alongRay = dot(walk.direction(), difference); // has the sign of the slope along the ray
    if (m_shading.hybrid && m_medium.cutSlope > 0.0F) {
      gradient = gradient + cutGradient(m_medium, p, which);
      alongRay = dot(mapDirection(m_shading.toLocal, walk.direction()), gradient);
    }
    const Float slope = sqrt(dot(gradient, gradient));
    const Float3 normal = makeNormal(gradient, alongRay, probability);
    m_normal = m_normal + normal;
    if (m_shading.hybrid)
      m_surfaceNormal =
          m_surfaceNormal + mean.opacity * oneMinusExp(m_shading.surfaceRate * slope) * normal;
    m_hit = m_hit + probability;
    m_distance = fma(probability, middle, m_distance);
  }

  /// Albedo, and opacity over 1 mm; means over the components that a collision may sample.
  struct Mean {
    Float3 albedo;
    Float opacity;
  };

  Mean evaluateSingle(LaneMask which, const Float3& p, Float scalar) const {
    return {evalMediumAlbedo(m_shading, which, p, scalar),
            m_shading.hybrid ? oneMinusExp(evalExtinction(m_medium.extinctions, scalar)) : 0.0F};
  }

  Mean evaluateMixture(LaneMask which, const Float3& p, Float scalar) const {
    const Float weight = mixtureClipWeight(m_medium, which, p);
    Mean sums{{0.0F, 0.0F, 0.0F}, 0.0F};
    Float all = 0.0F;
    forEachPart(
        m_medium, which, p, scalar, weight, [&](LaneMask lanes, Int components, Float part) {
          const Float extinction = evalExtinction(m_medium.extinctions, lanes, components, scalar);
          all = all + part;
          sums.albedo =
              sums.albedo + part * evalComponentAlbedo(m_shading, lanes, components, scalar);
          sums.opacity = sums.opacity + part * oneMinusExp(extinction);
        });
    const Float scale = zeroUnless(all > 0.0F, 1.0F / all);
    return {scale * sums.albedo, scale * sums.opacity};
  }

  void write(const Walk<Voxel>& walk, MarchBatch& batch, std::size_t first) const {
    store(walk.distance50(), &batch.distance50[first]);
    store(m_hit, &batch.hit[first]);
    store(m_distance, &batch.distance[first]);
    store3(m_albedo, batch.albedo, first);
    store3(m_normal, batch.normal, first);
    store3(m_surfaceNormal, batch.surfaceNormal, first);
  }

private:
  const SimdMedium& m_medium;
  const SimdShading& m_shading;
  Float m_hit = 0.0F, m_distance = 0.0F;
  Float3 m_albedo{m_hit, m_hit, m_hit}, m_normal{m_hit, m_hit, m_hit},
      m_surfaceNormal{m_hit, m_hit, m_hit};
};

void marchCameraAll(const SimdMedium& medium, const SimdShading& shading, MarchBatch& batch) {
  // Behind a sharp edge the clip weight is 1, and camera rays start there. With a ghost or with
  // unclipped components they start in front of it.
  const bool usesClip = medium.clip.ghost > 0.0F || medium.clip.softness > 0.0F ||
                        (medium.mixture && medium.mixture->hasUnclipped);
  const auto march = [&]<typename Voxel>(const Voxel*) {
    for (std::size_t first = 0; first < batch.rays.size; first += laneCount) {
      Walk<Voxel> walk(medium, batch.rays, first, 1.0, usesClip);
      Sums<Voxel> sums(medium, shading);
      while (!walk.isDone()) {
        const LaneMask ended = walk.step();
        const Float least = select(ended, 0.0F, narrow(MarchAccuracy::groupProbability));
        const LaneMask due = walk.hasPending(least);
        if (due.any())
          sums.collect(walk, due);
      }
      sums.write(walk, batch, first);
    }
  };
  std::visit(march, medium.voxels);
}

void marchShadowAll(const SimdMedium& medium, RayBatch& rays) {
  const auto pass = [&]<typename Voxel>(const Voxel*) {
    for (std::size_t first = 0; first < rays.size; first += laneCount) {
      Walk<Voxel> walk(medium, rays, first, MarchAccuracy::shadowScale, true);
      while (!walk.isDone())
        walk.step();
      store(walk.transmittance(), &rays.result[first]);
    }
  };
  std::visit(pass, medium.voxels);
}

} // namespace
} // namespace fenestra::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fenestra::core {

HWY_EXPORT(marchCameraAll);
HWY_EXPORT(marchShadowAll);

void marchCameraRays(const SimdMedium& medium, const SimdShading& shading, MarchBatch& batch) {
  HWY_DYNAMIC_DISPATCH(marchCameraAll)(medium, shading, batch);
}

void marchShadowRays(const SimdMedium& medium, RayBatch& rays) {
  HWY_DYNAMIC_DISPATCH(marchShadowAll)(medium, rays);
}

} // namespace fenestra::core
#endif
