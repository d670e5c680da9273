#include "fenestra/Render.h"

#include "library/Convert.h"
#include "library/Data.h"
#include "library/MakeImage.h"
#include "scene/FinishedImage.h"
#include "scene/QualityLevels.h"

#include <tbb/task_arena.h>

#include <future>

namespace fenestra {
inline namespace v1 {
namespace {

core::Background makeBackground(const Background& background) {
  using Kind = Background::Kind;
  const Color& c = background.color;
  switch (background.kind) {
  case Kind::dark:
    break;
  case Kind::gray:
    return core::Background::makeGray();
  case Kind::color:
    return {core::Background::Kind::color, core::Rgb(c[0], c[1], c[2])};
  case Kind::gradient:
    return core::Background::makeDarkGradient();
  case Kind::transparent:
    return {core::Background::Kind::transparent};
  case Kind::environment:
    return {core::Background::Kind::environment};
  }
  return core::Background::makeDark();
}

void requireLimit(const char* what, const std::optional<double>& value) {
  if (value && !(*value > 0.0))
    throw core::requestError(core::ErrorCode::invalidValue, what, "must be greater than 0");
}

core::RenderSettings makeSettings(const RenderOptions& options, const core::PreparedScene& scene) {
  constexpr std::uint64_t unlimited = std::uint64_t{1} << 40, usual = 64;
  core::RenderSettings settings;
  settings.samples = options.samples.value_or(options.seconds || options.noise ? unlimited : usual);
  settings.seconds = options.seconds.value_or(settings.seconds);
  settings.noise = options.noise.value_or(settings.noise);
  settings.isDisplayNoise = options.isDenoised;
  settings.seed = options.seed;
  settings.threads = options.threads;
  if (options.device == Device::gpu)
    settings.integrator = core::Integrator::gpu;
  settings.path.wantNormals = true;
  settings.path.bounces = options.bounces.value_or(settings.path.bounces);
  settings.path.background = options.background
                                 ? makeBackground(*options.background)
                                 : scene.background().value_or(core::Background::makeDark());
  return settings;
}

void check(const RenderOptions& options) {
  requireLimit("seconds", options.seconds);
  requireLimit("noise", options.noise);
  if (options.samples == std::uint64_t{0})
    throw core::requestError(core::ErrorCode::invalidValue, "samples", "must be at least 1");
  if (options.threads < 0)
    throw core::requestError(core::ErrorCode::invalidValue, "threads", "must not be negative");
}

/// One render, which runs in a thread of its own.
class Run {
public:
  Run(std::shared_ptr<Scene::Data> scene, const RenderOptions& options)
      : m_scene(std::move(scene)), m_options(options) {}

  Image run() {
    tbb::task_arena arena(m_options.threads > 0 ? m_options.threads : tbb::task_arena::automatic);
    return arena.execute([this] { return renderImage(); });
  }

  void stop() { m_monitor.stop = true; }

  Progress progress() const {
    const double seconds = m_watch.seconds();
    if (!m_isRendering)
      return {0.0, seconds, core::infinity};
    const double pixels = double{1.0} * m_options.width * m_options.height;
    return {core::estimateFraction(m_monitor, m_settings, pixels, seconds - m_preparingSeconds),
            seconds, m_monitor.noise};
  }

private:
  Image renderImage() {
    const core::PreparedScene scene =
        m_scene->prepare(m_options.width, m_options.height, m_options.isDenoised, m_monitor.stop);
    core::ImageDenoiser denoiser(scene);
    denoiser.attach(m_monitor);
    m_settings = makeSettings(m_options, scene);
    m_preparingSeconds = m_watch.seconds();
    m_isRendering = true; // publishes the two members above
    m_monitor.isNoiseWanted = true;
    const core::RenderResult result = core::render(scene.view(), m_settings, m_monitor);
    if (result.finishedSamples == 0)
      throw core::requestError(core::ErrorCode::stopped, "render",
                               "was stopped before the first pass");
    return makeImage(scene, m_scene->preset ? &m_scene->preset->preset.name : nullptr, m_settings,
                     result, denoiser.apply(result));
  }

  const std::shared_ptr<Scene::Data> m_scene;
  const RenderOptions m_options;
  const core::Stopwatch m_watch;
  core::RenderMonitor m_monitor;
  core::RenderSettings m_settings;
  double m_preparingSeconds = 0.0;
  std::atomic<bool> m_isRendering = false;
};

} // namespace

RenderOptions makeRenderOptions(Quality quality) {
  const core::QualityLevel& level = core::qualityLevels[static_cast<std::size_t>(quality)];
  RenderOptions options;
  options.samples = level.samples;
  if (level.noise > 0.0)
    options.noise = level.noise;
  return options;
}

Image render(const Scene& scene, const RenderOptions& options, const ProgressCallback& onProgress) {
  return guard([&] {
    check(options);
    Run run(scene.data(), options);
    std::future<Image> result = std::async(std::launch::async, [&run] { return run.run(); });
    constexpr std::chrono::milliseconds interval(50);
    try {
      while (result.wait_for(onProgress ? interval : std::chrono::hours(1)) !=
             std::future_status::ready)
        if (onProgress && !onProgress(run.progress()))
          run.stop();
    } catch (...) { // of the callback
      run.stop();
      result.wait();
      throw;
    }
    return result.get();
  });
}

} // namespace v1
} // namespace fenestra
