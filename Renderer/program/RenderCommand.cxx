#include "program/Commands.h"

#include "base/TextStream.h"
#include "base/safe/ShownText.h"
#include "program/CommandLine.h"
#include "program/FileNames.h"
#include "program/Machine.h"
#include "program/Pictures.h"
#include "program/PresetFlags.h"
#include "program/Progress.h"
#include "program/RenderFlags.h"
#include "program/SceneFlags.h"
#include "program/SlicerModule.h"
#include "program/Stats.h"
#include "program/Stop.h"
#include "session/Scene.h"

#include <algorithm>
#include <iostream>

namespace fenestra {
namespace {

RenderResult renderWithProgress(const Scene& scene, const RenderOptions& options,
                                RenderMonitor& monitor) {
  const RenderSettings settings = settingsFor(options, scene.background());
  const Progress progress(options.progress, settings,
                          static_cast<std::uint64_t>(options.scene.width) *
                              static_cast<std::uint64_t>(options.scene.height),
                          monitor);
  return render(scene.forRender(), settings, monitor);
}

void report(const RenderOptions& options, const RenderResult& result, double seconds) {
  std::string files;
  for (const std::filesystem::path& path : options.outputs)
    files += (files.empty() ? "" : ", ") + path.string();
  const double noise = result.film.noise();
  TextWriter line;
  line.precision(3);
  line << files << ": " << options.scene.width << "x" << options.scene.height << " pixels, "
       << result.finishedSamples << (result.finishedSamples == 1 ? " sample" : " samples");
  const SampleCounts counts = result.film.sampleCounts();
  if (counts.least == counts.greatest)
    line << " each";
  else
    line << " a pixel (" << counts.least << " to " << counts.greatest << ")";
  if (noise < infinity)
    line << ", noise " << noise;
  line << ", " << seconds << " s"
       << (result.reason == StopReason::request ? " (stopped on request)" : "");
  std::cout << oneLine(line.str()) << std::endl;
}

void warn(const RenderOptions& options, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings)
    (options.returnValues ? std::cout : std::cerr)
        << "fenestra: warning: " << oneLine(warning) << '\n';
}

/// Enters the scene's own results and times.
void describe(const Scene& scene, RenderStats& stats) {
  stats.stages = scene.seconds();
  stats.mismatch = scene.mismatch();
  stats.boundary = scene.boundary();
  for (const ControlPoint& point : scene.controlPoints())
    stats.controlPoints.push_back(scene.camera().toRaster(point.site));
  stats.warnings = scene.warnings();
  stats.files = scene.files();
  const MajorantGrid& majorants = scene.forRender().majorants;
  stats.cells = majorants.size();
  stats.emptyCells = majorants.emptyCount();
  if (scene.focus())
    stats.focusVoxels = scene.focus()->grid.voxelCount();
}

/// Renders the scene, puts its pictures in place, then measures them for the statistics. Returns
/// the exit status.
int renderScene(const RenderOptions& options, const Input& input, const std::string& command,
                Outputs& outputs) {
  const Stopwatch total;
  RenderStats stats;
  const Scene scene(options.scene, input);
  outputs.checkInputs(); // now also files that the scene refers to
  warn(options, scene.warnings());

  RenderMonitor monitor;
  const StopInstead stopInstead(monitor.stop);
  std::future<void> surface = startSurface(options, scene, outputs);
  const Stopwatch transport;
  const RenderResult result = renderWithProgress(scene, options, monitor);
  stats.transport = transport.seconds();
  surface.get();
  if (result.finishedSamples == 0) {
    std::cerr << "fenestra: stopped on request before the first pass; no picture was written\n";
    return stopStatus();
  }
  const bool isStopped = result.reason == StopReason::request;
  const Stopwatch write;
  writePictures(options, scene, result, command, outputs);
  outputs.commit();
  stats.write = write.seconds();
  const std::vector<std::string> stale = staleParts(options, outputs);
  warn(options, stale);

  if (options.stats) {
    const Stopwatch measure;
    if (!monitor.stop) // a stop does not wait for measures
      stats.focus = measureFocus(scene, options.settings.seed, monitor.stop);
    stats.measure = measure.seconds();
    describe(scene, stats);
    stats.warnings.insert(stats.warnings.end(), stale.begin(), stale.end());
    if (options.preset)
      stats.preset = relativeName(*options.preset, options.stats->parent_path());
    stats.total = total.seconds();
    for (std::string& file : stats.files)
      file = relativeName(file, options.stats->parent_path());
    outputs.write(*options.stats, statsJson(stats, result));
  }
  if (options.returnValues)
    outputs.write(*options.returnValues, returnValuesText({result.film.sampleCounts().mean,
                                                           result.film.noise(), stats.transport}));
  outputs.commit();
  report(options, result, total.seconds());
  return isStopped ? stopStatus() : 0;
}

} // namespace

int renderCommand(int argc, char** argv, int first) {
  if (std::find(argv + first, argv + argc, std::string_view("--xml")) != argv + argc) {
    std::cout << slicerDescription(renderSyntax) << std::flush;
    return 0;
  }
  const std::optional<FlagValues> given = parseCommandLine(renderSyntax, argc, argv, first);
  if (!given)
    return 0;
  useMachine(*given);
  const Input input(*given->text("INPUT"));
  const SceneFlags stored = withSceneFlags(*given, input);
  const PresetFlags flags = withPreset(stored.flags, input);
  if (given->has("echo"))
    std::cout << flags.flags.echo() << std::flush;
  RenderOptions options = renderOptions(flags);
  options.scene.leftOut = stored.leftOut;
  Outputs outputs;
  declareOutputs(options, outputs);
  checkMemory(options.scene);
  return renderScene(options, input, shellCommand({argv + 1, argv + argc}, options), outputs);
}

} // namespace fenestra
