// `fenestra turntable`: a rotation as numbered frames. The scene is built once; each frame rebuilds
// only the stages that depend on the camera (PreparedScene::changed).

#include "base/Error.h"
#include "io/InputRegistry.h"
#include "io/JsonNode.h"
#include "io/platform/Locks.h"
#include "io/platform/SystemErrors.h"
#include "program/CommandLine.h"
#include "program/Commands.h"
#include "program/ErrorAdvice.h"
#include "program/Messages.h"
#include "program/Progress.h"
#include "program/RenderSteps.h"
#include "program/Stop.h"
#include "program/TurntableManifest.h"
#include "program/UsageError.h"

#include <chrono>
#include <future>
#include <list>
#include <map>
#include <set>

namespace fenestra::core {
namespace {

/// Renders all unfinished frames in sequence.
class Turntable {
public:
  /// `arguments`: command line of the process, for the image headers.
  Turntable(const TurntableOptions& options, const Input& input, TurntableManifest& manifest,
            Outputs& outputs, std::vector<std::string> arguments)
      : m_options(options),
        m_manifest(manifest),
        m_outputs(outputs),
        m_arguments(std::move(arguments)),
        m_finishedBefore(finishedCount()),
        m_view{-2, PreparedScene(options.render.scene, input)},
        m_start(m_view.scene.camera().pose()) {}

  /// Returns the exit status.
  int run() {
    const DeferredStop stopInstead(m_monitor.stop); // the current frame is discarded
    m_outputs.checkInputs();                        // now including files that the scene refers to
    requireScale(m_options.render, m_start.projection);
    m_manifest.setInputs(m_view.scene);
    m_manifest.write(m_outputs);
    if (m_options.render.verbose)
      printFacts(m_view.scene);
    if (!m_manifest.warning().empty())
      warn(m_manifest.warning());
    renderFrames();
    const bool isComplete = finishedCount() == frameCount();
    const auto& stats = m_options.render.stats;
    if (stats &&
        (renderedCount() > 0 || isComplete)) // otherwise they would describe missing frames
      m_outputs.write(*stats, statsJson());
    m_outputs.commit();
    report();
    if (m_preparing.valid()) // its thread is still building a view, which is not needed
      endProcess(stopStatus());
    return isComplete ? 0 : stopStatus();
  }

private:
  /// Scene of a frame, before rendering.
  struct View {
    int frame; ///< -2: none, the scene has the requested camera
    PreparedScene scene;
    std::optional<VisibleSurface> surface = {};
    std::optional<SurfaceChange> change = {}; ///< since the preceding frame
  };

  /// Number of frames of this shard.
  int frameCount() const { return m_options.end() - m_options.first(); }
  int finishedCount() const { return static_cast<int>(m_manifest.finished().size()); }
  int renderedCount() const { return finishedCount() - m_finishedBefore; }

  /// Prints each distinct warning once.
  void warn(const std::string& warning) {
    if (m_warnings.insert(warning).second)
      printWarning(warning);
  }

  void renderFrames() {
    Progress progress(m_options.render, m_options.render.settings, m_monitor, m_finishedBefore,
                      frameCount());
    for (int frame = m_options.first(); frame < m_options.end(); ++frame) {
      if (m_manifest.finished().contains(frame))
        continue;
      if (!renderFrame(frame))
        return;
      progress.nextFrame();
    }
  }

  /// Returns whether the frame is finished; false: stopped.
  bool renderFrame(int frame) {
    if (!waitForView(frame))
      return false;
    m_view = m_preparing.get();
    for (const Message& warning : m_view.scene.warnings())
      warn(composeMessage(warning));
    RenderOptions options = m_options.render;
    options.outputs = m_options.images(frame);
    ImageDenoiser filter(m_view.scene);
    filter.attach(m_monitor);
    const RenderResult result =
        render(m_view.scene.view(), makeSettings(options, m_view.scene.background()), m_monitor);
    if (result.reason == StopReason::request)
      return false;
    writeImages(options, m_view.scene, result, filter.apply(result), m_arguments, m_outputs);
    m_outputs.commit();
    m_manifest.finish(frame, m_view.change, m_outputs);
    return true;
  }

  /// Builds the view in another thread, if one can start, so that a stop does not wait for the
  /// surface. Returns whether the view is ready; false: stopped.
  bool waitForView(int frame) {
    m_preparing = std::async([this, frame] { return buildView(frame); });
    while (m_preparing.wait_for(std::chrono::milliseconds(10)) == std::future_status::timeout)
      if (m_monitor.stop)
        return false;
    return true;
  }

  /// Scene for the initial camera, rotated around its target.
  PreparedScene buildScene(double degrees) const {
    const CameraPose pose = rotateAroundTarget(m_start, degrees);
    RenderRequest request = m_options.render.scene;
    request.view = {.projection = pose.projection,
                    .position = pose.position,
                    .target = pose.target,
                    .up = pose.up,
                    .scale = pose.scale,
                    .angle = pose.angle};
    return m_view.scene.withRequest(request);
  }

  View buildView(int frame) const {
    const double step = m_options.angle(1), angle = m_options.angle(frame);
    View view{frame, buildScene(angle)};
    view.surface = findVisibleSurface(view.scene);
    const bool follows = step != 0.0 && (frame > 0 || m_options.isClosed());
    if (!follows || !view.surface)
      return view;
    const bool isNext = m_view.frame == frame - 1;
    if (const auto before = isNext ? m_view.surface : findVisibleSurface(buildScene(angle - step)))
      view.change = measureChange(*before, *view.surface, m_start.up, step);
    return view;
  }

  /// Visible part of the clipping surface; nullopt: the clip has no smooth surface.
  static std::optional<VisibleSurface> findVisibleSurface(const PreparedScene& scene) {
    const auto* clip = std::get_if<ClipDepth>(&scene.clip());
    if (!clip || clip->lookup != ClipDepth::Lookup::linear)
      return std::nullopt;
    return makeVisibleSurface(*clip, scene.clipResult().focusDepth, scene.domain());
  }

  std::string statsJson() const {
    nlohmann::ordered_json json = {{"frames", frameCount()},
                                   {"finished", finishedCount()},
                                   {"rendered", renderedCount()},
                                   {"degrees", m_options.degrees},
                                   {"seconds", m_total.seconds()}};
    const std::vector<SurfaceChange> changes = m_manifest.changes();
    SurfaceChange all;
    double excess = 0.0;
    for (const SurfaceChange& change : changes) {
      all.mean += change.mean / static_cast<double>(changes.size());
      all.p95 = std::max(all.p95, change.p95);
      all.max = std::max(all.max, change.max);
      all.focus = std::max(all.focus, change.focus);
      excess = std::max(excess, change.excess());
    }
    if (!changes.empty()) {
      json["surfaceChangeMmPerDegree"] = toJson(all);
      json["surfaceChangeMmPerDegree"]["excess"] = excess;
    }
    json["warnings"] = m_warnings;
    return dumpJson(json);
  }

  void report() const {
    const bool isComplete = finishedCount() == frameCount();
    if (!m_options.render.quiet)
      printLine(concat(m_options.images(m_options.first()).front(), " to ",
                       m_options.images(m_options.end() - 1).front().filename(), ": ",
                       finishedCount(), " of ", frameCount(), " frames, ", renderedCount(),
                       " rendered now, ", toString(m_total.seconds(), 3), " s",
                       isComplete ? "" : " (stopped on request; the same command resumes)"));
  }

  const TurntableOptions& m_options;
  TurntableManifest& m_manifest;
  Outputs& m_outputs;
  std::vector<std::string> m_arguments;
  int m_finishedBefore; ///< frames finished by earlier runs
  Stopwatch m_total;
  RenderMonitor m_monitor;
  View m_view;        ///< last one built
  CameraPose m_start; ///< of frame 0
  std::set<std::string> m_warnings;
  std::future<View> m_preparing; ///< still valid after a stop
};

/// Declares all results before the render. On resuming, an unfinished frame may replace only files
/// that Fenestra wrote: any other file in its place is newer than the manifest.
void declareFrames(const TurntableOptions& options, const TurntableManifest& manifest,
                   Outputs& outputs) {
  for (int frame = options.first(); frame < options.end(); ++frame) {
    const bool mustBeOwn = !options.restart && !manifest.finished().contains(frame);
    for (const std::filesystem::path& path : options.images(frame))
      declareImage(path, outputs, mustBeOwn ? NameOrigin::standard : options.render.outputNaming,
                   options.render.extraFiles());
  }
  if (options.render.stats)
    outputs.add(*options.render.stats);
  manifest.declare(outputs);
}

/// Locks to hold while the frames are written. Throws Error: usage if another process holds one;
/// output.
std::list<NameLock> lockFrames(const TurntableOptions& options) {
  std::map<std::filesystem::path, std::filesystem::path> names; // as given, by canonical path
  for (const std::filesystem::path& output : options.render.outputs) {
    const std::filesystem::path name = manifestPath(output, options.shard),
                                folder = name.parent_path();
    std::error_code failed;
    const auto known = std::filesystem::canonical(folder.empty() ? "." : folder, failed);
    if (failed)
      throw writeError(name, failed.value());
    names.emplace(known / name.filename(), name);
  }
  std::list<NameLock> locks;
  for (const auto& [known, name] : names)
    if (!locks.emplace_back(name).isHeld())
      throw usageError(options.render.outputs.front(),
                       ": another turntable is writing these frames; wait for it, or use another "
                       "--output");
  return locks;
}

} // namespace

int turntableCommand(int argc, char** argv, int first) {
  const std::optional<OptionValues> given = parseCommandLine(turntableSyntax(), argc, argv, first);
  if (!given)
    return 0;
  configureMachine(*given);
  OptionValues values = *given;
  values.remove("shard"); // a turntable distributes frames, not tiles
  const RenderJob job = makeRenderJob(values);
  TurntableOptions options = makeTurntableOptions(job.values, job.options);
  options.shard = readOptions(*given).settings.shard;
  if (options.first() == options.end())
    throw usageError("--shard: ", options.shard.count, " shards are more than the ", options.frames,
                     " frames; use fewer shards");
  for (const std::filesystem::path& input : options.render.inputs)
    registerInput(input); // so that --restart does not replace an input
  const auto locks = lockFrames(options);
  TurntableManifest manifest(options, job.values);
  Outputs outputs;
  declareFrames(options, manifest, outputs);
  checkMemory(options.render.scene);
  Turntable turntable(options, job.input, manifest, outputs, {argv + 1, argv + argc});
  return turntable.run();
}

} // namespace fenestra::core
