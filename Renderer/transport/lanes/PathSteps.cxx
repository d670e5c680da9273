#include "transport/lanes/PathSteps.h"

#include "base/LaneTargets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/lanes/PathSteps.cxx"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include "transport/lanes/Clip-inl.h"
#include "transport/lanes/LightSet-inl.h"
#include "transport/lanes/Matter-inl.h"
#include "transport/lanes/Scattering-inl.h"
HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {
namespace {

/// A path's own random numbers: hashes of a counter and a key.
struct Draws {
  U key, counter;

  HWY_INLINE U nextBits() {
    counter = hn::Add(counter, hn::Set(bits, 0x9e3779b9U));
    return mixBits(hn::Xor(counter, key));
  }
  HWY_INLINE F uniform() { return uniformOf(nextBits()); }
};

HWY_INLINE F3 loadFrom(const Columns3& columns, std::size_t i) {
  return {hn::LoadU(floats, &columns[0][i]), hn::LoadU(floats, &columns[1][i]),
          hn::LoadU(floats, &columns[2][i])};
}
HWY_INLINE void storeTo(Columns3& columns, std::size_t i, const F3& v) {
  hn::StoreU(v.x, floats, &columns[0][i]);
  hn::StoreU(v.y, floats, &columns[1][i]);
  hn::StoreU(v.z, floats, &columns[2][i]);
}

/// One path a lane, at its collision.
struct Collisions {
  M going;  ///< lanes that scatter
  M first;  ///< lanes that scatter for the first time
  F3 index; ///< points, index space
  F scalar;
  F3 incoming, weight;
  F3 albedo, gradient; ///< gradient: 0 unless needed
  M surface;
};

template <typename Voxel>
class Events {
public:
  Events(const WideScene& volume, const EventScene& scene, PathBatch& paths, LightBatch& lights)
      : m_volume(volume), m_scene(scene), m_paths(paths), m_out(lights), m_lights(scene) {}

  void run(Counters& counters) {
    m_out.rays.size = 0;
    m_paths.endedCount = 0;
    for (std::size_t i = 0; i < m_paths.rays.size; i += hn::Lanes(floats))
      step(i);
    counters.collisions += m_collisions;
    counters.gradients += m_gradients;
    counters.shadowRays += m_out.rays.size;
  }

private:
  void step(std::size_t i) {
    const M there = hn::FirstN(floats, m_paths.rays.size - i);
    const F distance = hn::LoadU(floats, &m_paths.rays.result[i]);
    const I bounces = hn::LoadU(ints, &m_paths.bounces[i]);
    const M first = hn::RebindMask(floats, hn::Eq(bounces, hn::Zero(ints)));
    const F3 origin = loadFrom(m_paths.rays.origin, i);
    gather(i, hn::AndNot(first, there), origin, distance);

    const M escaped = hn::Eq(distance, all(std::numeric_limits<float>::infinity()));
    const M free = hn::RebindMask(floats, hn::Lt(bounces, hn::Set(ints, m_scene.bounces)));
    const M going = hn::AndNot(escaped, both(there, free));
    m_collisions += hn::CountTrue(floats, going);
    M alive = going;
    if (!hn::AllFalse(floats, going)) {
      const I one = hn::IfThenElseZero(hn::RebindMask(ints, going), hn::Set(ints, 1));
      hn::StoreU(hn::Add(bounces, one), ints, &m_paths.bounces[i]);
      alive = collide(i, going, both(first, going), origin, hn::IfThenElseZero(going, distance));
    }
    listEnded(i, hn::AndNot(alive, there));
  }

  /// Adds the light that scattered rays met before their collisions, or at infinity.
  HWY_INLINE void gather(std::size_t i, M scattered, const F3& origin, F distance) {
    if (hn::AllFalse(floats, scattered))
      return;
    const F3 light = m_lights.arriving(scattered, mapPoint(m_scene.toLocal, origin),
                                       loadFrom(m_paths.direction, i), distance,
                                       hn::LoadU(floats, &m_paths.scatterPdf[i]));
    const F3 sum = loadFrom(m_paths.radiance, i);
    storeTo(m_paths.radiance, i, select(scattered, sum + loadFrom(m_paths.weight, i) * light, sum));
  }

  /// Scatters the lanes of `going`; returns the lanes that go on afterwards.
  M collide(std::size_t i, M going, M first, const F3& origin, F distance) {
    Draws draws{hn::LoadU(bits, &m_paths.key[i]), hn::LoadU(bits, &m_paths.counter[i])};
    const F3 index = origin + distance * loadFrom(m_paths.rays.direction, i);
    const Collisions at = matter(i, going, first, index, draws);
    if (!hn::AllFalse(floats, first))
      recordFirst(i, at, distance);

    const WidePhase phase(m_scene, at.incoming, at.albedo);
    const bool surfaces = !hn::AllFalse(floats, at.surface);
    const auto surface = [&] { return WideSurface(m_scene, at.incoming, at.gradient, at.albedo); };
    if (m_lights.some())
      sampleLights(i, at, draws, [&](const F3& toward) {
        const Scattered s = phase.toward(toward);
        if (!surfaces)
          return s;
        const Scattered o = surface().toward(toward);
        return Scattered{select(at.surface, o.factor, s.factor),
                         hn::IfThenElse(at.surface, o.pdf, s.pdf)};
      });

    const F choice = m_scene.hybrid ? draws.uniform() : all(0.0F); // independent of neighbours
    const F u = draws.uniform();
    const F v = draws.uniform();
    ScatterDraw drawn = phase.draw(u, v);
    if (surfaces) {
      const ScatterDraw other = surface().draw(choice, u, v);
      drawn = {select(at.surface, other.outgoing, drawn.outgoing),
               select(at.surface, other.weight, drawn.weight),
               hn::IfThenElse(at.surface, other.pdf, drawn.pdf)};
    }
    return goOn(i, at, drawn, draws);
  }

  HWY_INLINE Collisions matter(std::size_t i, M going, M first, const F3& index, Draws& draws) {
    const F zero = hn::Zero(floats);
    Collisions at{going,
                  first,
                  index,
                  hn::LoadU(floats, &m_paths.rays.scalar[i]),
                  loadFrom(m_paths.direction, i),
                  loadFrom(m_paths.weight, i),
                  {},
                  {zero, zero, zero},
                  noLane()};
    at.albedo = albedoOf(m_scene.albedo, at.scalar);
    if (m_volume.context)
      at.albedo = paled(*m_volume.context, index, at.albedo);
    const bool recorded = m_scene.wantNormals && !hn::AllFalse(floats, first);
    if (m_scene.hybrid || recorded) {
      at.gradient = gradientAt(index);
      m_gradients += hn::CountTrue(floats, m_scene.hybrid ? going : first);
    }
    if (m_scene.hybrid) {
      if (m_volume.cutSlope > 0.0F)
        at.gradient = at.gradient + cutGradient(m_volume, index, going);
      const F slope = hn::Sqrt(dot(at.gradient, at.gradient));
      const F chance = surfaceChance(m_volume, m_scene, at.scalar, slope);
      at.surface = both(going, hn::Lt(draws.uniform(), chance));
    }
    return at;
  }

  F3 gradientAt(const F3& p) const {
    const F3 difference = differenceAt<Voxel>(m_volume.field, p);
    return mapDirection(m_scene.indexDifferenceToGradient, difference);
  }

  void recordFirst(std::size_t i, const Collisions& at, F distance) {
    const auto keep = [&](F now, Column<float>& column) {
      const F before = hn::LoadU(floats, &column[i]);
      hn::StoreU(hn::IfThenElse(at.first, now, before), floats, &column[i]);
    };
    const auto keep3 = [&](const F3& now, Columns3& columns) {
      keep(now.x, columns[0]);
      keep(now.y, columns[1]);
      keep(now.z, columns[2]);
    };
    keep(distance, m_paths.firstDistance);
    keep3(at.albedo, m_paths.firstAlbedo);
    const F slope = hn::Sqrt(dot(at.gradient, at.gradient));
    const M away = hn::Lt(dot(at.incoming, at.gradient), hn::Zero(floats));
    const F scale = hn::Div(hn::IfThenElse(away, all(1.0F), all(-1.0F)), slope);
    const M some = hn::Gt(slope, hn::Zero(floats));
    keep3(selectElseZero(some, scale * at.gradient), m_paths.firstNormal);
  }

  /// Next-event estimation: one light, to be seen through the volume, weighted against scattering
  /// toward that light.
  template <typename Toward>
  void sampleLights(std::size_t i, const Collisions& at, Draws& draws, Toward&& toward) {
    const F choice = draws.uniform();
    const F u = draws.uniform();
    const F v = draws.uniform();
    const LightDraw light =
        m_lights.draw(at.going, mapPoint(m_scene.toLocal, at.index), choice, u, v);
    const Scattered scattered = toward(light.direction);
    const F zero = hn::Zero(floats);
    const F pdf = hn::Add(light.pdf, hn::IfThenElse(light.delta, zero, scattered.pdf));
    const F3 radiance = hn::Div(all(1.0F), pdf) * (at.weight * scattered.factor * light.radiance);
    const M arrives = both(at.going, hn::Gt(greatest(radiance), zero));
    const std::size_t count = hn::CountTrue(floats, arrives);
    const U seed = draws.nextBits();
    if (count == 0)
      return;
    const F3 direction = mapDirection(m_scene.localToIndex, light.direction);
    const F length = hn::Min(light.distance, lengthInside(m_volume, at.index, direction));
    const std::size_t to = m_out.rays.size;
    const auto put = [&](F x, Column<float>& column) {
      hn::StoreU(hn::Compress(x, arrives), floats, &column[to]);
    };
    const auto put3 = [&](const F3& x, Columns3& columns) {
      put(x.x, columns[0]);
      put(x.y, columns[1]);
      put(x.z, columns[2]);
    };
    const auto putBits = [&](U x, Column<std::uint32_t>& column) {
      hn::StoreU(hn::Compress(x, hn::RebindMask(bits, arrives)), bits, &column[to]);
    };
    put3(at.index, m_out.rays.origin);
    put3(direction, m_out.rays.direction);
    put(length, m_out.rays.length);
    put3(radiance, m_out.radiance);
    putBits(seed, m_out.rays.seed);
    putBits(hn::Iota(bits, static_cast<std::uint32_t>(i)), m_out.path);
    m_out.rays.size += count;
  }

  /// Sets the paths' weights and new rays. Returns the lanes that survive Russian roulette.
  HWY_INLINE M goOn(std::size_t i, const Collisions& at, const ScatterDraw& drawn, Draws& draws) {
    const F zero = hn::Zero(floats);
    constexpr auto below = static_cast<float>(rouletteBelow);
    F3 weight = at.weight * drawn.weight;
    const F most = greatest(weight);
    const F chance = hn::Min(hn::Mul(most, all(1.0F / below)), all(1.0F));
    const M survives = hn::Le(draws.uniform(), chance);
    weight = selectElseZero(survives, hn::Div(all(1.0F), chance) * weight);
    storeTo(m_paths.weight, i, weight);
    hn::StoreU(drawn.pdf, floats, &m_paths.scatterPdf[i]);
    storeTo(m_paths.direction, i, drawn.outgoing);
    storeTo(m_paths.rays.origin, i, at.index);
    const F3 direction = mapDirection(m_scene.localToIndex, drawn.outgoing);
    storeTo(m_paths.rays.direction, i, direction);
    hn::StoreU(lengthInside(m_volume, at.index, direction), floats, &m_paths.rays.length[i]);
    hn::StoreU(draws.nextBits(), bits, &m_paths.rays.seed[i]);
    hn::StoreU(draws.counter, bits, &m_paths.counter[i]);
    return both(at.going, hn::Gt(greatest(weight), zero));
  }

  void listEnded(std::size_t i, M ended) {
    const U number = hn::Iota(bits, static_cast<std::uint32_t>(i));
    hn::StoreU(hn::Compress(number, hn::RebindMask(bits, ended)), bits,
               &m_paths.ended[m_paths.endedCount]);
    m_paths.endedCount += hn::CountTrue(floats, ended);
  }

  const WideScene& m_volume;
  const EventScene& m_scene;
  PathBatch& m_paths;
  LightBatch& m_out;
  WideLights m_lights;
  std::size_t m_collisions = 0, m_gradients = 0;
};

void scatterAll(const WideScene& volume, const EventScene& scene, PathBatch& paths,
                LightBatch& lights, Counters& counters) {
  std::visit([&]<typename Voxel>(
                 const Voxel*) { Events<Voxel>(volume, scene, paths, lights).run(counters); },
             volume.voxels);
}

} // namespace
} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fenestra {

HWY_EXPORT(scatterAll);

void WideEvents::scatter(PathBatch& paths, LightBatch& lights, Counters& counters) const {
  HWY_DYNAMIC_DISPATCH(scatterAll)(m_volume, m_scene, paths, lights, counters);
}

void PathBatch::begin(std::size_t i, const Vec3& worldDirection, std::uint64_t randomBits) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    direction[a][i] = narrow(worldDirection[axis]);
    weight[a][i] = 1.0F;
    radiance[a][i] = 0.0F;
  }
  bounces[i] = 0;
  key[i] = static_cast<std::uint32_t>(randomBits);
  counter[i] = static_cast<std::uint32_t>(randomBits >> 32);
}

void PathBatch::move(std::size_t from, std::size_t to) {
  const auto one = [&](auto& column) { column[to] = column[from]; };
  const auto three = [&](Columns3& columns) {
    for (Column<float>& column : columns)
      one(column);
  };
  three(rays.origin);
  three(rays.direction);
  one(rays.length);
  one(rays.seed);
  three(direction);
  three(weight);
  three(radiance);
  one(scatterPdf);
  one(bounces);
  one(key);
  one(counter);
  one(firstDistance);
  three(firstAlbedo);
  three(firstNormal);
}

} // namespace fenestra
#endif
