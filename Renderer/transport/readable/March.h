#pragma once
// Expected first collision of an eye ray, by a march with a step size. It serves features of the
// filter, never the picture: any function of the scene, free of noise, may be a feature.

#include "model/medium/Medium.h"
#include "model/volume/Domain.h"
#include "model/volume/GridWalk.h"
#include "transport/readable/MajorantGrid.h"

namespace fenestra {

/// Sums over the first collisions of a ray, weighted by their probability T(t) sigma_t(t) dt; a ray
/// that meets nothing counts as 0.
struct FirstMatter {
  double hit = 0.0;      ///< probability of a collision
  double distance = 0.0; ///< from the ray's origin, mm
  Rgb albedo = Rgb::Zero();
  Vec3 facing = Vec3::Zero(); ///< normal times the probability of scattering at a surface
  Vec3 normal = Vec3::Zero(); ///< unit where the gradient is not zero, world axes, toward the eye
};

/// Accuracy of a march.
struct MarchSteps {
  static constexpr double voxels = 0.5;       ///< a step is at least that long
  static constexpr double opticalDepth = 0.1; ///< or so deep under its cell's majorant
  static constexpr double dark = 0.03;        ///< transmittance at which a ray ends
  static constexpr double coarser = 2.0;      ///< factor of steps on the way to a light
  static constexpr double share = 1.0 / 16.0; ///< of the collisions, for which matter is looked up
};

/// A view: all arguments must outlive the march. Rays are in world space, unit direction.
template <typename Voxel>
class March {
public:
  March(const Domain& domain, const Medium<Voxel>& medium, const MajorantGrid& majorants,
        const Clip& clip)
      : m_domain(domain), m_medium(medium), m_majorants(majorants), m_clip(clip) {}

  FirstMatter along(const Ray& ray, const Interval& range) const {
    const Affine& worldToIndex = m_domain.grid().worldToIndex;
    const Interval inside = m_domain.clip(transformed(worldToIndex, ray), range);
    if (inside.empty())
      return {};
    const Ray entering{ray.at(inside.begin), ray.direction}; // keeps the digits of lengths
    Walk walk{entering, transformed(worldToIndex, entering), inside.begin};
    GridWalk cells(transformed(m_majorants.worldToCell(), entering),
                   {0.0, inside.end - inside.begin}, m_majorants.cellCount());
    for (; !cells.done() && walk.transmittance > MarchSteps::dark; cells.next())
      cross(m_majorants.cell(cells.cell()), cells.interval(), walk);
    collect(walk);
    return walk.met;
  }

  /// Transmittance over `range`, in coarser steps.
  double through(const Ray& ray, const Interval& range) const {
    const Affine& worldToIndex = m_domain.grid().worldToIndex;
    const Interval inside = m_domain.clip(transformed(worldToIndex, ray), range);
    if (inside.empty())
      return 1.0;
    const Ray entering{ray.at(inside.begin), ray.direction};
    const Ray indexRay = transformed(worldToIndex, entering);
    GridWalk cells(transformed(m_majorants.worldToCell(), entering),
                   {0.0, inside.end - inside.begin}, m_majorants.cellCount());
    double depth = 0.0;
    for (; !cells.done() && std::exp(-depth) > MarchSteps::dark; cells.next())
      forEachStep(m_majorants.cell(cells.cell()), cells.interval(), indexRay, MarchSteps::coarser,
                  [&](double t, double length, bool isCut) {
                    const double kept = isCut ? keep(m_clip, entering.at(t)) : 1.0;
                    if (kept > 0.0)
                      depth += length * kept * m_medium.extinction(indexRay.at(t));
                    return true;
                  });
    return std::exp(-depth);
  }

private:
  /// Calls visit(middle, length, whether the clip cuts) for the steps in a cell until it returns
  /// false.
  template <typename Visit>
  static void forEachStep(const MajorantGrid::Cell& cell, const Interval& interval,
                          const Ray& indexRay, double coarser, Visit&& visit) {
    if (cell.majorant == 0.0F)
      return;
    constexpr double mostSteps = 64.0;
    const double length = interval.end - interval.begin;
    const double step =
        coarser * std::max(MarchSteps::voxels / indexRay.direction.norm(),
                           MarchSteps::opticalDepth / static_cast<double>(cell.majorant));
    const double steps = std::clamp(std::ceil(length / step), 1.0, mostSteps);
    const double each = length / steps;
    for (double i = 0.5; i < steps; i += 1.0)
      if (!visit(interval.begin + i * each, each, cell.cut))
        return;
  }

  struct Walk {
    Ray ray, indexRay; ///< from the entry into the domain
    double before;     ///< mm from the ray's origin to there
    double transmittance = 1.0;
    double pending = 0.0; ///< probability of the collisions that are not collected yet
    double moment = 0.0;  ///< of these, times their distance
    FirstMatter met = {};
  };

  void cross(const MajorantGrid::Cell& cell, const Interval& interval, Walk& walk) const {
    forEachStep(cell, interval, walk.indexRay, 1.0, [&](double t, double length, bool isCut) {
      const double kept = isCut ? keep(m_clip, walk.ray.at(t)) : 1.0;
      if (!(kept > 0.0))
        return true;
      const double extinction = kept * m_medium.extinction(walk.indexRay.at(t));
      const double stopped = walk.transmittance * -std::expm1(-extinction * length);
      walk.transmittance -= stopped;
      walk.pending += stopped;
      walk.moment += stopped * t;
      if (walk.pending > MarchSteps::share)
        collect(walk);
      return walk.transmittance > MarchSteps::dark;
    });
  }

  /// Adds the pending collisions with the matter in their middle.
  void collect(Walk& walk) const {
    if (!(walk.pending > 0.0))
      return;
    const double t = walk.moment / walk.pending;
    const Matter matter = m_medium.matter(walk.indexRay.at(t), true);
    walk.met.hit += walk.pending;
    walk.met.distance += walk.pending * (walk.before + t);
    walk.met.albedo += walk.pending * matter.albedo;
    const double slope = matter.gradient.norm();
    const bool away = walk.ray.direction.dot(matter.gradient) < 0.0;
    if (slope > 0.0) {
      const Vec3 normal = matter.gradient * (walk.pending / (away ? slope : -slope));
      walk.met.normal += normal;
      walk.met.facing += matter.surfaceProbability * normal;
    }
    walk.pending = walk.moment = 0.0;
  }

  Domain m_domain;
  const Medium<Voxel>& m_medium;
  const MajorantGrid& m_majorants;
  const Clip& m_clip;
};

} // namespace fenestra
