// Single parts of a path and of the clipping pass, on one thread (see README.md in this folder).

#include "Scenes.h"

#include "clip/surface/ThinPlateSpline.h"
#include "integrator/scalar/Tracker.h"
#include "scene/PreparedScene.h"

#include <benchmark/benchmark.h>

#include <tbb/global_control.h>

#include <iostream>

namespace fenestra::core::benchmarks {
namespace {

constexpr int imageSize = 512;

/// The clipped knee, and access to all parts of its scene.
struct Subject {
  std::string label;
  RenderRequest request;
  PreparedScene scene;
  std::vector<ControlPoint> controlPoints;

  static RenderRequest makeRequest(const SceneCase& sceneCase) {
    RenderRequest request = sceneCase.options().scene;
    request.width = request.height = imageSize;
    return request;
  }

  explicit Subject(const SceneCase& sceneCase)
      : label(sceneCase.name),
        request(makeRequest(sceneCase)),
        scene(request),
        controlPoints(buildSurface().controlPoints) {
    const Size3& size = scene.volume().grid.size;
    label += ", " + std::to_string(size.x()) + "x" + std::to_string(size.y()) + "x" +
             std::to_string(size.z());
  }

  Domain domain() const { return {scene.volume().grid, scene.view().crop}; }
  ClippingSurface buildSurface(Boundary boundary = Boundary::spline) const {
    return buildClippingSurface(scene.camera(), domain(), *scene.focus(), {.boundary = boundary});
  }
};

using Voxel = std::int16_t; ///< storage type of the phantoms

/// Data for tracking, and queries: enough of them to exceed the caches.
struct Probe {
  static constexpr std::size_t count = 1 << 14;
  const Subject& subject;
  const LargeArray<Voxel>& voxels = std::get<LargeArray<Voxel>>(subject.scene.volume().voxels);
  Field<Voxel> field{subject.scene.volume().grid, voxels};
  Medium<Voxel> medium{subject.scene.volume().grid, voxels, subject.scene.transfer()};
  SceneView view = subject.scene.view();
  Tracker<Voxel> tracker{subject.domain(), medium, view.majorants, view.clip};
  std::vector<Ray> cameraRays;
  std::vector<Vec3> collisions; ///< world; first collisions of camera rays
  std::vector<Vec3> inside;     ///< the collisions in index space
  std::vector<Ray> scattered;   ///< from the collisions, in random directions
  std::vector<Vec3> anywhere;   ///< random positions in index space
  Random random{1, 2, 3};
  Counters counters;

  explicit Probe(const Subject& subjectIn) : subject(subjectIn) {
    const Vec3 size = subject.scene.volume().grid.size.cast<double>();
    while (collisions.size() < count) {
      const Vec2 pixel = imageSize * random.uniform2();
      const Ray ray = view.camera.makeRay(pixel.x(), pixel.y());
      cameraRays.push_back(ray);
      const double t = tracker.sampleCollision(ray, visibleInterval(view.clip, ray),
                                               random.uniform2(), random, counters);
      if (t < infinity) {
        collisions.push_back(ray.at(t));
        inside.push_back(subject.scene.volume().grid.worldToIndex * ray.at(t));
        scattered.push_back({ray.at(t), sampleUniformSphere(random.uniform2())});
      }
      const Vec2 u = random.uniform2();
      anywhere.push_back(size.cwiseProduct(Vec3(u.x(), u.y(), random.uniform())));
    }
  }
};

/// Times visit(i) for i = 0 … count - 1, repeatedly.
template <typename Visit>
void cycle(benchmark::State& state, const std::string& label, std::size_t count, Visit&& visit) {
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(visit(i));
    i = i + 1 < count ? i + 1 : 0;
  }
  state.SetLabel(label);
}

void addTracking(Probe& p) {
  const auto add = [&](const char* name, std::size_t count, auto visit) {
    benchmark::RegisterBenchmark(name, [&p, count, visit](benchmark::State& state) {
      cycle(state, p.subject.label, count, visit);
    });
  };
  add("collision/camera ray", p.cameraRays.size(), [&p](std::size_t i) {
    const Ray& ray = p.cameraRays[i];
    return p.tracker.sampleCollision(ray, visibleInterval(p.view.clip, ray), p.random.uniform2(),
                                     p.random, p.counters);
  });
  add("collision/scattered ray", Probe::count, [&p](std::size_t i) {
    return p.tracker.sampleCollision(p.scattered[i], {}, p.random.uniform2(), p.random, p.counters);
  });
  add("transmittance/scattered ray", Probe::count, [&p](std::size_t i) {
    return p.tracker.transmittance(p.scattered[i], {}, p.random, p.counters);
  });
  add("interpolation/random positions", Probe::count,
      [&p](std::size_t i) { return p.field.value(p.anywhere[i]); });
  add("interpolation/one position", 1,
      [&p](std::size_t i) { return p.field.value(p.anywhere[i]); });
  add("classification/one position", 1,
      [&p](std::size_t i) { return p.medium.extinction(p.anywhere[i]); });
  add("classification/collisions", Probe::count,
      [&p](std::size_t i) { return p.medium.extinction(p.inside[i]); });
  add("gradient/collisions", Probe::count,
      [&p](std::size_t i) { return p.field.gradient(p.inside[i]); });
  add("sobel gradient/collisions", Probe::count,
      [&p](std::size_t i) { return p.field.sobelGradient(p.inside[i]); });
  add("clip test/collisions", Probe::count,
      [&p](std::size_t i) { return clipWeight(p.view.clip, p.collisions[i]); });
}

void addFirstPass(const Subject& subject) {
  const std::string label =
      subject.label + ", " + std::to_string(subject.controlPoints.size()) + " control points";
  benchmark::RegisterBenchmark("first pass/spline fit", [&, label](benchmark::State& state) {
    std::vector<Vec2> sites;
    std::vector<double> depths;
    for (const ControlPoint& point : subject.controlPoints) {
      sites.push_back(point.site);
      depths.push_back(point.depth);
    }
    for (auto _ : state)
      benchmark::DoNotOptimize(ThinPlateSpline(sites, depths, 0.5));
    state.SetLabel(label);
  })->Unit(benchmark::kMicrosecond);
  const auto addStage = [&](const char* name, auto seconds, Boundary boundary = Boundary::spline) {
    benchmark::RegisterBenchmark(name,
                                 [&, label, seconds, boundary](benchmark::State& state) {
                                   for (auto _ : state)
                                     state.SetIterationTime(
                                         seconds(subject.buildSurface(boundary)));
                                   state.SetLabel(label + ", " + std::to_string(imageSize) + "x" +
                                                  std::to_string(imageSize) + " pixels");
                                 })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  };
  addStage("first pass/focus depth", [](const ClippingSurface& s) { return s.focusSeconds; });
  addStage("first pass/contours and spline",
           [](const ClippingSurface& s) { return s.splineSeconds; });
  addStage("first pass/fill", [](const ClippingSurface& s) { return s.fillSeconds; });
  addStage("first pass/all", [](const ClippingSurface& s) {
    return s.focusSeconds + s.splineSeconds + s.fillSeconds;
  });
  addStage(
      "first pass/exact fill", [](const ClippingSurface& s) { return s.fillSeconds; },
      Boundary::exact);
}

/// Finds the clipped knee in the table, with the first phantom that exists.
SceneCase chooseScene() {
  for (const char* phantoms : {FENESTRA_BENCHMARK_FOLDER, FENESTRA_SAMPLES})
    for (const SceneCase& scene : readScenes(FENESTRA_BENCHMARK_TABLE, {"", "", phantoms}))
      if (scene.name == "knee-clipped" && scene.missing.empty())
        return scene;
  throw std::runtime_error("the table of scenes has no knee-clipped, or its phantom is missing");
}

} // namespace
} // namespace fenestra::core::benchmarks

int main(int argc, char** argv) {
  using namespace fenestra::core::benchmarks;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv))
    return 2;
  try {
    const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
    const Subject subject(chooseScene());
    Probe probe(subject);
    addTracking(probe);
    addFirstPass(subject);
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& error) {
    std::cerr << "MicroBenchmarks: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
