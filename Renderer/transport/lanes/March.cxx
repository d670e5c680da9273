#include "transport/lanes/March.h"

#include "base/LaneTargets.h"
#include "transport/readable/March.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/lanes/March.cxx"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include "transport/lanes/Clip-inl.h"
#include "transport/lanes/Matter-inl.h"
HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {
namespace {

/// Neighbouring rays under way, which end after a similar number of steps.
template <typename Voxel>
class Walk {
public:
  /// From ray `first` on.
  Walk(const WideScene& volume, const RayBatch& rays, std::size_t first, double coarser,
       bool asksKeep)
      : m_volume(volume),
        m_origin(load(rays.origin, first)),
        m_direction(load(rays.direction, first)),
        m_inverse{hn::Div(all(1.0F), m_direction.x), hn::Div(all(1.0F), m_direction.y),
                  hn::Div(all(1.0F), m_direction.z)},
        m_end(hn::LoadU(floats, &rays.length[first])),
        m_shortest(hn::Div(all(narrow(coarser * MarchSteps::voxels)),
                           hn::Sqrt(dot(m_direction, m_direction)))),
        m_opticalDepth(all(narrow(coarser * MarchSteps::opticalDepth))),
        m_asksKeep(asksKeep && volume.clipKind != WideScene::ClipKind::none),
        m_busy(both(hn::FirstN(floats, rays.size - first), hn::Gt(m_end, hn::Zero(floats)))) {}

  bool isDone() const { return hn::AllFalse(floats, m_busy); }
  F transmittance() const { return m_transmittance; }
  const F3& direction() const { return m_direction; }
  HWY_INLINE F3 pointAt(F t) const { return m_origin + t * m_direction; }

  /// Each lane leaves an empty cell with its reach, or takes one step in matter. Returns the lanes
  /// that end with it.
  HWY_INLINE M step() {
    const F3 p = pointAt(m_t);
    const auto& axes = m_volume.axes;
    const F x = cellOf(axes[0], p.x), y = cellOf(axes[1], p.y), z = cellOf(axes[2], p.z);
    const LaneCells cell = cellsAt(m_volume, x, y, z);
    const F stop = hn::Min(
        hn::Min(leaving(axes[0], x, cell.reach, m_origin.x, m_direction.x, m_inverse.x),
                leaving(axes[1], y, cell.reach, m_origin.y, m_direction.y, m_inverse.y)),
        hn::Min(leaving(axes[2], z, cell.reach, m_origin.z, m_direction.z, m_inverse.z), m_end));
    // A little beyond the face: the next point lies in the next cell, whatever rounding does.
    const F beyond = hn::MulAdd(m_shortest, all(0.02F), hn::Max(stop, m_t));
    const M filled = both(m_busy, hn::Gt(cell.majorant, hn::Zero(floats)));
    const F wanted = hn::Max(m_shortest, hn::Div(m_opticalDepth, cell.majorant));
    const F wished = hn::IfThenElse(filled, hn::Min(hn::Add(m_t, wanted), beyond), beyond);
    // Further by a float's last place at least: on an axis of a million voxels steps are shorter.
    const F next = hn::Max(wished, hn::Mul(m_t, all(1.0F + 0x1p-22F)));
    if (!hn::AllFalse(floats, filled))
      stopLight(filled, cell, next);
    m_t = hn::IfThenElse(m_busy, next, m_t);
    const M lit = hn::Gt(m_transmittance, all(narrow(MarchSteps::dark)));
    const M going = both(m_busy, both(lit, hn::Lt(m_t, m_end)));
    const M ended = hn::AndNot(going, m_busy);
    m_busy = going;
    return ended;
  }

  /// Collisions that have not been taken: their probability, and the middle of them.
  struct Pending {
    F probability, middle;
  };
  HWY_INLINE M pendingAbove(F least) const { return hn::Gt(m_pending, least); }
  /// Takes those of the lanes of `which`; 0 in the others.
  HWY_INLINE Pending take(M which) {
    const F t = hn::Div(m_moment, hn::IfThenElse(which, m_pending, all(1.0F)));
    const Pending taken{hn::IfThenElseZero(which, m_pending), hn::IfThenElse(which, t, m_t)};
    m_pending = hn::IfThenZeroElse(which, m_pending);
    m_moment = hn::IfThenZeroElse(which, m_moment);
    return taken;
  }

private:
  static HWY_INLINE F3 load(const Columns3& c, std::size_t first) {
    return {hn::LoadU(floats, &c[0][first]), hn::LoadU(floats, &c[1][first]),
            hn::LoadU(floats, &c[2][first])};
  }

  /// Number of the cell along one axis.
  static HWY_INLINE F cellOf(const WideScene::Axis& axis, F x) {
    const F at = hn::MulAdd(x, all(axis.cellsPerVoxel), all(0.5F * axis.cellsPerVoxel));
    return hn::Floor(hn::Min(hn::Max(at, hn::Zero(floats)), all(axis.insideCells)));
  }

  /// t at the face through which a ray leaves the cell and its reach.
  static HWY_INLINE F leaving(const WideScene::Axis& axis, F cell, F reach, F origin, F direction,
                              F inverse) {
    const M down = hn::Lt(direction, hn::Zero(floats));
    const F face =
        hn::IfThenElse(down, hn::Sub(cell, reach), hn::Add(cell, hn::Add(reach, all(1.0F))));
    const F at = hn::MulSub(face, all(axis.cellEdge), all(0.5F));
    const F t = hn::Mul(hn::Sub(at, origin), inverse);
    const M moves = hn::Ge(hn::Abs(direction), all(std::numeric_limits<float>::min()));
    return hn::IfThenElse(moves, t, all(std::numeric_limits<float>::infinity()));
  }

  /// Light that matter stops from m_t to `next`, by its extinction in the middle.
  HWY_INLINE void stopLight(M filled, const LaneCells& cell, F next) {
    const F length = hn::Sub(next, m_t);
    const F middle = hn::MulAdd(all(0.5F), length, m_t);
    const F3 p = pointAt(middle);
    F extinction = extinctionOf(m_volume, scalarAt<Voxel>(m_volume.field, p));
    if (m_volume.context && m_volume.context->extinction != 1.0F)
      extinction = hn::IfThenElse(isFocus(*m_volume.context, p), extinction,
                                  hn::Mul(extinction, all(m_volume.context->extinction)));
    if (m_asksKeep) {
      const M cut = both(filled, cell.cut());
      if (!hn::AllFalse(floats, cut))
        extinction = hn::IfThenElse(cut, hn::Mul(extinction, keep(m_volume, p, cut)), extinction);
    }
    const F passed = hn::Exp(floats, hn::Neg(hn::Mul(extinction, length)));
    const F stopped =
        hn::IfThenElseZero(filled, hn::Mul(m_transmittance, hn::Sub(all(1.0F), passed)));
    m_transmittance = hn::Sub(m_transmittance, stopped);
    m_pending = hn::Add(m_pending, stopped);
    m_moment = hn::MulAdd(stopped, middle, m_moment);
  }

  const WideScene& m_volume;
  F3 m_origin, m_direction, m_inverse; ///< index space, per mm
  F m_end, m_shortest;                 ///< mm
  F m_opticalDepth;                    ///< of a step
  bool m_asksKeep;
  M m_busy;
  F m_t = hn::Zero(floats), m_transmittance = all(1.0F);
  F m_pending = hn::Zero(floats), m_moment = hn::Zero(floats);
};

/// Sums of FirstMatter.
template <typename Voxel>
class Sums {
public:
  Sums(const WideScene& volume, const EventScene& scene) : m_volume(volume), m_scene(scene) {}

  /// Adds the pending collisions of the lanes of `which` with the matter in their middle.
  void collect(Walk<Voxel>& walk, M which) {
    const auto [probability, middle] = walk.take(which);
    const F3 p = walk.pointAt(middle);
    const F scalar = scalarAt<Voxel>(m_volume.field, p);
    F3 albedo = albedoOf(m_scene.albedo, scalar);
    if (m_volume.context)
      albedo = paled(*m_volume.context, p, albedo);
    m_albedo = m_albedo + probability * albedo;
    const F3 difference = differenceAt<Voxel>(m_volume.field, p);
    F3 gradient = mapDirection(m_scene.indexDifferenceToGradient, difference);
    F along = dot(walk.direction(), difference); // of the gradient's sign
    if (m_scene.hybrid && m_volume.cutSlope > 0.0F) {
      gradient = gradient + cutGradient(m_volume, p, which);
      along = dot(mapDirection(m_scene.toLocal, walk.direction()), gradient);
    }
    const F slope = hn::Sqrt(dot(gradient, gradient));
    const M away = hn::Lt(along, hn::Zero(floats));
    const F scale = hn::Div(hn::IfThenElse(away, probability, hn::Neg(probability)), slope);
    const F3 normal = selectElseZero(hn::Gt(slope, hn::Zero(floats)), scale * gradient);
    m_normal = m_normal + normal;
    if (m_scene.hybrid)
      m_facing = m_facing + surfaceChance(m_volume, m_scene, scalar, slope) * normal;
    m_hit = hn::Add(m_hit, probability);
    m_distance = hn::MulAdd(probability, middle, m_distance);
  }

  void store(MarchBatch& batch, std::size_t first) const {
    const auto put = [first](F value, Column<float>& column) {
      hn::StoreU(value, floats, &column[first]);
    };
    const auto put3 = [&](const F3& value, Columns3& columns) {
      put(value.x, columns[0]);
      put(value.y, columns[1]);
      put(value.z, columns[2]);
    };
    put(m_hit, batch.hit);
    put(m_distance, batch.distance);
    put3(m_albedo, batch.albedo);
    put3(m_normal, batch.normal);
    put3(m_facing, batch.facing);
  }

private:
  const WideScene& m_volume;
  const EventScene& m_scene;
  F m_hit = hn::Zero(floats), m_distance = hn::Zero(floats);
  F3 m_albedo{m_hit, m_hit, m_hit}, m_normal{m_hit, m_hit, m_hit}, m_facing{m_hit, m_hit, m_hit};
};

template <typename Voxel>
void marchBatch(const WideScene& volume, const EventScene& scene, MarchBatch& batch) {
  // Eye rays begin behind the surface: only an edge that is not sharp matters there.
  const bool asksKeep = volume.ghost > 0.0F || volume.softness > 0.0F;
  for (std::size_t first = 0; first < batch.rays.size; first += hn::Lanes(floats)) {
    Walk<Voxel> walk(volume, batch.rays, first, 1.0, asksKeep);
    Sums<Voxel> sums(volume, scene);
    while (!walk.isDone()) {
      const M ended = walk.step();
      const F least = hn::IfThenElse(ended, hn::Zero(floats), all(narrow(MarchSteps::share)));
      const M due = walk.pendingAbove(least);
      if (!hn::AllFalse(floats, due))
        sums.collect(walk, due);
    }
    sums.store(batch, first);
  }
}

template <typename Voxel>
void passBatch(const WideScene& volume, RayBatch& rays) {
  for (std::size_t first = 0; first < rays.size; first += hn::Lanes(floats)) {
    Walk<Voxel> walk(volume, rays, first, MarchSteps::coarser, true);
    while (!walk.isDone())
      walk.step();
    hn::StoreU(walk.transmittance(), floats, &rays.result[first]);
  }
}

void marchAll(const WideScene& volume, const EventScene& scene, MarchBatch& batch) {
  std::visit([&]<typename Voxel>(const Voxel*) { marchBatch<Voxel>(volume, scene, batch); },
             volume.voxels);
}

void passAll(const WideScene& volume, RayBatch& rays) {
  std::visit([&]<typename Voxel>(const Voxel*) { passBatch<Voxel>(volume, rays); }, volume.voxels);
}

} // namespace
} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fenestra {

HWY_EXPORT(marchAll);
HWY_EXPORT(passAll);

void WideMarch::along(MarchBatch& batch) const {
  HWY_DYNAMIC_DISPATCH(marchAll)(m_volume, m_scene, batch);
}

void WideMarch::through(RayBatch& rays) const {
  HWY_DYNAMIC_DISPATCH(passAll)(m_volume, rays);
}

} // namespace fenestra
#endif
