#include "transport/lanes/March.h"

#include "base/LaneTargets.h"
#include "transport/readable/March.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/lanes/March.cxx"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include "transport/lanes/Matter-inl.h"
HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {
namespace {

/// Neighbouring rays, which end after a similar number of steps.
template <typename Voxel>
class MarchLanes {
public:
  MarchLanes(const WideScene& volume, const EventScene& scene, MarchBatch& batch)
      : m_volume(volume),
        m_scene(scene),
        m_batch(batch),
        m_asksKeep(volume.clipKind != WideScene::ClipKind::none &&
                   (volume.ghost > 0.0F || volume.softness > 0.0F)) {}

  void run(std::size_t first) {
    const F zero = hn::Zero(floats);
    begin(first);
    for (M busy = both(hn::FirstN(floats, m_batch.rays.size - first), hn::Gt(m_end, zero));
         !hn::AllFalse(floats, busy);) {
      step(busy);
      const M lit = hn::Gt(m_transmittance, all(static_cast<float>(MarchSteps::dark)));
      const M going = both(busy, both(lit, hn::Lt(m_t, m_end)));
      const M ended = hn::AndNot(going, busy);
      const F least = hn::IfThenElse(ended, zero, all(static_cast<float>(MarchSteps::share)));
      const M due = both(busy, hn::Gt(m_pending, least));
      if (!hn::AllFalse(floats, due))
        collect(due);
      busy = going;
    }
    store(first);
  }

private:
  void begin(std::size_t first) {
    const F zero = hn::Zero(floats);
    const auto load = [&](const Columns3& c) {
      return F3{hn::LoadU(floats, &c[0][first]), hn::LoadU(floats, &c[1][first]),
                hn::LoadU(floats, &c[2][first])};
    };
    m_origin = load(m_batch.rays.origin);
    m_direction = load(m_batch.rays.direction);
    m_end = hn::LoadU(floats, &m_batch.rays.length[first]);
    m_inverse = {hn::Div(all(1.0F), m_direction.x), hn::Div(all(1.0F), m_direction.y),
                 hn::Div(all(1.0F), m_direction.z)};
    m_shortest = hn::Div(all(static_cast<float>(MarchSteps::voxels)),
                         hn::Sqrt(dot(m_direction, m_direction)));
    m_t = m_pending = m_moment = m_hit = m_distance = zero;
    m_transmittance = all(1.0F);
    m_albedo = m_normal = m_facing = {zero, zero, zero};
  }

  /// Number of the cell along one axis.
  HWY_INLINE F cellOf(const WideScene::Axis& axis, F x) const {
    const F at = hn::MulAdd(x, all(axis.cellsPerVoxel), all(0.5F * axis.cellsPerVoxel));
    return hn::Floor(hn::Min(hn::Max(at, hn::Zero(floats)), all(axis.insideCells)));
  }

  /// t at the face through which a ray leaves the cell and its reach.

  HWY_INLINE F leaving(const WideScene::Axis& axis, F cell, F reach, F origin, F direction,
                       F inverse) const {
    const M down = hn::Lt(direction, hn::Zero(floats));
    const F face =
        hn::IfThenElse(down, hn::Sub(cell, reach), hn::Add(cell, hn::Add(reach, all(1.0F))));
    const F at = hn::MulSub(face, all(axis.cellEdge), all(0.5F));
    const F t = hn::Mul(hn::Sub(at, origin), inverse);
    const M moves = hn::Ge(hn::Abs(direction), all(std::numeric_limits<float>::min()));
    return hn::IfThenElse(moves, t, all(std::numeric_limits<float>::infinity()));
  }

  HWY_INLINE F3 pointAt(F t) const { return m_origin + t * m_direction; }

  /// Each lane leaves an empty cell with its reach, or takes one step in matter.
  HWY_INLINE void step(M busy) {
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
    const M filled = both(busy, hn::Gt(cell.majorant, hn::Zero(floats)));
    const F wanted = hn::Max(
        m_shortest, hn::Div(all(static_cast<float>(MarchSteps::opticalDepth)), cell.majorant));
    const F next = hn::IfThenElse(filled, hn::Min(hn::Add(m_t, wanted), beyond), beyond);
    if (!hn::AllFalse(floats, filled))
      stopLight(filled, cell, next);
    m_t = hn::IfThenElse(busy, next, m_t);
  }

  /// Light that matter stops from m_t to `next`, by its extinction in the middle.
  HWY_INLINE void stopLight(M filled, const LaneCells& cell, F next) {
    const F length = hn::Sub(next, m_t);
    const F middle = hn::MulAdd(all(0.5F), length, m_t);
    const F3 p = pointAt(middle);
    F extinction = extinctionOf(m_volume, scalarAt<Voxel>(m_volume.field, p));
    if (m_volume.context)
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

  /// Adds the pending collisions of the lanes of `due` with the matter in their middle.
  void collect(M due) {
    const F pending = hn::IfThenElseZero(due, m_pending);
    const F t = hn::Div(m_moment, hn::IfThenElse(due, m_pending, all(1.0F)));
    const F3 p = pointAt(hn::IfThenElse(due, t, m_t));
    const F scalar = scalarAt<Voxel>(m_volume.field, p);
    F3 albedo = albedoOf(m_scene.albedo, scalar);
    if (m_volume.context)
      albedo = paled(*m_volume.context, p, albedo);
    m_albedo = m_albedo + pending * albedo;
    const F3 difference = differenceAt<Voxel>(m_volume.field, p);
    const F3 gradient = mapDirection(m_scene.indexDifferenceToGradient, difference);
    const F slope = hn::Sqrt(dot(gradient, gradient));
    const M away = hn::Lt(dot(m_direction, difference), hn::Zero(floats));
    const F scale = hn::Div(hn::IfThenElse(away, pending, hn::Neg(pending)), slope);
    const F3 normal = selectElseZero(hn::Gt(slope, hn::Zero(floats)), scale * gradient);
    m_normal = m_normal + normal;
    if (m_scene.hybrid)
      m_facing = m_facing + surfaceChance(m_volume, m_scene, scalar, slope) * normal;
    m_hit = hn::Add(m_hit, pending);
    m_distance = hn::MulAdd(pending, t, m_distance);
    m_pending = hn::IfThenZeroElse(due, m_pending);
    m_moment = hn::IfThenZeroElse(due, m_moment);
  }

  void store(std::size_t first) {
    const auto put = [&](F value, Column<float>& column) {
      hn::StoreU(value, floats, &column[first]);
    };
    const auto put3 = [&](const F3& value, Columns3& columns) {
      put(value.x, columns[0]);
      put(value.y, columns[1]);
      put(value.z, columns[2]);
    };
    put(m_hit, m_batch.hit);
    put(m_distance, m_batch.distance);
    put3(m_albedo, m_batch.albedo);
    put3(m_normal, m_batch.normal);
    put3(m_facing, m_batch.facing);
  }

  const WideScene& m_volume;
  const EventScene& m_scene;
  MarchBatch& m_batch;
  bool m_asksKeep;
  F3 m_origin, m_direction, m_inverse; ///< index space, per mm
  F m_end, m_shortest;                 ///< mm
  F m_t, m_transmittance, m_pending, m_moment, m_hit, m_distance;
  F3 m_albedo, m_normal, m_facing;
};

void marchAll(const WideScene& volume, const EventScene& scene, MarchBatch& batch) {
  std::visit(
      [&]<typename Voxel>(const Voxel*) {
        MarchLanes<Voxel> lanes(volume, scene, batch);
        for (std::size_t first = 0; first < batch.rays.size; first += hn::Lanes(floats))
          lanes.run(first);
      },
      volume.voxels);
}

} // namespace
} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fenestra {

HWY_EXPORT(marchAll);

void WideMarch::along(MarchBatch& batch) const {
  HWY_DYNAMIC_DISPATCH(marchAll)(m_volume, m_scene, batch);
}

} // namespace fenestra
#endif
