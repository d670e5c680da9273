#include "Modes.h"

#include "Baselines.h"
#include "program/UsageError.h"

namespace fenestra::core::benchmarks {
namespace {

Film renderByFenestra(const SceneView& scene, const RenderSettings& settings) {
  RenderMonitor monitor;
  return render(scene, settings, monitor).film;
}

Film renderGlobal(const SceneView& scene, const RenderSettings& settings) {
  return traceImage(scene, settings, [&]<typename Voxel>(const Medium<Voxel>& medium) {
    return GlobalTracker<Voxel>(scene, medium);
  });
}

/// Ray marching with steps of `step` voxels.
Film renderMarching(const SceneView& scene, const RenderSettings& settings, double step) {
  return traceImage(scene, settings, [&]<typename Voxel>(const Medium<Voxel>& medium) {
    return MarchingTracker<Voxel>(scene, medium, step);
  });
}

constexpr Mode table[] = {
    // the default of `fenestra`
    {"product", [](const SceneView& scene,
                   RenderSettings settings) { return renderByFenestra(scene, settings); }},
    // like product, with a noise target: after a pilot of 16 samples, noisier pixels get more
    {"adaptive",
     [](const SceneView& scene, RenderSettings settings) {
       settings.noise = 1e-6; // too low to be met: the sample count ends the render
       settings.isDisplayNoise = false;
       return renderByFenestra(scene, settings);
     }},
    // the scalar integrator: null collisions in a majorant grid, independent samples
    {"scalar",
     [](const SceneView& scene, RenderSettings settings) {
       settings.integrator = Integrator::scalar;
       return renderByFenestra(scene, settings);
     }},
    // like scalar, with one majorant for the volume
    {"global",
     [](const SceneView& scene, RenderSettings settings) { return renderGlobal(scene, settings); }},
    // like scalar, with fixed steps of one voxel: biased
    {"marching", [](const SceneView& scene,
                    RenderSettings settings) { return renderMarching(scene, settings, 1.0); }},
    // half a voxel
    {"marching-half", [](const SceneView& scene,
                         RenderSettings settings) { return renderMarching(scene, settings, 0.5); }},
};

} // namespace

std::span<const Mode> modes() {
  return table;
}

const Mode& findMode(const std::string& name) {
  std::string known;
  for (const Mode& mode : table) {
    if (name == mode.name)
      return mode;
    known += (known.empty() ? "" : ", ") + std::string(mode.name);
  }
  throw usageError("--modes: '" + name + "' is unknown; expected some of " + known);
}

} // namespace fenestra::core::benchmarks
