#include "program/Commands.h"

#include "base/TextStream.h"
#include "base/safe/ShownText.h"
#include "clip/mesh/SurfaceWriter.h"
#include "files/pictures/ImageWriter.h"
#include "program/CommandLine.h"
#include "program/Machine.h"
#include "program/Pictures.h"
#include "program/Progress.h"
#include "program/SlicerModule.h"
#include "program/Stats.h"
#include "program/Stop.h"

#include <algorithm>
#include <future>
#include <iostream>

namespace fenestra {
namespace {

/// Starts writing options.surface, if set, in parallel to other work. The arguments must outlive
/// the future; its get() throws Error (output).
std::future<void> startSurface(const RenderOptions& options, const Scene& scene, Outputs& outputs) {
  if (!options.surface)
    return std::async(std::launch::deferred, [] {});
  return std::async([&options, &scene, &outputs] {
    const auto& clip = std::get<ClipDepth>(scene.clip());
    writeSurface(surfaceMesh(clip, scene.domain(), surfaceTolerance(clip.camera)), *options.surface,
                 outputs);
  });
}

/// A warning for each existing file that belongs to one of options.outputs and was not written with
/// it, such as the old depth beside a `.nrrd` that has no depth now. For after the commit.
std::vector<std::string> staleParts(const RenderOptions& options, const Outputs& outputs) {
  std::vector<std::string> warnings;
  std::error_code failed;
  for (const std::filesystem::path& path : options.outputs)
    for (const std::filesystem::path& file : imageFiles(path))
      if (!outputs.written(file) && std::filesystem::exists(file, failed))
        warnings.push_back(oneLine(file.string()) + ": is of an earlier picture than " +
                           oneLine(path.filename().string()) + "; remove it");
  return warnings;
}

void report(const RenderOptions& options, const RenderResult& result, double seconds) {
  const double noise = result.film.noise();
  TextWriter line;
  line.precision(3);
  line << joined(options.outputs, ", ", [](const auto& path) { return path.string(); }) << ": "
       << options.scene.width << "x" << options.scene.height << " pixels, "
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

/// Renders the scene, puts its pictures in place, then measures them for the statistics. Returns
/// the exit status.
int renderScene(const PictureRequest& request, const std::vector<std::string>& words,
                Outputs& outputs) {
  const RenderOptions& options = request.options;
  const Stopwatch total;
  const Scene scene(options.scene, request.input);
  outputs.checkInputs(); // now also files that the scene refers to
  warn(options, scene.warnings());

  RenderMonitor monitor;
  const StopInstead stopInstead(monitor.stop);
  std::future<void> surface = startSurface(options, scene, outputs);
  Stopwatch watch;
  RenderStats stats;
  const RenderResult result = [&] {
    const Progress progress(options, monitor);
    return render(scene.forRender(), settingsFor(options, scene.background()), monitor);
  }();
  stats.transport = watch.seconds();
  surface.get();
  if (result.finishedSamples == 0) {
    std::cerr << "fenestra: stopped on request before the first pass; no picture was written\n";
    return stopStatus();
  }
  watch.lap();
  writePictures(options, scene, result, words, outputs);
  outputs.commit();
  stats.write = watch.lap();
  stats.warnings = staleParts(options, outputs);
  warn(options, stats.warnings);

  if (options.stats) {
    watch.lap();
    if (!monitor.stop) // a stop does not wait for measures
      stats.focus = measureFocus(scene, options.settings.seed, monitor.stop);
    stats.measure = watch.seconds();
    stats.total = total.seconds();
    outputs.write(*options.stats, statsJson(stats, options, scene, result));
  }
  if (options.returnValues)
    outputs.write(*options.returnValues, returnValuesText({result.film.sampleCounts().mean,
                                                           result.film.noise(), stats.transport}));
  outputs.commit();
  report(options, result, total.seconds());
  return result.reason == StopReason::request ? stopStatus() : 0;
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
  const PictureRequest request = pictureRequest(*given);
  if (given->has("echo"))
    std::cout << request.flags.echo() << std::flush;
  Outputs outputs;
  declareOutputs(request.options, outputs);
  checkMemory(request.options.scene);
  return renderScene(request, {argv + 1, argv + argc}, outputs);
}

} // namespace fenestra
