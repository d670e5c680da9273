#include "integrator/simd/PathSteps.h"

#include "base/SimdTargets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "integrator/simd/PathSteps.cxx"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include "integrator/simd/Lookups-inl.h"
HWY_BEFORE_NAMESPACE();
namespace fenestra::core::HWY_NAMESPACE {
#include "integrator/simd/LightSet-inl.h"
namespace {

/// Random numbers of one path per lane: hashes of a counter and a key.
struct PathRandom {
  UInt key, counter;

  HWY_INLINE UInt nextBits() {
    counter = nextCounter(counter);
    return mixBits(counter ^ key);
  }
  HWY_INLINE Float uniform() { return toUniform(nextBits()); }
};

/// One path per lane, at its collision.
struct Collisions {
  LaneMask active; ///< lanes that scatter
  LaneMask first;  ///< lanes that scatter for the first time
  Float3 index;    ///< points, index space
  Float scalar;
  Float3 incoming, throughput;
  Float3 albedo = {};
  Float3 gradient = {0.0F, 0.0F, 0.0F}; ///< filled if needed
  LaneMask surface = LaneMask::none();
  Int component = 0; ///< sampled from a mixture
};

/// `isMixed`: the medium is a mixture.
template <typename Voxel, bool isMixed>
class VertexHandler {
public:
  VertexHandler(const SimdMedium& medium, const SimdShading& shading, PathBatch& paths,
                ShadowBatch& shadowRays)
      : m_medium(medium), m_shading(shading), m_paths(paths), m_shadowRays(shadowRays) {}

  void run(Counters& counters) {
    m_shadowRays.rays.size = 0;
    m_paths.ended = {};
    for (std::size_t i = 0; i < m_paths.rays.size; i += laneCount)
      step(i);
    counters.collisions += m_collisions;
    counters.gradients += m_gradients;
    counters.shadowRays += m_shadowRays.rays.size;
  }

private:
  void step(std::size_t i) {
    const LaneMask isValid = LaneMask::first(m_paths.rays.size - i);
    const Float distance = load(&m_paths.rays.result[i]);
    const Int bounces = load(&m_paths.bounces[i]);
    const LaneMask first = bounces == 0;
    const Float3 origin = load3(m_paths.rays.origin, i);
    addEmitted(i, isValid.without(first), origin, distance);

    const LaneMask escaped = distance == infiniteReal;
    const LaneMask canScatter = bounces < m_shading.bounces;
    const LaneMask active = (isValid & canScatter).without(escaped);
    m_collisions += active.count();
    LaneMask alive = active;
    if (active.any()) {
      const Int one = zeroUnless(active, 1);
      store(bounces + one, &m_paths.bounces[i]);
      alive = collide(i, active, first & active, origin, zeroUnless(active, distance));
    }
    m_paths.ended[i / 64] |= isValid.without(alive).bits() << i % 64; // one bit per path
  }

  /// Adds the light emitted along scattered rays, up to their collision or at infinity.
  HWY_INLINE void addEmitted(std::size_t i, LaneMask scattered, const Float3& origin,
                             Float distance) {
    if (!scattered.any())
      return;
    const Float3 light =
        emittedAlongRay(m_shading, scattered, mapPoint(m_shading.toLocal, origin),
                        load3(m_paths.direction, i), distance, load(&m_paths.scatterPdf[i]));
    const Float3 sum = load3(m_paths.radiance, i);
    store3(sum + load3(m_paths.throughput, i) * light, m_paths.radiance, i);
  }

  /// Scatters the lanes of `active`; returns those whose path continues.
  LaneMask collide(std::size_t i, LaneMask active, LaneMask first, const Float3& origin,
                   Float distance) {
    PathRandom random{load(&m_paths.key[i]), load(&m_paths.counter[i])};
    const Float3 index = origin + distance * load3(m_paths.rays.direction, i);
    const Collisions at = lookUpMedium(i, active, first, index, random);
    if (first.any())
      recordFirstHit(i, at, distance);
    return scatter(i, at, random);
  }

  /// Returns the lanes whose path continues.
  HWY_INLINE LaneMask scatter(std::size_t i, const Collisions& at, PathRandom& random) {
    const Bsdf bsdf = loadBsdfs<isMixed>(m_shading, at.component);
    const PhaseLobe phase = makePhaseLobe(bsdf.g, at.incoming, at.albedo);
    const bool surfaces = at.surface.any();
    const auto surface = [&] {
      return makeSurfaceLobes(bsdf, at.incoming, at.gradient, at.albedo);
    };
    if (m_shading.hasSampledLights)
      sampleLights(i, at, random, [&](const Float3& toward) {
        const ScatterEval ofPhase = evaluate(phase, toward);
        if (!surfaces)
          return ofPhase;
        const ScatterEval ofSurface = evaluate(surface(), toward);
        return ScatterEval{select(at.surface, ofSurface.factor, ofPhase.factor),
                           select(at.surface, ofSurface.pdf, ofPhase.pdf)};
      });

    const Float choice = m_shading.hybrid ? random.uniform() : 0.0F; // even if no lane needs it
    const Float u = selectGiven(at.first, m_paths.uDirection[0], i, random);
    const Float v = selectGiven(at.first, m_paths.uDirection[1], i, random);
    ScatterSamples sampled = sampleLobe(phase, u, v);
    if (surfaces) {
      const ScatterSamples other = sampleLobe(surface(), choice, u, v);
      sampled = {select(at.surface, other.outgoing, sampled.outgoing),
                 select(at.surface, other.weight, sampled.weight),
                 select(at.surface, other.pdf, sampled.pdf)};
    }
    return continuePath(i, at, sampled, random);
  }

  HWY_INLINE Collisions lookUpMedium(std::size_t i, LaneMask active, LaneMask first,
                                     const Float3& index, PathRandom& random) {
    Collisions at{active,
                  first,
                  index,
                  load(&m_paths.rays.scalar[i]),
                  load3(m_paths.direction, i),
                  load3(m_paths.throughput, i)};
    if constexpr (isMixed) {
      at.component = sampleComponents(m_medium, active, index, at.scalar, random.uniform());
      at.albedo = evalComponentAlbedo(m_shading, active, at.component, at.scalar);
    } else {
      at.albedo = evalMediumAlbedo(m_shading, active, index, at.scalar);
    }
    if (m_medium.context)
      at.albedo = desaturate(*m_medium.context, index, at.albedo);
    if (m_shading.hybrid) {
      at.gradient = evalGradient(index);
      m_gradients += active.count();
      if (m_medium.cutSlope > 0.0F)
        at.gradient = at.gradient + cutGradient(m_medium, index, findClippable(at));
      const Float slope = sqrt(dot(at.gradient, at.gradient));
      const Float chance = surfaceProbability(evalOwnExtinction(at), m_shading.surfaceRate, slope);
      at.surface = active & (selectGiven(first, m_paths.uChoices[0], i, random) < chance);
    }
    return at;
  }

  /// One random number per path: given at its first scattering, generated at later ones.
  static HWY_INLINE Float selectGiven(LaneMask first, const SoaArray<float>& given, std::size_t i,
                                      PathRandom& random) {
    return select(first, load(&given[i]), random.uniform());
  }

  /// Lanes whose component the clip can remove.
  HWY_INLINE LaneMask findClippable(const Collisions& at) const {
    if constexpr (isMixed)
      return at.active.without(findUnclipped(*m_medium.mixture, at.active, at.component));
    else
      return at.active;
  }

  /// Extinction of the component at the collision, at label weight 1.
  HWY_INLINE Float evalOwnExtinction(const Collisions& at) const {
    if constexpr (isMixed)
      return evalExtinction(m_medium.extinctions, at.active, at.component, at.scalar);
    else
      return evalExtinction(m_medium.extinctions, at.scalar);
  }

  Float3 evalGradient(const Float3& p) const {
    const Float3 difference = scalarDifference<Voxel>(m_shading, m_medium.field, p);
    return mapDirection(m_shading.indexDifferenceToGradient, difference);
  }

  void recordFirstHit(std::size_t i, const Collisions& at, Float distance) {
    const auto put = [&](Float now, SoaArray<float>& column) {
      store(select(at.first, now, load(&column[i])), &column[i]);
    };
    const auto put3 = [&](const Float3& now, SoaArray3& columns) {
      store3(select(at.first, now, load3(columns, i)), columns, i);
    };
    put(fma(distance, load(&m_paths.depthPerLength[i]), load(&m_paths.depth[i])),
        m_paths.firstDepth);
    put3(at.albedo, m_paths.firstAlbedo);
    if (!m_shading.wantNormals)
      return;
    const Float3 gradient = m_shading.hybrid ? at.gradient : evalGradient(at.index);
    m_gradients += m_shading.hybrid ? 0 : at.first.count();
    put3(makeNormal(gradient, dot(at.incoming, gradient), 1.0F), m_paths.firstNormal);
  }

  /// PathSteps::sampleLight: appends a shadow ray for each lane whose light can contribute.
  template <typename Evaluate>
  void sampleLights(std::size_t i, const Collisions& at, PathRandom& random, Evaluate&& evaluate) {
    const Float choice = selectGiven(at.first, m_paths.uChoices[1], i, random);
    const UInt u = random.nextBits();
    const UInt v = random.nextBits();
    const LightSamples light =
        sampleLightSet(m_shading, at.active, mapPoint(m_shading.toLocal, at.index), choice, u, v);
    const ScatterEval scattered = evaluate(light.direction);
    const Float3 radiance =
        weighLight(light.radiance, light.pdf, light.isDelta, scattered, at.throughput);
    const LaneMask contributes = at.active & (maxComponent(radiance) > 0.0F);
    const std::size_t count = contributes.count();
    const UInt depth = random.nextBits();
    const Float acceptance = random.uniform();
    if (count == 0)
      return;
    const Float3 direction = mapDirection(m_shading.localToIndex, light.direction);
    const Float length = min(light.distance, lengthInDomain(m_medium, at.index, direction));
    const std::size_t to = m_shadowRays.rays.size;
    const Shuffle pack = Shuffle::compress(contributes);
    const auto put = [&](auto x, auto& column) { store(pack(x), &column[to]); };
    store3(pack(at.index), m_shadowRays.rays.origin, to);
    store3(pack(direction), m_shadowRays.rays.direction, to);
    put(length, m_shadowRays.rays.length);
    store3(pack(radiance), m_shadowRays.radiance, to);
    put(depth, m_shadowRays.rays.depthBits);
    put(acceptance, m_shadowRays.rays.acceptance);
    put(UInt(hn::Iota(uints, static_cast<std::uint32_t>(i))), m_shadowRays.path);
    m_shadowRays.rays.size += count;
  }

  /// Sets the paths' throughput and next rays. Returns the lanes that survive Russian roulette.
  HWY_INLINE LaneMask continuePath(std::size_t i, const Collisions& at,
                                   const ScatterSamples& sampled, PathRandom& random) {
    Float3 throughput = at.throughput * sampled.weight;
    const Float chance = keepProbability(throughput);
    const LaneMask survives = random.uniform() <= chance;
    throughput = zeroUnless(survives, (1.0F / chance) * throughput);
    store3(throughput, m_paths.throughput, i);
    store(sampled.pdf, &m_paths.scatterPdf[i]);
    store3(sampled.outgoing, m_paths.direction, i);
    store3(at.index, m_paths.rays.origin, i);
    const Float3 direction = mapDirection(m_shading.localToIndex, sampled.outgoing);
    store3(direction, m_paths.rays.direction, i);
    store(lengthInDomain(m_medium, at.index, direction), &m_paths.rays.length[i]);
    store(random.nextBits(), &m_paths.rays.depthBits[i]);
    store(random.uniform(), &m_paths.rays.acceptance[i]);
    store(random.counter, &m_paths.counter[i]);
    return at.active & (maxComponent(throughput) > 0.0F);
  }

  const SimdMedium& m_medium;
  const SimdShading& m_shading;
  PathBatch& m_paths;
  ShadowBatch& m_shadowRays;
  std::size_t m_collisions = 0, m_gradients = 0;
};

void scatterAll(const SimdMedium& medium, const SimdShading& shading, PathBatch& paths,
                ShadowBatch& shadowRays, Counters& counters) {
  std::visit(
      [&]<typename Voxel>(const Voxel*, auto isMixed) {
        VertexHandler<Voxel, isMixed>(medium, shading, paths, shadowRays).run(counters);
      },
      medium.voxels, toConstant(medium.mixture.has_value()));
}

void dropEndedLanes(PathBatch& paths) {
  std::size_t left = 0;
  for (std::size_t i = 0; i < paths.rays.size; i += laneCount) {
    const LaneMask ended = LaneMask::fromBits(paths.ended[i / 64] >> i % 64);
    const LaneMask active = LaneMask::first(paths.rays.size - i).without(ended);
    const Shuffle pack = Shuffle::compress(active);
    const auto move = [&](auto&... columns) {
      (store(pack(load(&columns[i])), &columns[left]), ...);
    };
    const auto move3 = [&](auto&... columns) { (move(columns[0], columns[1], columns[2]), ...); };
    if (left != i || ended.any()) { // the columns that paths need after their first scattering
      move3(paths.rays.origin, paths.rays.direction, paths.direction, paths.throughput,
            paths.radiance, paths.firstAlbedo, paths.firstNormal);
      move(paths.rays.length, paths.rays.depthBits, paths.rays.acceptance, paths.scatterPdf,
           paths.bounces, paths.key, paths.counter, paths.tile, paths.tileSample, paths.firstDepth);
    }
    left += active.count();
  }
  paths.rays.size = left;
}

} // namespace
} // namespace fenestra::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fenestra::core {

HWY_EXPORT(scatterAll);
HWY_EXPORT(dropEndedLanes);

void scatterPaths(const SimdMedium& medium, const SimdShading& shading, PathBatch& paths,
                  ShadowBatch& shadowRays, Counters& counters) {
  HWY_DYNAMIC_DISPATCH(scatterAll)(medium, shading, paths, shadowRays, counters);
}

void dropEnded(PathBatch& paths) {
  HWY_DYNAMIC_DISPATCH(dropEndedLanes)(paths);
}

} // namespace fenestra::core
#endif
