// `fenestra serve`: keeps a scene loaded, reads changes, and writes an image after each. A change
// stops the current render, and rebuilds only the stages that it affects (PreparedScene::changed).

#include "base/Error.h"
#include "base/Stopwatch.h"
#include "program/CommandLine.h"
#include "program/Commands.h"
#include "program/ErrorAdvice.h"
#include "program/RenderSteps.h"
#include "program/ServeFrame.h"
#include "program/ServeInput.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <span>

namespace fenestra::core {
namespace {

const Option serveTable[] = {
    {"mapped-image", "FILE", "Preview",
     "File that other programs map into their memory (files/images/FrameFile.h describes it): "
     "images at a quarter, half and full resolution, with depth; then only a given --output is "
     "written, too, at full resolution",
     ValueSpec::text(), OverrideGroup::process},
};

/// Options of render with the defaults of serve: its images are previews, so the GPU may render
/// them.
void setServeDefaults(RenderOptions& options, const OptionValues& values, bool hasFrame) {
  resolveSmoothing(options, true);
  if (hasFrame && options.denoise != Denoise::off)
    options.scene.features = true;
  if (!values.has("device"))
    options.device = DeviceChoice::automatic;
}

/// Renders the scene of the last change, as a ladder of sizes if there is a frame file.
class Server {
public:
  /// `frame`: null: none.
  Server(const RenderJob& start, std::unique_ptr<FrameFile> frame, Outputs& outputs)
      : m_source(start.input),
        m_values(start.stored),
        m_options(start.options),
        m_outputs(outputs),
        m_hasFiles(!frame || start.values.has("output")),
        m_frame(std::move(frame)),
        m_input(m_values, m_source, m_monitor) {
    setServeDefaults(m_options, m_values, m_frame != nullptr);
  }

  /// Runs until the process ends. Throws Error if the first scene cannot be built.
  [[noreturn]] void run() {
    prepare(m_options, listRungs(m_options).front(), neverStopped);
    m_outputs.checkInputs();
    requireScale(m_options, m_scene->camera().pose().projection);
    for (;;) {
      renderImages();
      do {
        ServeChanges changes;
        do {
          std::ranges::move(m_input.next(), std::back_inserter(changes));
          m_startSeconds = changes.back().age.seconds();
        } while (!applyUnlessStopped(changes));
      } while (m_isComplete);
    }
  }

private:
  std::vector<Rung> listRungs(const RenderOptions& options) const {
    return m_frame ? chooseRungs(options.scene.width, options.scene.height)
                   : std::vector<Rung>{{1}};
  }

  /// Builds the scene of `options` for one size. It shares stages with the newest scene, and those
  /// that depend on the size with the last scene of this size.
  void prepare(const RenderOptions& options, const Rung& rung, const StopFlag& stop) {
    RenderRequest request = options.scene;
    request.width = rung.reduce(request.width);
    request.height = rung.reduce(request.height);
    request.isDraft = !rung.isFull();
    const auto earlier = m_scenes.find(rung.scale);
    PreparedScene scene =
        m_scene ? m_scene->withRequest(request, stop,
                                       earlier == m_scenes.end() ? nullptr : &earlier->second)
                : PreparedScene(request, m_source, stop);
    m_outputs.checkInputs();
    requireScale(options, scene.camera().pose().projection);
    m_scenes.insert_or_assign(rung.scale, scene);
    m_scene = std::move(scene);
  }

  /// Applies all changes. Returns false if a newer change came meanwhile; nothing has changed then.
  bool applyUnlessStopped(const ServeChanges& changes) {
    const Applied applied = applyChanges(changes, m_monitor.stop);
    if (applied == Applied::no) {
      applyHalves(changes);
      m_input.revert(m_values);
    }
    return applied != Applied::stopped;
  }

  enum class Applied { yes, no, stopped };
  /// Builds one scene for all changes. A single change for which that fails is reported.
  Applied applyChanges(std::span<const ServeChange> changes, const StopFlag& stop) {
    try {
      OptionValues values = m_values;
      for (const ServeChange& change : changes)
        values = applyChange(change.options, values);
      RenderOptions options = makeRenderOptions(mergePreset(values, m_source));
      setServeDefaults(options, values, m_frame != nullptr);
      checkMemory(options.scene);
      prepare(options, listRungs(options).front(), stop);
      m_options = options;
      m_values = values;
      m_change = changes.back();
      m_isComplete = false;
      return Applied::yes;
    } catch (const Error& error) {
      m_outputs.unregisterInputs();
      if (error.message().code == ErrorCode::stopped)
        return Applied::stopped;
      if (changes.size() == 1)
        writeErrorEvent(changes.front().id, error.message());
    }
    return Applied::no;
  }

  /// Applies each half of the changes separately, down to single changes.
  void applyHalves(std::span<const ServeChange> changes) {
    if (changes.size() == 1)
      return;
    for (const auto half : {changes.first(changes.size() / 2), changes.subspan(changes.size() / 2)})
      if (applyChanges(half, neverStopped) == Applied::no)
        applyHalves(half);
  }

  /// Renders the scene at each size, until all are complete or a change comes.
  void renderImages() {
    m_isComplete = false;
    m_failure.clear();
    try {
      for (const Rung& rung : listRungs(m_options)) {
        prepare(m_options, rung, m_monitor.stop);
        if (!renderImage(rung))
          return;
      }
    } catch (const Error& error) {
      if (error.message().code == ErrorCode::stopped)
        return;
      writeErrorEvent(m_change.id, error.message());
    }
    m_isComplete = true;
  }

  /// Renders one size. Publishes the first image at once, later ones at most every 0.1 seconds, and
  /// so rarely that most of the time is spent on samples. Returns false if it was stopped.
  bool renderImage(const Rung& rung) {
    m_monitor.noise = infinity;
    m_monitor.paths = 0;
    m_published.reset();
    ImageDenoiser filter(*m_scene, m_monitor.stop);
    filter.attach(m_monitor);
    m_monitor.onPause = [this, &filter, &rung](const RenderResult& result) {
      const double interval = std::max(0.1, 4.0 * m_publishSeconds);
      if (!m_monitor.stop && (!m_published || m_published->seconds() >= interval))
        publish(result, filter, rung, false);
    };
    RenderSettings settings = makeSettings(m_options, m_scene->background());
    settings.passGrowth = 1; // short passes, since images are shown between them
    if (!rung.isFull()) {
      settings.samples = 1;
      settings.noise = -1.0;
    }
    if (m_hasGpuFailed)
      settings.integrator = Integrator::simd;
    const RenderResult result = render(m_scene->view(), settings, m_monitor);
    m_hasGpuFailed = m_hasGpuFailed || !result.gpuFailure.empty();
    if (result.reason == StopReason::request)
      return false;
    publish(result, filter, rung, rung.isFull());
    return !m_monitor.stop;
  }

  /// Writes the images and reports them. A failure, such as a full disk, is reported as well, for
  /// intermediate images only when its message changes; the next image may succeed again.
  void publish(const RenderResult& result, const ImageDenoiser& filter, const Rung& rung,
               bool last) {
    const Stopwatch watch;
    try {
      const std::optional<FilteredImage> filtered = filter.apply(result);
      if (m_monitor.stop)
        return;
      if (m_frame)
        publishFrame(*m_frame, makeFrameInfo(last), *m_scene, result, filtered, m_options.display);
      if (m_hasFiles && rung.isFull()) {
        writeImages(m_options, *m_scene, result, filtered, m_values.arguments(), m_outputs);
        m_outputs.commit(Durability::none); // the next image follows soon
      }
      writeImageEvent(result, denoisedNoise(filtered), rung, last);
    } catch (const Error& error) {
      if (last || m_failure != error.what())
        writeErrorEvent(m_change.id, error.message());
      m_failure = error.what();
    }
    m_publishSeconds = watch.seconds();
    m_published.emplace();
  }

  FrameInfo makeFrameInfo(bool last) const {
    FrameInfo info;
    if (m_change.id.is_number_integer())
      info.request = m_change.id.get<std::int64_t>();
    info.fullWidth = m_options.scene.width;
    info.fullHeight = m_options.scene.height;
    info.isLast = last;
    return info;
  }

  void writeImageEvent(const RenderResult& result, const std::optional<double>& filtered,
                       const Rung& rung, bool last) {
    nlohmann::ordered_json event = {{"event", "picture"}, {"id", m_change.id}};
    event["samples"] = result.finishedSamples;
    event["noise"] = result.film.noise(); // null: infinite
    if (filtered)
      for (const char* key : {"noiseDenoised", "noiseFiltered"}) // and its name in version 0.1
        event[key] = *filtered;
    event["seconds"] = m_change.age.seconds();
    event["startSeconds"] = m_startSeconds;
    event["target"] = result.target;
    event["scale"] = rung.scale;
    event["done"] = last;
    if (m_hasFiles && rung.isFull())
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
  const bool m_hasFiles;                    ///< images at full resolution are also written to files
  const std::unique_ptr<FrameFile> m_frame; ///< null: no frame file
  RenderMonitor m_monitor;
  ServeInput m_input;
  std::map<int, PreparedScene> m_scenes; ///< last scene of each size, by Rung::scale
  std::optional<PreparedScene> m_scene;  ///< newest one
  bool m_isComplete = false;             ///< true: the scene's image is finished
  bool m_hasGpuFailed = false;           ///< true: the CPU renders all further images
  double m_startSeconds = 0.0; ///< from the arrival of the last change to the end of other work
  std::optional<Stopwatch> m_published; ///< since the last image of this size; nullopt: none yet
  double m_publishSeconds = 0.0;        ///< duration of the last publish(), s
  std::string m_failure;                ///< last reported failure to write an image of this scene
  std::set<std::string> m_warned;
};

} // namespace

// Built on first use, since renderSyntax is initialized in another source file.
const CommandSyntax& serveSyntax() {
  static const std::vector<Option> options = [] {
    std::vector<Option> all(std::begin(serveTable), std::end(serveTable));
    all.insert(all.end(), renderSyntax.options.begin(), renderSyntax.options.end());
    return all;
  }();
  static const CommandSyntax syntax = {
      "serve",
      "Keeps a scene loaded and renders it again after every change, for previews. Reads changes "
      "from standard input, one JSON object of options per line, as {\"id\": 7, \"view\": "
      "\"left\", \"focus\": [\"Femur\", \"Tibia\"]}; null removes an option; "
      "{\"pause\": true} stops rendering until the next change. Every refreshed image replaces the "
      "output files atomically. Images and errors are reported on standard output: "
      "{\"event\": \"picture\" or \"error\", \"id\": 7, ...}. Ends with its input. Accepts the "
      "options of fenestra render; unless given, --device is auto.",
      renderSyntax.positionals,
      options,
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
  OptionValues values = *given;
  const std::filesystem::path frame = values.text("mapped-image").value_or("");
  values.remove("mapped-image"); // no option of an image
  RenderJob start = makeRenderJob(values);
  if (!frame.empty() && !values.has("output"))
    start.options.outputs.clear();
  // Never destroyed: the reading thread uses both until the process ends.
  Outputs& outputs = *new Outputs;
  declareOutputs(start.options, outputs);
  checkMemory(start.options.scene);
  std::unique_ptr<FrameFile> file;
  if (!frame.empty()) {
    outputs.add(frame);
    file = std::make_unique<FrameFile>(frame, outputs);
  }
  Server& server = *new Server(start, std::move(file), outputs);
  server.run();
}

} // namespace fenestra::core
