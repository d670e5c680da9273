#include "transport/lanes/Tracker.h"

#include "base/Error.h"
#include "base/LaneTargets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/lanes/Tracker.cxx"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include "transport/lanes/Clip-inl.h"
HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {
namespace {

/// Idle lanes take new rays once 1 / refillShare of all lanes are idle.
constexpr std::size_t refillShare = 4;
/// Look-ups wait until at most 1 / crossingShare of the busy lanes are not at a tentative
/// collision.
constexpr std::size_t crossingShare = 3;

/// One axis of the walk through cells, in units of a cell's edge, mirrored for rays that go down,
/// so that all rays go up.
struct AxisWalk {
  F origin, direction; ///< direction: per mm, >= 0
  F inverse;           ///< 1 / direction; infinity: no motion along this axis
  F cell;              ///< cell of the ray, a whole number
  M mirrored;

  /// Walk from the cell of the origin, or from the cell ahead if the origin lies in a face.
  static HWY_INLINE AxisWalk entered(const WideScene::Axis& axis, F origin, F direction) {
    const F perEdge = all(axis.cellsPerVoxel);
    // Clamp below the last face, so that a ray lying in that face starts inside the last cell.
    const F at = hn::Max(
        hn::Min(hn::MulAdd(origin, perEdge, all(0.5F * axis.cellsPerVoxel)), all(axis.insideCells)),
        hn::Zero(floats));
    const F along = hn::Mul(direction, perEdge);
    AxisWalk w;
    w.direction = hn::Abs(along);
    const M moves = hn::Ge(w.direction, all(std::numeric_limits<float>::min()));
    w.direction = hn::IfThenElseZero(moves, w.direction);
    w.inverse = hn::Div(all(1.0F), w.direction);
    w.mirrored = both(moves, hn::Lt(along, hn::Zero(floats)));
    w.origin = hn::IfThenElse(w.mirrored, hn::Sub(all(axis.cells), at), at);
    w.cell = hn::Min(hn::Floor(w.origin), all(axis.cells - 1.0F));
    return w;
  }

  HWY_INLINE void takeFrom(const AxisWalk& other, M which) {
    origin = hn::IfThenElse(which, other.origin, origin);
    direction = hn::IfThenElse(which, other.direction, direction);
    inverse = hn::IfThenElse(which, other.inverse, inverse);
    cell = hn::IfThenElse(which, other.cell, cell);
    mirrored = hn::Or(both(which, other.mirrored), hn::AndNot(which, mirrored));
  }

  /// t (mm) of the face where the ray leaves its cell and `beyond` - 1 further cells.
  HWY_INLINE F toFace(F beyond) const {
    return hn::Mul(hn::Sub(hn::Add(cell, beyond), origin), inverse);
  }

  /// Moves the lanes of `which` to the cell entered at `t`: `beyond` cells further for lanes that
  /// pass `through` a face of this axis, else 0 to `reach` cells (never back, so that rounding
  /// cannot trap a ray).
  HWY_INLINE void advance(M which, M through, F t, F reach, F beyond) {
    const F there = hn::Floor(hn::MulAdd(t, direction, origin));
    const F within = hn::Min(hn::Max(there, cell), hn::Add(cell, reach));
    const F entered = hn::IfThenElse(through, hn::Add(cell, beyond), within);
    cell = hn::IfThenElse(which, entered, cell);
  }

  /// The cell's number along the axis.
  HWY_INLINE F number(const WideScene::Axis& axis) const {
    return hn::IfThenElse(mirrored, hn::Sub(all(axis.cells - 1.0F), cell), cell);
  }

  /// Coordinate at t, index space.
  HWY_INLINE F at(F t, const WideScene::Axis& axis) const {
    const F mirroredAt = hn::MulAdd(t, direction, origin);
    const F cells = hn::IfThenElse(mirrored, hn::Sub(all(axis.cells), mirroredAt), mirroredAt);
    return hn::MulSub(cells, all(axis.cellEdge), all(0.5F));
  }
};

/// Rays of a batch that no lane has taken yet.
struct Queue {
  RayBatch& rays;
  std::size_t next = 0;

  bool empty() const { return next == rays.size; }
};

/// One ray a lane, all followed together.
template <typename Voxel, bool wantRatio>
class Lanes {
public:
  Lanes(const WideScene& scene, Queue& queue)
      : m_scene(scene), m_queue(queue), m_rays(queue.rays) {}

  /// Advances all lanes: collisions found in the step before, then cells. Returns false if no ray
  /// is left.
  bool step() {
    if (m_due)
      collide();
    const std::size_t lanes = hn::Lanes(floats);
    std::size_t count = hn::CountTrue(floats, m_busy);
    if (count + std::max<std::size_t>(1, lanes / refillShare) <= lanes && !m_queue.empty()) {
      handIn();
      refill();
      count = hn::CountTrue(floats, m_busy);
    }
    if (count == 0) {
      handIn();
      return false;
    }
    const bool crossed = cross();
    const std::size_t hits = hn::CountTrue(floats, m_hit);
    m_due = !crossed || (count - hits) * crossingShare <= count;
    if (m_due)
      stop();
    return true;
  }

  void addTo(Counters& counters) const {
    counters.cells += m_cells;
    counters.skippedCells += m_skipped;
    counters.lookups += m_lookups;
  }

private:
  static constexpr std::size_t maxLanes = HWY_MAX_BYTES / sizeof(float);
  struct alignas(64) OfLanes : std::array<float, maxLanes> {};

  /// Gives idle lanes the next rays, while there are any.
  void refill() {
    const std::size_t first = m_queue.next;
    std::uint64_t fresh = 0;
    alignas(64) std::array<std::int32_t, maxLanes> rank = {};
    forEachLane(hn::Not(m_busy), [&](std::size_t lane) {
      if (m_queue.empty())
        return;
      fresh |= std::uint64_t{1} << lane;
      rank[lane] = static_cast<std::int32_t>(m_queue.next - first);
      m_ray[lane] = static_cast<std::uint32_t>(m_queue.next++);
    });
    const M started = maskOf(fresh);
    start(started, first, hn::Load(ints, rank.data()));
    m_busy = hn::Or(m_busy, started);
  }

  /// Gives lanes of `which` rays `first + rank`: neighbours, so that whole vectors are loaded.
  HWY_INLINE void start(M which, std::size_t first, I rank) {
    const auto take = [&](auto& old, const auto& now) {
      old = hn::IfThenElse(hn::RebindMask(hn::DFromV<std::decay_t<decltype(now)>>(), which), now,
                           old);
    };
    const auto ofRays = [&](const auto& column) {
      using Number = typename std::decay_t<decltype(column)>::value_type;
      constexpr hn::Rebind<Number, Floats> d;
      return hn::TableLookupLanes(hn::LoadU(d, &column[first]), hn::IndicesFromVec(d, rank));
    };
    for (std::size_t axis = 0; axis < 3; ++axis)
      m_walk[axis].takeFrom(AxisWalk::entered(m_scene.axes[axis], ofRays(m_rays.origin[axis]),
                                              ofRays(m_rays.direction[axis])),
                            which);
    enterCells();
    take(m_t, hn::Zero(floats));
    take(m_end, ofRays(m_rays.length));
    take(m_ratio, all(1.0F));
    U counter = ofRays(m_rays.seed);
    const F depth = exponential(counter);
    take(m_counter, counter);
    take(m_depth, depth);
  }

  /// Lanes without a collision in their cell and its reach leave these cells. Returns false if no
  /// lane did.
  HWY_INLINE bool cross() {
    const F zero = hn::Zero(floats);
    const F beyond = hn::Add(m_cell.reach, all(1.0F));
    const F x = m_walk[0].toFace(beyond);
    const F y = m_walk[1].toFace(beyond);
    const F z = m_walk[2].toFace(beyond);
    const F toFace = hn::Min(hn::Min(x, y), z);
    const F stop = hn::Min(toFace, m_end);
    const F toStop = hn::Mul(hn::Max(hn::Sub(stop, m_t), zero), m_cell.majorant);
    m_hit = both(m_busy, hn::Lt(m_depth, toStop));
    const M crossing = hn::AndNot(m_hit, m_busy);
    if (hn::AllFalse(floats, crossing))
      return false;
    m_cells += hn::CountTrue(floats, crossing);
    m_skipped += hn::CountTrue(floats, both(crossing, hn::Eq(m_cell.majorant, zero)));
    m_depth = hn::IfThenElse(crossing, hn::Sub(m_depth, toStop), m_depth);
    m_t = hn::IfThenElse(crossing, hn::Max(stop, m_t), m_t);
    const M ended = both(crossing, hn::Ge(toFace, m_end));
    if constexpr (!wantRatio)
      m_t = hn::IfThenElse(ended, all(std::numeric_limits<float>::infinity()), m_t);
    finish(ended);
    const M going = hn::AndNot(ended, crossing);
    const M throughX = hn::Eq(x, toFace);
    const M throughY = hn::AndNot(throughX, hn::Eq(y, toFace));
    const M throughZ = hn::Not(hn::Or(throughX, throughY));
    m_walk[0].advance(going, throughX, toFace, m_cell.reach, beyond);
    m_walk[1].advance(going, throughY, toFace, m_cell.reach, beyond);
    m_walk[2].advance(going, throughZ, toFace, m_cell.reach, beyond);
    enterCells();
    return true;
  }

  /// Moves lanes of m_hit to their collisions, and prefetches voxels.
  HWY_INLINE void stop() {
    m_t = hn::IfThenElse(m_hit, hn::Add(m_t, hn::Div(m_depth, m_cell.majorant)), m_t);
    m_place = placeOf(m_scene.field, point());
    prefetch<Voxel>(m_scene.field, m_place);
  }

  HWY_INLINE void enterCells() {
    const auto& axes = m_scene.axes;
    m_cell = cellsAt(m_scene, m_walk[0].number(axes[0]), m_walk[1].number(axes[1]),
                     m_walk[2].number(axes[2]));
  }

  HWY_INLINE Point point() const {
    return {m_walk[0].at(m_t, m_scene.axes[0]), m_walk[1].at(m_t, m_scene.axes[1]),
            m_walk[2].at(m_t, m_scene.axes[2])};
  }

  /// Handles tentative collisions: a real one ends a flight, every one reduces a transmittance.
  HWY_INLINE void collide() {
    const M hit = m_hit;
    const F majorant = hn::IfThenElse(hit, m_cell.majorant, all(1.0F));
    m_lookups += hn::CountTrue(floats, hit);
    const F scalar = scalarAt<Voxel>(m_scene.field, m_place);
    F extinction = extinctionOf(m_scene, scalar);
    if (m_scene.context && m_scene.context->extinction != 1.0F)
      extinction = hn::IfThenElse(isFocus(*m_scene.context, point()), extinction,
                                  hn::Mul(extinction, all(m_scene.context->extinction)));
    U counter = m_counter;
    const F u = uniform(counter);
    const M cut = both(hit, m_cell.cut());
    if (!hn::AllFalse(floats, cut))
      extinction = clipped(cut, extinction, majorant, u, counter);
    const F share = hn::Div(extinction, majorant);
    if constexpr (wantRatio) {
      constexpr float rouletteBelow = 0.1F;
      const F thinned = hn::Mul(m_ratio, hn::Max(hn::Sub(all(1.0F), share), hn::Zero(floats)));
      const M little = hn::Lt(thinned, all(rouletteBelow));
      const F survived =
          hn::IfThenElseZero(hn::Lt(hn::Mul(u, all(rouletteBelow)), thinned), all(rouletteBelow));
      m_ratio = hn::IfThenElse(hit, hn::IfThenElse(little, survived, thinned), m_ratio);
      finish(both(hit, hn::Le(m_ratio, hn::Zero(floats))));
    } else {
      const M real = both(hit, hn::Lt(u, share));
      m_scalar = hn::IfThenElse(real, scalar, m_scalar);
      finish(real);
    }
    const F depth = exponential(counter);
    m_depth = hn::IfThenElse(hit, depth, m_depth);
    m_counter = hn::IfThenElse(hn::RebindMask(bits, hit), counter, m_counter);
  }

  /// Extinction times keep for lanes of `cut`; unchanged for others. keep is queried only where
  /// needed: for a flight if the collision would be real without clipping (u < extinction /
  /// majorant); for a transmittance if extinction > 0. Seams make a query cost more than everything
  /// else: chance then decides first whether a transmittance's collision would be real without
  /// clipping, and only for real collisions keep is queried (delta instead of ratio tracking; Novák
  /// et al. 2018, section 4.2). Such estimates vary a little more, and cost half.
  HWY_INLINE F clipped(M cut, F extinction, F majorant, F u, U& counter) {
    if constexpr (wantRatio) {
      cut = both(cut, hn::Gt(extinction, hn::Zero(floats)));
      if (m_scene.seams) {
        U after = counter;
        const M isReal = hn::Lt(hn::Mul(uniform(after), majorant), extinction);
        counter = hn::IfThenElse(hn::RebindMask(bits, cut), after, counter);
        extinction = hn::IfThenElse(cut, hn::IfThenElseZero(isReal, majorant), extinction);
        cut = both(cut, isReal);
      }
    } else {
      cut = both(cut, hn::Lt(u, hn::Div(extinction, majorant)));
    }
    if (hn::AllFalse(floats, cut))
      return extinction;
    return hn::IfThenElse(cut, hn::Mul(extinction, keep(m_scene, point(), cut)), extinction);
  }

  /// Makes lanes idle; results stay until handIn().
  HWY_INLINE void finish(M which) {
    m_ended = hn::Or(m_ended, which);
    m_busy = hn::AndNot(which, m_busy);
  }

  /// Stores the results of lanes of m_ended to their rays.
  HWY_INLINE void handIn() {
    OfLanes results, scalars;
    hn::Store(wantRatio ? m_ratio : m_t, floats, results.data());
    hn::Store(m_scalar, floats, scalars.data());
    forEachLane(m_ended, [&](std::size_t lane) {
      m_rays.result[m_ray[lane]] = results[lane];
      if constexpr (!wantRatio)
        m_rays.scalar[m_ray[lane]] = scalars[lane];
    });
    m_ended = noLane();
  }

  const WideScene& m_scene;
  Queue& m_queue;
  RayBatch& m_rays;
  M m_busy = noLane();
  M m_ended = noLane(); ///< lanes with results to hand in
  M m_hit = noLane();   ///< lanes at a tentative collision
  bool m_due = false;   ///< the next step begins with collide()
  std::array<std::uint32_t, maxLanes> m_ray = {};
  std::uint64_t m_cells = 0, m_skipped = 0, m_lookups = 0;

  AxisWalk m_walk[3] = {idleWalk(), idleWalk(), idleWalk()};
  LaneCells m_cell{hn::Zero(ints), hn::Zero(floats), hn::Zero(floats)};
  F m_t = hn::Zero(floats);     ///< mm
  F m_end = hn::Zero(floats);   ///< mm
  F m_depth = hn::Zero(floats); ///< optical depth to the next tentative collision
  F m_ratio = hn::Zero(floats);
  F m_scalar = hn::Zero(floats); ///< at a real collision
  U m_counter = hn::Zero(bits);
  Place m_place{hn::Zero(ints), {m_t, m_t, m_t}}; ///< of the collisions

  static AxisWalk idleWalk() {
    const F zero = hn::Zero(floats);
    return {zero, zero, zero, zero, noLane()};
  }
};

/// Two sets of lanes take turns: while one waits for memory, the other computes.
template <typename Voxel, bool wantRatio>
void followBatch(const WideScene& scene, RayBatch& rays, const StopFlag& stop, Counters& counters) {
  Queue queue{rays};
  Lanes<Voxel, wantRatio> one(scene, queue), other(scene, queue);
  bool oneBusy = true, otherBusy = true;
  for (std::uint32_t steps = 1; oneBusy || otherBusy; ++steps) {
    if (steps % stepsBetweenLooks == 0 && stop.load(std::memory_order_relaxed))
      return;
    if (oneBusy)
      oneBusy = one.step();
    if (otherBusy)
      otherBusy = other.step();
  }
  one.addTo(counters);
  other.addTo(counters);
}

template <bool wantRatio>
void followAll(const WideScene& scene, RayBatch& rays, const StopFlag& stop, Counters& counters) {
  std::visit([&]<typename Voxel>(
                 const Voxel*) { followBatch<Voxel, wantRatio>(scene, rays, stop, counters); },
             scene.voxels);
}

void flyAll(const WideScene& scene, RayBatch& rays, const StopFlag& stop, Counters& counters) {
  followAll<false>(scene, rays, stop, counters);
}
void seeAll(const WideScene& scene, RayBatch& rays, const StopFlag& stop, Counters& counters) {
  followAll<true>(scene, rays, stop, counters);
}
const char* nameOfTarget() {
  return hwy::TargetName(HWY_TARGET);
}

} // namespace
} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fenestra {

HWY_EXPORT(flyAll);
HWY_EXPORT(seeAll);
HWY_EXPORT(nameOfTarget);

void WideTracker::sampleCollisions(RayBatch& rays, Counters& counters) const {
  HWY_DYNAMIC_DISPATCH(flyAll)(m_scene, rays, m_stop, counters);
}

void WideTracker::estimateTransmittances(RayBatch& rays, Counters& counters) const {
  HWY_DYNAMIC_DISPATCH(seeAll)(m_scene, rays, m_stop, counters);
}

namespace {

/// Bits of the instruction sets of both program and machine, pinned or not.
std::int64_t knownSets() {
  static const std::int64_t known = hwy::SupportedTargets() & HWY_TARGETS;
  return known;
}

} // namespace

std::vector<std::string> WideTracker::instructionSets() {
  std::vector<std::string> names;
  for (std::int64_t left = knownSets(); left != 0; left &= left - 1) // the best has the lowest bit
    names.emplace_back(hwy::TargetName(left & -left));
  return names;
}

std::string WideTracker::instructionSet() {
  return HWY_DYNAMIC_DISPATCH(nameOfTarget)();
}

void WideTracker::useInstructionSet(const std::string& name) {
  std::string choices;
  for (std::int64_t left = knownSets(); left != 0; left &= left - 1) {
    const std::int64_t set = left & -left;
    if (name == hwy::TargetName(set)) {
      hwy::SetSupportedTargetsForTest(set);
      return;
    }
    choices.append(choices.empty() ? "" : ", ").append(hwy::TargetName(set));
  }
  throw usageError("FENESTRA_INSTRUCTIONS: " + name +
                   " is no instruction set of this machine, which has " + choices);
}

} // namespace fenestra
#endif
