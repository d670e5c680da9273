// `fenestra turntable`: a rotation as numbered frames. The scene is built once; for each frame only
// the stages that depend on the camera are rebuilt (Scene::changed).

#include "base/Error.h"
#include "base/TextStream.h"
#include "base/safe/Inputs.h"
#include "base/safe/Locks.h"
#include "base/safe/ShownText.h"
#include "base/safe/SystemCalls.h"
#include "program/CommandLine.h"
#include "program/Commands.h"
#include "program/Machine.h"
#include "program/Pictures.h"
#include "program/Progress.h"
#include "program/SceneFlags.h"
#include "program/Stop.h"
#include "program/TurntableRecord.h"
#include "session/Scene.h"

#include <chrono>
#include <future>
#include <iostream>
#include <map>
#include <memory>
#include <set>

namespace fenestra {
namespace {

/// Renders all frames that are not finished, one by one.
class Turntable {
public:
  Turntable(const TurntableOptions& options, const Input& input, TurntableRecord& record,
            RenderMonitor& monitor, Outputs& outputs, std::string command)
      : m_options(options),
        m_record(record),
        m_monitor(monitor),
        m_outputs(outputs),
        m_command(std::move(command)),
        m_before(record.finishedCount()),
        m_scene(options.render.scene, input),
        m_start(m_scene.camera().pose()) {}

  /// True if a view is still being built after a stop, and will not be used.
  bool isPreparing() const { return m_preparing.valid(); }
  int rendered() const { return m_record.finishedCount() - m_before; }

  void run() {
    m_outputs.checkInputs(); // now also files that the scene refers to
    m_record.setInputs(m_options, m_scene);
    m_record.write(m_outputs);
    if (const auto warning = m_record.warning())
      warn(*warning);
    const RenderOptions& render = m_options.render;
    const RenderSettings settings = settingsFor(render, m_scene.background());
    Progress progress(render.progress, settings,
                      static_cast<std::uint64_t>(render.scene.width) *
                          static_cast<std::uint64_t>(render.scene.height),
                      m_monitor, {m_before, m_options.frames});
    for (int frame = 0; frame < m_options.frames; ++frame) {
      if (m_record.isFinished(frame))
        continue;
      if (!renderFrame(frame, settings))
        return;
      m_monitor.paths = 0;
      m_monitor.noise = infinity;
      progress.nextFrame();
    }
  }

  /// JSON text: frames, seconds, changes of the surface, warnings.
  std::string statsJson(double seconds) const {
    nlohmann::ordered_json json = {{"frames", m_options.frames},
                                   {"finished", m_record.finishedCount()},
                                   {"rendered", rendered()},
                                   {"degrees", m_options.degrees},
                                   {"seconds", seconds}};
    if (!m_record.changes().empty())
      json["surfaceChangeMmPerDegree"] = changesJson();
    json["warnings"] = m_warnings;
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  }

private:
  /// Scene of a frame, before rendering.
  struct View {
    Scene scene;
    std::optional<SeenSurface> surface;
    std::optional<SurfaceChange> change; ///< since the preceding frame
  };

  /// Returns whether the frame is finished; false: stopped.
  bool renderFrame(int frame, const RenderSettings& settings) {
    if (!waitForView(frame))
      return false;
    View view = m_preparing.get();
    m_scene = std::move(view.scene);
    m_surface = std::move(view.surface);
    m_surfaceFrame = frame;
    for (const std::string& warning : m_scene.warnings())
      warn(warning);
    const RenderResult result = render(m_scene.forRender(), settings, m_monitor);
    if (result.reason == StopReason::request)
      return false;
    writePictures(frameOptions(m_options, frame), m_scene, result, m_command, m_outputs);
    m_outputs.commit();
    m_record.finish(frame, frameFiles(m_options, frame), view.change, m_outputs);
    return true;
  }

  /// Prints each distinct warning once.
  void warn(const std::string& warning) {
    if (m_warnings.insert(warning).second)
      std::cerr << "fenestra: warning: " << oneLine(warning) << '\n';
  }

  /// Builds the view in another thread if one can start: a stop does not wait for surfaces. Returns
  /// whether the view is ready; false: stopped.
  bool waitForView(int frame) {
    m_preparing = std::async([this, frame] { return viewOf(frame); });
    while (m_preparing.wait_for(std::chrono::milliseconds(10)) == std::future_status::timeout)
      if (m_monitor.stop)
        return false;
    return true;
  }

  Scene sceneAt(double degrees) const {
    return m_scene.changed(turnedRequest(m_options.render.scene, m_start, degrees));
  }

  View viewOf(int frame) const {
    const double step = m_options.angle(1), angle = m_options.angle(frame);
    const bool follows = frame > 0 || m_options.isClosed();
    std::optional<SeenSurface> before = m_surface;
    if (follows && m_surfaceFrame != frame - 1)
      before = seen(sceneAt(angle - step));
    View view{sceneAt(angle), std::nullopt, std::nullopt};
    view.surface = seen(view.scene);
    if (follows && before && view.surface && step != 0.0)
      view.change = changeBetween(*before, *view.surface, m_start.up, step);
    return view;
  }

  /// Visible part of the clipping surface; nullopt: the clip is no surface.
  static std::optional<SeenSurface> seen(const Scene& scene) {
    const auto* clip = std::get_if<ClipDepth>(&scene.clip());
    if (!clip || clip->lookup != ClipDepth::Lookup::linear)
      return std::nullopt;
    return seenSurface(*clip, scene.focusDepth(), scene.domain());
  }

  nlohmann::ordered_json changesJson() const {
    SurfaceChange all;
    double excess = 0.0;
    for (const auto& [frame, change] : m_record.changes()) {
      all.mean += change.mean / static_cast<double>(m_record.changes().size());
      all.p95 = std::max(all.p95, change.p95);
      all.max = std::max(all.max, change.max);
      all.focus = std::max(all.focus, change.focus);
      excess = std::max(excess, change.excess());
    }
    nlohmann::ordered_json json = changeJson(all);
    json["excess"] = excess;
    return json;
  }

  const TurntableOptions& m_options;
  TurntableRecord& m_record;
  RenderMonitor& m_monitor;
  Outputs& m_outputs;
  std::string m_command;
  int m_before; ///< frames finished by earlier runs
  Scene m_scene;
  CameraPose m_start;
  std::optional<SeenSurface> m_surface; ///< surface of frame m_surfaceFrame
  int m_surfaceFrame = -2;              ///< -2: no frame so far
  std::set<std::string> m_warnings;
  std::future<View> m_preparing; ///< abandoned by a stop
};

/// Declares all frames before the long work. When resuming, an unfinished frame may replace only
/// Fenestra's own files: other files in its place were put there since.
void declareFrames(const TurntableOptions& options, const TurntableRecord& record,
                   Outputs& outputs) {
  for (int frame = 0; frame < options.frames; ++frame) {
    RenderOptions render = frameOptions(options, frame);
    if (!options.restart && !record.isFinished(frame))
      render.outputsNamedBy = NamedBy::standard;
    if (frame == 0)
      declareOutputs(render, outputs);
    else
      for (const std::filesystem::path& path : render.outputs)
        declareImage(path, outputs, render.outputsNamedBy);
  }
  record.declare(outputs);
  checkMemory(options.render.scene);
}

/// Locks, to be held while the frames are written. Throws Error: usage if another process holds
/// one; output.
std::vector<std::unique_ptr<NameLock>> lockFrames(const TurntableOptions& options) {
  std::map<std::filesystem::path, std::filesystem::path> names; // as given, by canonical path
  for (const std::filesystem::path& output : options.render.outputs) {
    const std::filesystem::path name = recordPath(output);
    std::error_code failed;
    std::filesystem::path folder = std::filesystem::absolute(output, failed).parent_path();
    if (!failed)
      folder = std::filesystem::canonical(folder, failed);
    if (failed)
      throw writingError(name, failed.value());
    names.emplace(folder / name.filename(), name);
  }
  std::vector<std::unique_ptr<NameLock>> locks;
  for (const auto& [known, name] : names) {
    locks.push_back(std::make_unique<NameLock>(name));
    if (!locks.back()->isHeld())
      throw usageError(options.render.outputs.front().string() +
                       ": another turntable is writing these frames; wait for it, or choose "
                       "another --output");
  }
  return locks;
}

void report(const TurntableOptions& options, const TurntableRecord& record, int rendered,
            double seconds) {
  const bool isWhole = record.finishedCount() == options.frames;
  TextWriter line;
  line.precision(3);
  line << framePath(options.render.outputs.front(), 0).string() << " to "
       << framePath(options.render.outputs.front(), options.frames - 1).filename().string() << ": "
       << record.finishedCount() << " of " << options.frames << " frames, " << rendered
       << " rendered now, " << seconds << " s"
       << (isWhole ? "" : " (stopped on request; the same command goes on)");
  std::cout << oneLine(line.str()) << std::endl;
}

} // namespace

int turntableCommand(int argc, char** argv, int first) {
  const std::optional<FlagValues> given = parseCommandLine(turntableSyntax(), argc, argv, first);
  if (!given)
    return 0;
  useMachine(*given);
  const Input input(*given->text("INPUT"));
  const SceneFlags stored = withSceneFlags(*given, input);
  const PresetFlags flags = withPreset(stored.flags, input);
  TurntableOptions options = turntableOptions(flags);
  options.render.scene.leftOut = stored.leftOut;
  for (const std::filesystem::path& input : options.render.inputs)
    expectInput(input); // --restart replaces no input
  const auto locks = lockFrames(options);
  TurntableRecord record(options, flags.flags);
  RenderMonitor monitor;
  Outputs outputs;
  declareFrames(options, record, outputs);

  const Stopwatch total;
  Turntable turntable(options, input, record, monitor, outputs,
                      shellCommand({argv + 1, argv + argc}, options.render));
  const StopInstead stopInstead(monitor.stop); // the frame under way is discarded
  turntable.run();
  const bool hasNews = turntable.rendered() > 0 || record.finishedCount() == options.frames;
  if (options.render.stats && hasNews) // otherwise the statistics would describe missing pictures
    outputs.write(*options.render.stats, turntable.statsJson(total.seconds()));
  outputs.commit();
  report(options, record, turntable.rendered(), total.seconds());
  std::cout.flush();
  if (turntable.isPreparing())
    endProcess(stopStatus());
  return record.finishedCount() == options.frames ? 0 : stopStatus();
}

} // namespace fenestra
