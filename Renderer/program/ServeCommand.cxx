// `fenestra serve`: keeps a scene loaded, reads changes, and writes an image after each. A change
// stops the current render, and rebuilds only the stages that it affects (PreparedScene::changed).

#include "base/Error.h"
#include "base/Stopwatch.h"
#include "program/CommandLine.h"
#include "program/Commands.h"
#include "program/ErrorAdvice.h"
#include "program/RenderSteps.h"
#include "program/ServeInput.h"

#include <set>
#include <span>

namespace fenestra::core {
namespace {

/// Options of render with the defaults of serve: its images are previews, so the GPU may render
/// them.
void setServeDefaults(RenderOptions& options, const OptionValues& values) {
  resolveSmoothing(options, true);
  if (!values.has("device"))
    options.device = DeviceChoice::automatic;
}

class Server {
public:
  Server(const RenderJob& start, Outputs& outputs)
      : m_source(start.input),
        m_values(start.stored),
        m_options(start.options),
        m_outputs(outputs),
        m_input(m_values, m_source, m_monitor) {
    setServeDefaults(m_options, m_values);
  }

  /// Runs until the process ends. Throws Error if the first scene cannot be built.
  [[noreturn]] void run() {
    m_scene.emplace(m_options.scene, m_source);
    m_outputs.checkInputs();
    requireScale(m_options, m_scene->camera().pose().projection);
    for (;;) {
      renderPictures();
      do {
        const ServeChanges changes = m_input.next();
        if (!applyChanges(changes))
          m_input.revert(m_values);
      } while (m_isComplete);
    }
  }

private:
  /// Builds one scene for all changes. If that fails, tries each half separately, down to single
  /// changes. A single change that fails is reported and has no effect. Returns whether all changes
  /// were applied at once.
  bool applyChanges(std::span<const ServeChange> changes) {
    try {
      OptionValues values = m_values;
      for (const ServeChange& change : changes)
        values = applyChange(change.options, values);
      RenderOptions options = makeRenderOptions(mergePreset(values, m_source));
      setServeDefaults(options, values);
      checkMemory(options.scene);
      PreparedScene scene = m_scene->withRequest(options.scene);
      m_outputs.checkInputs();
      requireScale(options, scene.camera().pose().projection);
      m_scene = std::move(scene);
      m_options = options;
      m_values = values;
      m_change = changes.back();
      m_isComplete = false;
      return true;
    } catch (const Error& error) {
      m_outputs.unregisterInputs();
      if (changes.size() == 1)
        writeErrorEvent(changes.front().id, error.message());
    }
    if (changes.size() > 1) {
      applyChanges(changes.first(changes.size() / 2));
      applyChanges(changes.subspan(changes.size() / 2));
    }
    return false;
  }

  /// Publishes the first image at once, later ones at most every 0.1 seconds, and so rarely that
  /// most of the time is spent on samples.
  void renderPictures() {
    m_isComplete = false;
    m_monitor.noise = infinity;
    m_monitor.paths = 0;
    m_published.reset();
    m_failure.clear();
    ImageDenoiser filter(*m_scene);
    filter.attach(m_monitor);
    m_monitor.onPause = [this, &filter](const RenderResult& result) {
      const double interval = std::max(0.1, 4.0 * m_publishSeconds);
      if (!m_monitor.stop && (!m_published || m_published->seconds() >= interval))
        publish(result, filter, false);
    };
    RenderSettings settings = makeSettings(m_options, m_scene->background());
    settings.passGrowth = 1; // short passes, since images are shown between them
    if (m_hasGpuFailed)
      settings.integrator = Integrator::simd;
    const RenderResult result = render(m_scene->view(), settings, m_monitor);
    m_hasGpuFailed = m_hasGpuFailed || !result.gpuFailure.empty();
    m_isComplete = result.reason != StopReason::request;
    if (m_isComplete)
      publish(result, filter, true);
  }

  /// Writes the images and reports them. A failure, such as a full disk, is reported as well, for
  /// intermediate images only when its message changes; the next image may succeed again.
  void publish(const RenderResult& result, const ImageDenoiser& filter, bool last) {
    const Stopwatch watch;
    try {
      const std::optional<FilteredImage> filtered = filter.apply(result);
      writeImages(m_options, *m_scene, result, filtered, m_values.arguments(), m_outputs);
      m_outputs.commit(Durability::none); // the next image follows soon
      writeImageEvent(result, denoisedNoise(filtered), last);
    } catch (const Error& error) {
      if (last || m_failure != error.what())
        writeErrorEvent(m_change.id, error.message());
      m_failure = error.what();
    }
    m_publishSeconds = watch.seconds();
    m_published.emplace();
  }

  void writeImageEvent(const RenderResult& result, const std::optional<double>& filtered,
                       bool last) {
    nlohmann::ordered_json event = {{"event", "picture"}, {"id", m_change.id}};
    event["samples"] = result.finishedSamples;
    event["noise"] = result.film.noise(); // null: infinite
    if (filtered)
      for (const char* key : {"noiseDenoised", "noiseFiltered"}) // and its name in version 0.1
        event[key] = *filtered;
    event["seconds"] = m_change.age.seconds();
    event["target"] = result.target;
    event["done"] = last;
    for (const std::filesystem::path& path : m_options.outputs)
      event["files"].push_back(path.string());
    std::vector<std::string> warnings = {};
    for (const Message& message : m_scene->warnings())
      warnings.push_back(composeMessage(message));
    if (!result.gpuFailure.empty())
      warnings.push_back(describeGpuFailure(result.gpuFailure));
    for (const std::string& warning : warnings)
      if (m_warned.insert(warning).second)
        event["warnings"].push_back(warning);
    writeEvent(event);
  }

  const Input m_source;  ///< shared by all scenes
  OptionValues m_values; ///< of the current scene, before merging a preset
  RenderOptions m_options;
  ServeChange m_change; ///< last one applied
  Outputs& m_outputs;
  RenderMonitor m_monitor;
  ServeInput m_input;
  std::optional<PreparedScene> m_scene;
  bool m_isComplete = false;            ///< true: the scene's image is finished
  bool m_hasGpuFailed = false;          ///< true: the CPU renders all further images
  std::optional<Stopwatch> m_published; ///< since the scene's last image; nullopt: none yet
  double m_publishSeconds = 0.0;        ///< duration of the last publish(), s
  std::string m_failure;                ///< last reported failure to write an image of this scene
  std::set<std::string> m_warned;
};

} // namespace

// Built on first use, since renderSyntax is initialized in another source file.
const CommandSyntax& serveSyntax() {
  static const CommandSyntax syntax = {
      "serve",
      "Keeps a scene loaded and renders it again after every change, for previews. Reads changes "
      "from standard input, one JSON object of options per line, as {\"id\": 7, \"view\": "
      "\"left\", \"focus\": [\"Femur\", \"Tibia\"]}; null removes an option. Every refreshed image "
      "replaces the output files atomically. Images and errors are reported on standard output: "
      "{\"event\": \"picture\" or \"error\", \"id\": 7, ...}. Ends with its input. Accepts the "
      "options of fenestra render; unless given, --device is auto.",
      renderSyntax.positionals,
      renderSyntax.options,
      {{{"stats-json", "returnparameterfile", "progress", "quiet", "verbose", "xml", "echo"},
        "not for serve, which reports on standard output; omit it"},
       {{"surface", "checkpoint", "shard"},
        "not for serve, which only writes images; use fenestra render"}},
      "Keep a scene loaded, and render previews of changes",
      "serve scene.mrb --size 256x256 -o preview.png",
  };
  return syntax;
}

int serveCommand(int argc, char** argv, int first) {
  const std::optional<OptionValues> given = parseCommandLine(serveSyntax(), argc, argv, first);
  if (!given)
    return 0;
  configureMachine(*given);
  const RenderJob start = makeRenderJob(*given);
  // Never destroyed: the reading thread uses both until the process ends.
  Outputs& outputs = *new Outputs;
  declareOutputs(start.options, outputs);
  checkMemory(start.options.scene);
  Server& server = *new Server(start, outputs);
  server.run();
}

} // namespace fenestra::core
