#pragma once
// Ray marching with a step size: expected first collision of camera rays, and transmittance toward
// lights. Results are feature buffers of the denoiser, not radiance: any noise-free function of the
// scene may be a feature, so the bias of the step size is harmless.

#include "integrator/scalar/ClippedMedium.h"
#include "integrator/scalar/MajorantGrid.h"
#include "model/volume/Domain.h"
#include "model/volume/GridWalk.h"

#include <optional>

namespace fenestra::core {

/// Integrals over the first collision of a ray, weighted by its pdf T(t) sigma_t(t) dt. A ray
/// without collision contributes 0.
struct ExpectedHit {
  double hit = 0.0;             ///< probability of a collision
  double distance = 0.0;        ///< from the ray's origin, mm
  double distance50 = infinity; ///< at which half of the light is stopped; infinity: never
  Rgb albedo = Rgb::Zero();
  Vec3 surfaceNormal = Vec3::Zero(); ///< normal times the probability of scattering at a surface
  Vec3 normal = Vec3::Zero();        ///< unit or zero, world axes, toward the camera
};

/// Accuracy of the ray marcher.
struct MarchAccuracy {
  static constexpr double minVoxels = 0.5;    ///< minimum length of a step
  static constexpr double opticalDepth = 0.1; ///< of a step under its cell's majorant, if longer
  static constexpr double minTransmittance = 0.03; ///< transmittance at which a ray ends
  static constexpr double shadowScale = 2.0;       ///< scale of the steps toward a light
  static constexpr double groupProbability =
      1.0 / 16.0; ///< of collisions per look-up of the medium
};

/// Non-owning: all arguments must outlive the object. Rays are in world space, unit direction.
template <typename Voxel>
class RayMarcher {
public:
  RayMarcher(const Domain& domain, const Medium<Voxel>& medium, const MajorantGrid& majorants,
             const Clip& clip)
      : m_domain(domain), m_medium(medium), m_majorants(majorants), m_clip(clip) {}

  ExpectedHit integrateHits(const Ray& ray, const Interval& range) const {
    const std::optional<Part> part = clipToDomain(ray, range);
    if (!part)
      return {};
    Sums sums;
    forEachStep(*part, 1.0, [&](double t, double length, double extinction) {
      const double before = sums.transmittance;
      const double stopped = before * -std::expm1(-extinction * length);
      sums.transmittance -= stopped;
      if (before > 0.5 && sums.transmittance <= 0.5)
        sums.expected.distance50 =
            part->before + t - 0.5 * length + std::log(2.0 * before) / extinction;
      sums.pending += stopped;
      sums.moment += stopped * t;
      if (sums.pending > MarchAccuracy::groupProbability)
        collect(*part, sums);
      return sums.transmittance > MarchAccuracy::minTransmittance;
    });
    collect(*part, sums);
    return sums.expected;
  }

  /// Transmittance over `range`, in steps longer by MarchAccuracy::shadowScale.
  double computeTransmittance(const Ray& ray, const Interval& range) const {
    const std::optional<Part> part = clipToDomain(ray, range);
    double transmittance = 1.0;
    if (part)
      forEachStep(*part, MarchAccuracy::shadowScale, [&](double, double length, double extinction) {
        transmittance *= std::exp(-extinction * length);
        return transmittance > MarchAccuracy::minTransmittance;
      });
    return transmittance;
  }

private:
  /// Part of a ray inside the domain. Lengths count from its begin to keep their precision.
  struct Part {
    Ray ray, indexRay;
    double before, length; ///< mm: distance from the ray's origin to the part; length of the part
  };
  struct Sums {
    double transmittance = 1.0;
    double pending = 0.0; ///< probability of the collisions not yet collected
    double moment = 0.0;  ///< that probability times distance, summed
    ExpectedHit expected = {};
  };

  std::optional<Part> clipToDomain(const Ray& ray, const Interval& range) const {
    const Affine& worldToIndex = m_domain.grid().worldToIndex;
    const Interval inside = m_domain.clip(transformRay(worldToIndex, ray), range);
    if (inside.isEmpty())
      return std::nullopt;
    const Ray entering{ray.at(inside.begin), ray.direction};
    return Part{entering, transformRay(worldToIndex, entering), inside.begin,
                inside.end - inside.begin};
  }

  /// Calls visit(center, length, extinction at the center) for the steps in non-empty cells until
  /// it returns false.
  template <typename Visit>
  void forEachStep(const Part& part, double stepScale, Visit&& visit) const {
    constexpr double maxSteps = 64.0; // per cell
    const double voxels = MarchAccuracy::minVoxels / part.indexRay.direction.norm();
    GridWalk cells(transformRay(m_majorants.worldToCell(), part.ray), {0.0, part.length},
                   m_majorants.cellCount());
    for (; !cells.isDone(); cells.next()) {
      const MajorantGrid::Cell& cell = m_majorants.cell(cells.cell());
      if (cell.majorant == 0.0F)
        continue;
      const Interval& interval = cells.interval();
      const double length = interval.end - interval.begin;
      const double step = stepScale * std::max(voxels, MarchAccuracy::opticalDepth /
                                                           static_cast<double>(cell.majorant));
      const double steps = std::clamp(std::ceil(length / step), 1.0, maxSteps);
      const double each = length / steps;
      for (double i = 0.5; i < steps; i += 1.0) {
        const double t = interval.begin + i * each;
        const double weight = cell.isCut ? clipWeight(m_clip, part.ray.at(t)) : 1.0;
        if (m_medium.canCollide(weight) &&
            !visit(t, each, m_medium.extinction(part.indexRay.at(t), weight)))
          return;
      }
    }
  }

  /// Adds the pending collisions, all with the medium at their mean distance.
  void collect(const Part& part, Sums& sums) const {
    if (!(sums.pending > 0.0))
      return;
    const double t = sums.moment / sums.pending;
    ExpectedHit& expected = sums.expected;
    expected.hit += sums.pending;
    expected.distance += sums.pending * (part.before + t);
    const auto add = [&](const MediumSample& medium, double probability) {
      const double weight = sums.pending * probability;
      expected.albedo += weight * medium.albedo;
      const double slope = medium.gradient.norm();
      const bool away = part.ray.direction.dot(medium.gradient) < 0.0;
      if (slope > 0.0) {
        const Vec3 normal = medium.gradient * (weight / (away ? slope : -slope));
        expected.normal += normal;
        expected.surfaceNormal += medium.surfaceProbability * normal;
      }
    };
    forEachMediumSample(m_medium, m_clip, part.ray.at(t), part.indexRay.at(t), true, add);
    sums.pending = sums.moment = 0.0;
  }

  Domain m_domain;
  const Medium<Voxel>& m_medium;
  const MajorantGrid& m_majorants;
  const Clip& m_clip;
};

} // namespace fenestra::core
