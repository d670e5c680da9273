#include "Gpu/Twin.h"

#include "base/Formulas.h"
#include "integrator/render/Tracing.h"

#include <tbb/combinable.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <cmath>
#include <stdexcept>

namespace fenestra::core::twin {
namespace {

using namespace gpu;
#include "Gpu/Shader-inl.h"

class Renderer {
public:
  Renderer(const SceneView& scene, const RenderSettings& settings)
      : m_scene(scene, settings, neverStopped),
        m_sampler(settings.sampling, settings.seed),
        m_empty(findEmptyPixels(scene, settings)),
        m_tables(m_scene.tracker.medium(), m_scene.shading, m_scene.table, m_scene.cameraRays,
                 m_sampler.isStratified()) {
    if (!canUseSimd(scene))
      throw std::invalid_argument("the scene needs double precision");
  }

  Result render(int width, int height, std::uint64_t samples) const {
    Result result{
        Film(width, height, Sampler::hasIndependentHalfBuffers, m_sampler.samplesPerBlock())};
    result.features = m_tables.features;
    tbb::combinable<Counters> counters;
    tbb::parallel_for(0, height,
                      [&](int row) { counters.local() += renderRow(result.film, row, samples); });
    counters.combine_each([&](const Counters& part) { result.counters += part; });
    return result;
  }

private:
  Counters renderRow(Film& film, int row, std::uint64_t samples) const {
    device::Shader shader(m_tables, m_scene.tracker.medium());
    Counters counters;
    for (int column = 0; column < film.width(); ++column) {
      PixelSums& pixel = film.at(column, row);
      pixel.isDeterministic = m_empty.contains(column, row);
      const std::uint64_t end = pixel.isDeterministic ? 1 : samples;
      for (std::uint64_t sample = 0; sample < end; ++sample) {
        const Sampler::Stream stream = m_sampler.stream(film.index(column, row), sample);
        const auto number = static_cast<UInt>(sample % Sampler::Stream::maxSamples);
        pixel.add(toSample(shader.trace({column, row, stream.start, stream.key, number}), row));
      }
      counters.paths += end;
    }
    const auto& counts = shader.counts();
    counters.collisions = counts[collisionCount];
    counters.lookups = counts[lookupCount];
    counters.cells = counts[cellCount];
    counters.skippedCells = counts[skippedCellCount];
    counters.shadowRays = counts[shadowRayCount];
    counters.gradients = counts[gradientCount];
    return counters;
  }

  PathSample toSample(const PathResult& result, int row) const {
    const auto triple = [](const float(&v)[3]) {
      return Rgb(double{v[0]}, double{v[1]}, double{v[2]});
    };
    if (result.scatterings == 0.0F)
      return result.depth == infiniteReal
                 ? m_scene.cameraRays.sampleBackground(row, triple(result.normal).matrix())
                 : PathSample{};
    PathSample sample;
    sample.radiance = triple(result.radiance);
    sample.depth = m_scene.table.nearDepth + double{result.depth};
    sample.albedo = triple(result.albedo);
    sample.normal = triple(result.normal).matrix();
    sample.scatterings = double{result.scatterings};
    return sample;
  }

  SimdScene m_scene;
  Sampler m_sampler;
  EmptyPixels m_empty;
  SceneTables m_tables;
};

} // namespace

Result render(const SceneView& scene, const RenderSettings& settings) {
  return Renderer(scene, settings)
      .render(scene.camera.width(), scene.camera.height(), settings.samples);
}

} // namespace fenestra::core::twin
