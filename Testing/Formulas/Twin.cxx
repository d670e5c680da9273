#include "Formulas/Twin.h"

#include "base/Narrow.h"
#include "base/ScalarMath.h"

#include <tbb/parallel_for.h>

#include <bit>

namespace fenestra::core::twin {
namespace {

using Real = float;
#include "base/OneLane-inl.h"

template <int by>
Int shiftLeft(Int x) {
  return static_cast<Int>(static_cast<UInt>(x) << by);
}
template <int by>
Int shiftRight(Int x) {
  return x >> by;
}
Float toFloat(Int x) {
  return static_cast<Float>(x);
}
Float bitsAsFloat(auto x) {
  return std::bit_cast<Float>(x);
}
Int bitsAsInt(auto x) {
  return std::bit_cast<Int>(x);
}
UInt bitsAsUInt(auto x) {
  return std::bit_cast<UInt>(x);
}

#include "formulas/Interpolation.inl"
#include "formulas/Uniforms.inl"
// Uses angles:
#include "formulas/Scattering.inl"
// Use scattering:
#include "formulas/Paths.inl"
#include "formulas/Tracking.inl"
#include "model/lights/LightLoops-inl.h"

/// The scene in float; "local" space has world axes and its origin at the volume's center.
struct Tables {
  explicit Tables(const SceneView& scene)
      : size(scene.volume.grid.size),
        edge(scene.majorants.edge()),
        cells(scene.majorants.cellCount()),
        toLocal(rows(scene.volume.grid.indexToWorld, scene.volume.grid.worldCenter())),
        toIndex(rows(scene.volume.grid.worldToIndex, Vec3::Zero())),
        lights(scene.lights.tables().cast<float>(scene.volume.grid.worldCenter())),
        g(narrow(scene.transfer.g)) {}

  static AffineRows rows(Affine map, const Vec3& origin) {
    map.translation() -= origin;
    return affineRows(map);
  }

  Size3 size, edge, cells;
  AffineRows toLocal, toIndex;
  LightTables<float> lights;
  Float g;
};

/// A ray in index space, t in mm.
struct IndexRay {
  Float3 origin, direction;
  Float length;
};

struct PathRandom {
  UInt key, counter;

  UInt bits() {
    counter = nextCounter(counter);
    return mixBits(counter ^ key);
  }
  Float uniform() { return toUniform(bits()); }
};

template <typename Voxel>
class Integrator {
public:
  Integrator(const SceneView& scene, const Voxel* voxels)
      : m_scene(scene), m_voxels(voxels), m_tables(scene) {}

  PathSample trace(double column, double row, PathRandom random) const {
    const Ray camera = m_scene.camera.makeRay(column, row);
    const Grid& grid = m_scene.volume.grid;
    const Interval inside = Domain(grid, {}).clip(transformRay(grid.worldToIndex, camera));
    Float3 direction = narrow3(camera.direction);
    PathSample sample;
    if (inside.isEmpty()) {
      sample.radiance = toColor(evaluateSkies(m_tables.lights, direction));
      return sample;
    }
    Float3 throughput(1.0F, 1.0F, 1.0F), radiance(0.0F, 0.0F, 0.0F);
    Float pdf = 0.0F; // of the direction; 0: camera ray
    IndexRay ray = makeRay(narrow3(grid.worldToIndex * camera.at(inside.begin)), direction);
    while (throughput.x + throughput.y + throughput.z > 0.0F) {
      Float scalar = 0.0F;
      const Float distance = findCollision(ray, random, scalar);
      if (pdf > 0.0F || distance == infiniteReal)
        radiance = radiance + throughput * findEmission(ray, direction, distance, pdf);
      if (distance == infiniteReal)
        break;
      const Float3 point = ray.origin + distance * ray.direction;
      const Rgb color = m_scene.transfer.albedo(double{scalar});
      const PhaseLobe lobe = makePhaseLobe(m_tables.g, direction, Float3(narrow3(color)));
      radiance = radiance + sampleLight(point, lobe, throughput, random);
      const Float u = random.uniform();
      const ScatterSamples next = sampleLobe(lobe, u, random.uniform());
      throughput = throughput * next.weight;
      const Float keep = keepProbability(throughput);
      throughput = zeroUnless(random.uniform() <= keep, (1.0F / keep) * throughput);
      pdf = next.pdf;
      direction = next.outgoing;
      ray = makeRay(point, direction);
    }
    sample.radiance = toColor(radiance);
    return sample;
  }

private:
  static Rgb toColor(const Float3& v) { return {double{v.x}, double{v.y}, double{v.z}}; }

  Float3 findEmission(const IndexRay& ray, const Float3& direction, Float distance,
                      Float pdf) const {
    Float3 sum(0.0F, 0.0F, 0.0F);
    if (pdf > 0.0F)
      intersectLights(m_tables.lights, true, mapPoint(m_tables.toLocal, ray.origin), direction,
                      distance, [&](LaneMask, const Float3& light, Float lightPdf) {
                        sum = sum + weighScattering(pdf, lightPdf) * light;
                      });
    return distance == infiniteReal ? sum + evaluateSkies(m_tables.lights, direction) : sum;
  }

  Float3 sampleLight(const Float3& point, const PhaseLobe& lobe, const Float3& throughput,
                     PathRandom& random) const {
    LaneMask left = true;
    Float choice = toUniformBelow1(random.bits());
    const Float u = random.uniform();
    const LightSamples light = sampleLights(
        m_tables.lights, left, mapPoint(m_tables.toLocal, point), choice, u, random.uniform());
    const Float3 radiance = weighLight(light.radiance, light.pdf, light.isDelta,
                                       evaluate(lobe, light.direction), throughput);
    if (left || !(maxComponent(radiance) > 0.0F))
      return {0.0F, 0.0F, 0.0F};
    IndexRay ray = makeRay(point, light.direction);
    ray.length = min(light.distance, ray.length);
    return estimateTransmittance(ray, random) * radiance;
  }

  /// Ray from a point (index space) to the end of the volume.
  IndexRay makeRay(const Float3& origin, const Float3& direction) const {
    IndexRay ray{origin, mapDirection(m_tables.toIndex, direction), 0.0F};
    LaneIntervals inside{0.0F, infiniteReal};
    const Float o[] = {ray.origin.x, ray.origin.y, ray.origin.z};
    const Float d[] = {ray.direction.x, ray.direction.y, ray.direction.z};
    for (int axis = 0; axis < 3; ++axis)
      inside = clipToSlab(inside, -0.5F, static_cast<Float>(m_tables.size[axis]) - 0.5F, o[axis],
                          d[axis]);
    ray.length = clampZero(inside.end);
    return ray;
  }

  Float interpolateScalar(const Float3& p) const {
    const Float at[] = {p.x, p.y, p.z};
    AxisPosition axes[3];
    std::int64_t step[3], first = 0, stride = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t last = m_tables.size[axis] - 1;
      axes[axis] = locateOnAxis(static_cast<Float>(last),
                                static_cast<Float>(std::max<std::int64_t>(last - 1, 0)), at[axis]);
      step[axis] = last > 0 ? stride : 0;
      first += static_cast<std::int64_t>(axes[axis].lower) * stride;
      stride *= last + 1;
    }
    const auto slice = [&](std::int64_t from) {
      const auto v = [&](std::int64_t offset) {
        return static_cast<Float>(m_voxels[from + offset]);
      };
      return interpolate(v(0), v(step[0]), v(step[1]), v(step[0] + step[1]), axes[0].fraction,
                         axes[1].fraction);
    };
    return lerp(slice(first), slice(first + step[2]), axes[2].fraction);
  }

  /// Calls visit(t, scalar, extinction, majorant) at each tentative collision until it returns
  /// false.
  template <typename Visit>
  void walk(const IndexRay& ray, PathRandom& random, Visit&& visit) const {
    const Float o[] = {ray.origin.x, ray.origin.y, ray.origin.z};
    const Float d[] = {ray.direction.x, ray.direction.y, ray.direction.z};
    DdaAxis axes[3];
    for (int axis = 0; axis < 3; ++axis)
      axes[axis] = makeDdaAxis(1.0F / static_cast<Float>(m_tables.edge[axis]),
                               std::nextafter(static_cast<Float>(m_tables.cells[axis]), 0.0F),
                               o[axis], d[axis]);
    const Float speed = sqrt(dot(ray.direction, ray.direction));
    const Float overshoot = static_cast<Float>(0.5 * MajorantGrid::margin) / speed;
    Float depth = toExponential(random.bits());
    for (Float t = 0.0F; t < ray.length;) {
      Float exit = infiniteReal;
      Size3 cell;
      for (int axis = 0; axis < 3; ++axis) {
        const Float last = static_cast<Float>(m_tables.cells[axis] - 1);
        const Float place = max(min(floor(positionAt(axes[axis], t)), last), 0.0F);
        cell[axis] = static_cast<std::int64_t>(place);
        exit = min(exit, exitDistance(axes[axis], place, 0.5F));
      }
      const auto index = static_cast<std::int64_t>(linearIndex(cell, m_tables.cells));
      const Float majorant = m_scene.majorants.cell(index).majorant;
      const Float stop = min(max(exit, t) + overshoot, ray.length);
      const Float depthToStop = (stop - t) * majorant;
      if (!(depth < depthToStop)) {
        depth -= depthToStop;
        t = stop;
        continue;
      }
      t += depth / majorant;
      const Float scalar = interpolateScalar(ray.origin + t * ray.direction);
      const auto extinction = narrow(m_scene.transfer.extinction(double{scalar}).value());
      if (!visit(t, scalar, extinction, majorant))
        return;
      depth = toExponential(random.bits());
    }
  }

  Float findCollision(const IndexRay& ray, PathRandom& random, Float& scalar) const {
    Float distance = infiniteReal;
    walk(ray, random, [&](Float t, Float at, Float extinction, Float majorant) {
      if (!(random.uniform() * majorant < extinction))
        return true;
      distance = t;
      scalar = at;
      return false;
    });
    return distance;
  }

  Float estimateTransmittance(const IndexRay& ray, PathRandom& random) const {
    Float ratio = 1.0F;
    walk(ray, random, [&](Float, Float, Float extinction, Float majorant) {
      ratio = attenuate(ratio, extinction, majorant);
      if (ratio < leastRatio)
        ratio = playRatioRoulette(ratio, random.uniform());
      return ratio > 0.0F;
    });
    return ratio;
  }

  const SceneView& m_scene;
  const Voxel* m_voxels;
  Tables m_tables;
};

} // namespace

Film render(const SceneView& scene, std::uint64_t samples, std::uint64_t seed) {
  Film film(scene.camera.width(), scene.camera.height());
  std::visit(
      [&]<typename Voxel>(const LargeArray<Voxel>& voxels) {
        const Integrator<Voxel> integrator(scene, voxels.data());
        tbb::parallel_for(0, film.height(), [&](int row) {
          for (int column = 0; column < film.width(); ++column)
            for (std::uint64_t sample = 0; sample < samples; ++sample) {
              Random start(seed, film.index(column, row), sample);
              const double x = column + start.uniform(), y = row + start.uniform();
              const std::uint64_t bits = start.bits();
              film.at(column, row)
                  .add(integrator.trace(x, y,
                                        {static_cast<UInt>(bits), static_cast<UInt>(bits >> 32)}));
            }
        });
      },
      scene.volume.voxels);
  return film;
}

} // namespace fenestra::core::twin
