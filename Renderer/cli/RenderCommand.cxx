#include "cli/Commands.h"

#include "cli/CommandLine.h"
#include "cli/Machine.h"
#include "cli/Pictures.h"
#include "cli/PresetFlags.h"
#include "cli/Progress.h"
#include "cli/RenderFlags.h"
#include "cli/SceneFlags.h"
#include "cli/SlicerModule.h"
#include "cli/Stats.h"
#include "cli/Stop.h"
#include "io/AtomicFile.h"
#include "scene/Scene.h"

#include <algorithm>
#include <iostream>
#include <sstream>

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
  std::ostringstream line;
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
  std::cout << line.str() << std::endl;
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
  const PresetFlags flags = withPreset(withSceneFlags(*given));
  if (given->has("echo"))
    std::cout << flags.flags.echo() << std::flush;
  const RenderOptions options = renderOptions(flags);
  const MachineUse machine(options.settings);
  RenderMonitor monitor;
  StopOnSignal stopOnSignal;
  checkOutputs(options);

  const Stopwatch total;
  RenderStats stats;
  const Scene scene(options.scene);
  for (const std::string& warning : scene.warnings())
    (options.returnValues ? std::cout : std::cerr) << "fenestra: warning: " << warning << '\n';

  stopOnSignal.setInstead(monitor.stop);
  std::future<void> surface = startSurface(options, scene); // so that a stop need not wait for it
  const Stopwatch transport;
  const RenderResult result = renderWithProgress(scene, options, monitor);
  stats.transport = transport.seconds();
  surface.get();
  if (result.finishedSamples == 0) {
    std::cerr << "fenestra: stopped on request before the first pass; no picture was written\n";
    return stoppedStatus;
  }

  if (options.stats) {
    const Stopwatch focus;
    stats.focus = measureFocus(scene, options.settings.seed);
    stats.measure = focus.seconds();
  }
  const Stopwatch write;
  writePictures(options, scene, result, shellCommand({argv + 1, argv + argc}));
  if (options.stats) {
    stats.stages = scene.seconds();
    stats.mismatch = scene.mismatch();
    stats.boundary = scene.boundary();
    for (const ControlPoint& point : scene.controlPoints())
      stats.controlPoints.push_back(scene.camera().toRaster(point.site));
    stats.preset = options.preset;
    stats.warnings = scene.warnings();
    stats.files = scene.files();
    const MajorantGrid& majorants = scene.forRender().majorants;
    stats.cells = majorants.size();
    stats.emptyCells = majorants.emptyCount();
    if (scene.focus())
      stats.focusVoxels = scene.focus()->grid.voxelCount();
    stats.write = write.seconds();
    stats.total = total.seconds();
    writeFile(*options.stats, statsJson(stats, result));
  }
  if (options.returnValues)
    writeReturnValues(*options.returnValues,
                      {result.film.sampleCounts().mean, result.film.noise(), stats.transport});
  report(options, result, total.seconds());
  return result.reason == StopReason::request ? stoppedStatus : 0;
}

} // namespace fenestra
