#include "tracking/WideTracker.h"

#include "core/Error.h"
#include "core/LaneTargets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracking/WideTracker.cxx"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include "tracking/WideLookup-inl.h"
HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {
namespace {

/// Lanes take new rays when this part of them has none.
constexpr std::size_t refillShare = 4;
/// Look-ups wait until all busy lanes but this part of them are at a tentative collision.
constexpr std::size_t crossingShare = 3;

/// One axis of the walk through cells.
struct AxisWalk {
  F origin, inverse;
  F face;      ///< coordinate of the next face
  F next;      ///< t there
  F step;      ///< from one face to the next, with its sign
  F perCell;   ///< mm from one face to the next; 0 for rays that do not move along this axis
  F perLength; ///< faces a mm
  I stride;

  /// Enters the cell that holds `o`, the one ahead where it lies in a face; returns its part of the
  /// linear index.
  HWY_INLINE I enter(const WideScene::Axis& axis, F o, F direction) {
    const F edge = all(axis.cellEdge);
    const F perEdge = all(axis.cellsPerVoxel);
    const F zero = hn::Zero(floats);
    const M down = hn::Lt(direction, zero);
    const F position = hn::Mul(hn::Add(o, all(0.5F)), perEdge);
    const F ahead = hn::Floor(position);
    const F behind = hn::Sub(hn::Ceil(position), all(1.0F));
    const F last = all(static_cast<float>(axis.cells - 1));
    const F cell = hn::Max(hn::Min(hn::IfThenElse(down, behind, ahead), last), zero);
    origin = o;
    inverse = hn::Div(all(1.0F), direction);
    face = hn::MulSub(hn::IfThenElse(down, cell, hn::Add(cell, all(1.0F))), edge, all(0.5F));
    step = hn::IfThenElse(down, hn::Neg(edge), edge);
    perCell = hn::IfThenElseZero(moves(), hn::Abs(hn::Mul(edge, inverse)));
    perLength = hn::Mul(hn::Abs(direction), perEdge);
    stride = hn::IfThenElse(hn::RebindMask(ints, down), hn::Set(ints, -axis.cellStride),
                            hn::Set(ints, axis.cellStride));
    findNext();
    const I bordered = hn::Add(hn::ConvertTo(ints, cell), hn::Set(ints, 1));
    return hn::Mul(bordered, hn::Set(ints, axis.cellStride));
  }

  /// How many faces lie at or before t, at most `most`.
  HWY_INLINE F facesUpTo(F t, F most) const {
    const F count = hn::Add(hn::Floor(hn::Mul(hn::Sub(t, next), perLength)), all(1.0F));
    return hn::IfThenElseZero(hn::Ge(t, next), hn::Min(hn::Max(count, all(1.0F)), most));
  }

  /// Passes `faces` of them; returns the change of the linear index.
  HWY_INLINE I advance(F faces) {
    face = hn::MulAdd(faces, step, face);
    findNext();
    return hn::Mul(hn::ConvertTo(ints, faces), stride);
  }

private:
  HWY_INLINE M moves() const {
    return hn::Lt(hn::Abs(inverse), all(std::numeric_limits<float>::infinity()));
  }
  /// From the face's own coordinate, so that errors do not grow along the ray.
  HWY_INLINE void findNext() {
    const F t = hn::Mul(hn::Sub(face, origin), inverse);
    next = hn::IfThenElse(moves(), t, all(std::numeric_limits<float>::infinity()));
  }
};

/// The rays of a batch that nobody has followed yet.
struct Queue {
  RayBatch& rays;
  std::size_t next = 0;

  bool empty() const { return next == rays.size; }
};

/// As many rays as there are lanes, followed together.
template <typename Voxel, bool wantRatio>
class Lanes {
public:
  Lanes(const WideScene& scene, Queue& queue)
      : m_scene(scene), m_queue(queue), m_rays(queue.rays) {}

  /// A step ahead for all: collisions that were found in the step before, then cells. Returns
  /// whether there was a ray to follow.
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

  /// Lanes of `which` take rays `first + rank`: neighbours, so that whole vectors are loaded.
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
    AxisWalk entered[3];
    I cell = hn::Zero(ints);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const F direction = ofRays(m_rays.direction[axis]);
      take(m_direction[axis], direction);
      cell = hn::Add(
          cell, entered[axis].enter(m_scene.axes[axis], ofRays(m_rays.origin[axis]), direction));
      AxisWalk& walk = m_walk[axis];
      take(walk.origin, entered[axis].origin);
      take(walk.inverse, entered[axis].inverse);
      take(walk.face, entered[axis].face);
      take(walk.step, entered[axis].step);
      take(walk.next, entered[axis].next);
      take(walk.perCell, entered[axis].perCell);
      take(walk.perLength, entered[axis].perLength);
      take(walk.stride, entered[axis].stride);
    }
    take(m_cell, cell);
    take(m_content, contentOf(m_cell));
    take(m_t, hn::Zero(floats));
    take(m_end, ofRays(m_rays.length));
    take(m_ratio, all(1.0F));
    U counter = ofRays(m_rays.seed);
    const F depth = exponential(counter);
    take(m_counter, counter);
    take(m_depth, depth);
  }

  /// Lanes that have no collision in their cell leave it; from an empty one they jump over all the
  /// empty cells around it. Returns whether any did.
  HWY_INLINE bool cross() {
    const F zero = hn::Zero(floats);
    const F around = hn::Max(hn::Neg(m_content), zero);
    const auto leave = [&](const AxisWalk& w) { return hn::MulAdd(around, w.perCell, w.next); };
    const F x = leave(m_walk[0]);
    const F y = leave(m_walk[1]);
    const F z = leave(m_walk[2]);
    const F toFace = hn::Min(hn::Min(x, y), z);
    const F stop = hn::Min(toFace, m_end);
    const F toStop = hn::Mul(hn::Max(hn::Sub(stop, m_t), zero), hn::Max(m_content, zero));
    m_hit = both(m_busy, hn::Lt(m_depth, toStop));
    const M crossing = hn::AndNot(m_hit, m_busy);
    if (hn::AllFalse(floats, crossing))
      return false;
    m_cells += hn::CountTrue(floats, crossing);
    m_skipped += hn::CountTrue(floats, both(crossing, hn::Le(m_content, zero)));
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
    const F all1 = hn::Add(around, all(1.0F));
    const bool jumps = !hn::AllFalse(floats, both(going, hn::Gt(around, zero)));
    const auto pass = [&](AxisWalk& walk, M through) {
      F faces = hn::IfThenElseZero(through, all1);
      if (jumps)
        faces = hn::IfThenElse(through, all1, walk.facesUpTo(toFace, around));
      m_cell = hn::Add(m_cell, walk.advance(hn::IfThenElseZero(going, faces)));
    };
    pass(m_walk[0], throughX);
    pass(m_walk[1], throughY);
    pass(m_walk[2], throughZ);
    m_content = contentOf(m_cell);
    return true;
  }

  /// Lanes with a collision in their cell go there.
  HWY_INLINE void stop() {
    m_t = hn::IfThenElse(m_hit, hn::Add(m_t, hn::Div(m_depth, m_content)), m_t);
    m_place = placeOf(m_scene, point());
    prefetch<Voxel>(m_scene, m_place);
  }

  /// The halves of floats that are stored become floats.
  HWY_INLINE F contentOf(I cell) const {
    const auto* cells = reinterpret_cast<const std::int32_t*>(m_scene.cells.data());
    return hn::BitCast(floats,
                       hn::ShiftLeft<16>(hn::GatherOffset(ints, cells, hn::ShiftLeft<1>(cell))));
  }

  HWY_INLINE Point point() const {
    const auto at = [&](std::size_t axis) {
      return hn::MulAdd(m_t, m_direction[axis], m_walk[axis].origin);
    };
    return {at(0), at(1), at(2)};
  }

  /// Tentative collisions: real ones end a flight, all of them thin a transmittance.
  HWY_INLINE void collide() {
    const M hit = m_hit;
    const F majorant = hn::IfThenElse(hit, m_content, all(1.0F));
    m_lookups += hn::CountTrue(floats, hit);
    const F scalar = scalarAt<Voxel>(m_scene, m_place);
    F extinction = extinctionOf(m_scene, scalar);
    const U last = hn::Set(bits, 0x10000U); // of the half
    const M cut = both(
        hit, hn::RebindMask(floats, hn::Eq(hn::And(hn::BitCast(bits, m_content), last), last)));
    if (!hn::AllFalse(floats, cut))
      extinction = hn::IfThenZeroElse(hn::AndNot(kept(m_scene, point()), cut), extinction);
    const F share = hn::Div(extinction, majorant);

    U counter = m_counter;
    const F u = uniform(counter);
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

  /// Makes lanes idle; they keep their results.
  HWY_INLINE void finish(M which) {
    m_ended = hn::Or(m_ended, which);
    m_busy = hn::AndNot(which, m_busy);
  }

  /// What lanes have found becomes the results of their rays.
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
  M m_ended = noLane(); ///< these have results to hand in
  M m_hit = noLane();   ///< at a tentative collision
  bool m_due = false;   ///< these are to be looked at before anything else
  std::array<std::uint32_t, maxLanes> m_ray = {};
  std::uint64_t m_cells = 0, m_skipped = 0, m_lookups = 0;

  AxisWalk m_walk[3] = {idleWalk(), idleWalk(), idleWalk()};
  I m_cell = hn::Zero(ints);      ///< in the bordered array
  F m_content = hn::Zero(floats); ///< of the cell (WideScene::cells)
  F m_direction[3] = {hn::Zero(floats), hn::Zero(floats), hn::Zero(floats)};
  F m_t = hn::Zero(floats);     ///< mm
  F m_end = hn::Zero(floats);   ///< mm
  F m_depth = hn::Zero(floats); ///< optical depth to the next tentative collision
  F m_ratio = hn::Zero(floats);
  F m_scalar = hn::Zero(floats); ///< at a real collision
  U m_counter = hn::Zero(bits);
  Place m_place{hn::Zero(ints), {m_t, m_t, m_t}}; ///< of the collisions

  static AxisWalk idleWalk() {
    const F zero = hn::Zero(floats);
    return {zero, zero, zero, zero, zero, zero, zero, hn::Zero(ints)};
  }
};

/// Two sets of lanes take turns: while one waits for memory, the other computes.
template <typename Voxel, bool wantRatio>
void followBatch(const WideScene& scene, RayBatch& rays, Counters& counters) {
  Queue queue{rays};
  Lanes<Voxel, wantRatio> one(scene, queue), other(scene, queue);
  bool oneBusy = true, otherBusy = true;
  while (oneBusy || otherBusy) {
    if (oneBusy)
      oneBusy = one.step();
    if (otherBusy)
      otherBusy = other.step();
  }
  one.addTo(counters);
  other.addTo(counters);
}

template <bool wantRatio>
void followAll(const WideScene& scene, RayBatch& rays, Counters& counters) {
  switch (scene.type) {
  case WideScene::VoxelType::uint8:
    return followBatch<std::uint8_t, wantRatio>(scene, rays, counters);
  case WideScene::VoxelType::int16:
    return followBatch<std::int16_t, wantRatio>(scene, rays, counters);
  case WideScene::VoxelType::uint16:
    return followBatch<std::uint16_t, wantRatio>(scene, rays, counters);
  case WideScene::VoxelType::float32:
    return followBatch<float, wantRatio>(scene, rays, counters);
  }
}

void flyAll(const WideScene& scene, RayBatch& rays, Counters& counters) {
  followAll<false>(scene, rays, counters);
}
void seeAll(const WideScene& scene, RayBatch& rays, Counters& counters) {
  followAll<true>(scene, rays, counters);
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
  HWY_DYNAMIC_DISPATCH(flyAll)(m_scene, rays, counters);
}

void WideTracker::estimateTransmittances(RayBatch& rays, Counters& counters) const {
  HWY_DYNAMIC_DISPATCH(seeAll)(m_scene, rays, counters);
}

namespace {

/// Bits of the sets that program and machine have, pinned or not.
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
