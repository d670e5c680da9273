#include "program/RenderCommand.h"

#include "clip/mesh/SurfaceWriter.h"
#include "files/images/ImageFormat.h"
#include "files/images/ImageWriter.h"
#include "io/JsonNode.h"
#include "io/MessageText.h"
#include "io/platform/ProcessState.h"
#include "metrics/FocusMetrics.h"
#include "program/CommandLine.h"
#include "program/Commands.h"
#include "program/ErrorAdvice.h"
#include "program/FileNames.h"
#include "program/Messages.h"
#include "program/Progress.h"
#include "program/RenderSteps.h"
#include "program/SlicerModule.h"
#include "program/Stop.h"

#include <algorithm>
#include <future>
#include <iostream>

namespace fenestra::core {
namespace {

using Json = nlohmann::ordered_json;

// ---- statistics

/// Facts about a render that neither its scene nor its result has.
struct RenderStats {
  /// Wall-clock seconds. Transport includes checks of the denoised image's noise.
  double transport = 0.0, filter = 0.0, write = 0.0, measure = 0.0, total = 0.0;
  std::optional<std::uint64_t> checkpointPaths = {}; ///< in the checkpoint file at the start
  std::optional<double> filtered = {};               ///< estimated noise after denoising
  std::optional<FocusReport> focus = {};
  std::vector<std::string> warnings = {}; ///< in addition to the scene's
};

Json toJson(const Distribution& values) {
  return {{"mean", values.mean}, {"p95", values.p95}, {"max", values.max}};
}

/// Color differences between focus and neighbors, and the color adjustments that achieved them.
void addContrast(Json& json, const PreparedScene& scene) {
  const TintContrast* tint = scene.tintContrast();
  const auto& contrast = tint ? tint->contrast : scene.contrast().contrast;
  if (!contrast)
    return;
  Json& entry = json["contrast"];
  entry = {
      {"deltaE", contrast->deltaE[0]},       {"deltaEProtan", contrast->deltaE[1]},
      {"deltaEDeutan", contrast->deltaE[2]}, {"deltaETritan", contrast->deltaE[3]},
      {"deltaL", contrast->deltaL},          {"contextSaturation", scene.contrast().saturation}};
  if (tint)
    entry.update(Json{{"segment", tint->segment},
                      {"neighbour", tint->neighbor},
                      {"contextSaturation", tint->adjustment.contextSaturation},
                      {"contextLightness", tint->adjustment.contextLightness},
                      {"focusLightness", tint->adjustment.focusLightness},
                      {"focusAccent", tint->adjustment.focusAccent},
                      {"accent", accentColors[tint->adjustment.accent].name}});
}

/// Adds the margins of the focus and the measures of the clip.
void addClip(Json& json, const PreparedScene& scene, const std::optional<FocusReport>& focus) {
  const ClipResult& clip = scene.clipResult();
  if (clip.mismatch)
    json["boundaryMismatchMm"] = toJson(*clip.mismatch);
  if (const auto& boundary = clip.boundary; boundary && boundary->crossings > 0) {
    json["boundaryGapMm"] = toJson(boundary->gap);
    json["boundarySlopeJump"] = toJson(boundary->slopeJump);
    json["boundaryDepthJumps"] = boundary->depthJumpFraction;
  }
  for (const SegmentMargin& margin : scene.margins())
    json["organMargins"].push_back({{"segment", margin.segment},
                                    {"applied", margin.isApplied},
                                    {"meanMm", margin.mean},
                                    {"p95Mm", margin.p95},
                                    {"volumeMm3", margin.volume}});
  for (const ControlPoint& point : clip.controlPoints) {
    const Vec2 raster = scene.camera().toRaster(point.site);
    json["controlPoints"].push_back({raster.x(), raster.y()});
  }
  if (!focus)
    return;
  json["focusCoverage"] = focus->coverage;
  json["focusKept"] = focus->unclipped;
  json["focusCoverageUnclipped"] = focus->withoutClip;
  if (focus->light)
    json["focusLight"] = *focus->light;
  if (focus->contextRemoved)
    json["contextRemoved"] = *focus->contextRemoved;
}

/// Adds what was done to the volume, and in CT what small lesions lose by it.
void addSmoothing(Json& json, const PreparedScene& scene) {
  const auto smoothing = scene.smoothing();
  if (!smoothing)
    return;
  Json& entry = json["volumeSmoothing"];
  entry = {{"noise", smoothing->noise},
           {"strength", smoothing->strength},
           {"method", !smoothing->isApplied()    ? "none"
                      : smoothing->isLogarithmic ? "non-local means of logarithms"
                                                 : "non-local means"},
           {"reused", smoothing->isReused}};
  if (!smoothing->isApplied())
    return;
  entry["islands"] = {{"count", smoothing->islands}, {"mm3", smoothing->islandVolume}};
  if (!smoothing->isHounsfield)
    return;
  for (const auto& [diameter, percent] : lesionContrasts)
    entry["lesionContrast"][concat(diameter, " mm")] = 0.01 * percent;
}

/// Adds display settings, the files that were read, and warnings.
void addSources(Json& json, const RenderStats& stats, const RenderOptions& options,
                const PreparedScene& scene) {
  const std::filesystem::path folder = options.stats->parent_path();
  if (std::ranges::any_of(options.outputs, isDisplayFile))
    json["display"] = {{"tone", toString(options.display.view)},
                       {"exposure", options.display.exposure}};
  addSmoothing(json, scene);
  json["transferFunction"] = toRelativeName(scene.transferName(), folder);
  if (options.preset)
    json["preset"] = toRelativeName(*options.preset, folder);
  json["filesRead"] = Json::array();
  for (const std::string& file : scene.files())
    json["filesRead"].push_back(toRelativeName(file, folder));
  json["warnings"] = composeMessages(scene.warnings());
  for (const std::string& warning : stats.warnings)
    json["warnings"].push_back(warning);
}

/// Content of options.stats, which must be set. markEmptyPixels: exactly known from one sample, and
/// not in samplesPerPixel; cells: of the majorant grid; focusVoxels: of the cropped label map;
/// controlPoints: column and row in the image. Measures of the clip: see BoundaryMetrics and
/// FocusReport. File names are relative to the folder of the statistics.
std::string makeStatsJson(const RenderStats& stats, const RenderOptions& options,
                          const PreparedScene& scene, const RenderResult& result) {
  const ResourceUsage usage = readResourceUsage();
  const SampleCounts samples = result.film.sampleCounts();
  const Counters& c = result.counters;
  const StageSeconds& stages = scene.seconds();
  const MajorantGrid& majorants = scene.view().majorants;

  Json json;
  json["seconds"] = {{"load", stages.load},           {"smoothing", stages.smoothing},
                     {"materials", stages.materials}, {"classify", stages.classify},
                     {"focus", stages.focus},         {"spline", stages.spline},
                     {"fill", stages.fill},           {"features", stages.features},
                     {"transport", stats.transport},  {"filter", stats.filter},
                     {"measure", stats.measure},      {"write", stats.write},
                     {"total", stats.total}};
  json["cpuSeconds"] = usage.cpuSeconds;
  json["paths"] = c.paths;
  if (stats.checkpointPaths)
    json["pathsFromFilm"] = *stats.checkpointPaths;
  json["collisions"] = c.collisions;
  json["lookups"] = c.lookups;
  json["skippedFraction"] =
      c.cells > 0 ? static_cast<double>(c.skippedCells) / static_cast<double>(c.cells) : 0.0;
  json["shadowRays"] = c.shadowRays;
  json["gradients"] = c.gradients;
  json["cells"] = {{"all", majorants.size()}, {"empty", majorants.emptyCount()}};
  json["emptyPixels"] = samples.deterministicPixels;
  json["target"] = result.target;
  json["sampling"] = toString(options.settings.sampling);
  json["samplesPerPixel"] = {{"min", samples.min}, {"mean", samples.mean}, {"max", samples.max}};
  json["noise"] = result.film.noise(); // null: infinite
  if (scene.features())
    for (const char* key : {"noiseDenoised", "noiseFiltered"})     // and its name in version 0.1
      json[key] = stats.filtered ? Json(*stats.filtered) : Json(); // null: unknown
  json["peakBytes"] = usage.peakBytes;
  addClip(json, scene, stats.focus);
  if (const Mask* focus = scene.focus()) {
    json["focusVoxels"] = focus->grid.voxelCount();
    const Vec3 native = scene.nativeSpacing();
    json["labelSmoothing"] = {{"sigmaMm", focus->smoothing},
                              {"nativeMm", {native.x(), native.y(), native.z()}},
                              {"volumeChange", focus->volumeChange}};
  }
  if (const Tint* tint = scene.tint())
    json["labels"] = {{"components", tint->albedo.size()},
                      {"pureFraction", tint->weights->pureFraction()},
                      {"bytes", tint->weights->bytes()}};
  addContrast(json, scene);
  addSources(json, stats, options, scene);
  return dumpJson(json);
}

// ---- the command

/// Starts writing options.surface, if set, in another thread. The arguments must outlive the
/// future. Its get() throws Error (output).
std::future<void> startSurfaceWriter(const RenderOptions& options, const PreparedScene& scene,
                                     Outputs& outputs) {
  if (!options.surface)
    return std::async(std::launch::deferred, [] {});
  return std::async([&options, &scene, &outputs] {
    const auto& clip = std::get<ClipDepth>(scene.clip());
    writeSurface(buildSurfaceMesh(clip, scene.domain(), surfaceTolerance(clip.camera)),
                 *options.surface, outputs);
  });
}

/// A warning for each existing file that belongs to an output but was not written now, such as an
/// old depth beside a `.nrrd` without depth. Call after the commit.
std::vector<std::string> findStaleFiles(const RenderOptions& options, const Outputs& outputs) {
  std::vector<std::string> warnings;
  std::error_code failed;
  for (const std::filesystem::path& path : options.outputs)
    for (const std::filesystem::path& file : listImageFiles(path))
      if (!outputs.writtenDigest(file) && std::filesystem::exists(file, failed))
        warnings.push_back(toOneLine(file.string()) + ": belongs to an earlier image than " +
                           toOneLine(path.filename().string()) + "; remove it");
  return warnings;
}

std::string formatPercent(double fraction) {
  return toString(100.0 * fraction, 2) + " %";
}

void printResult(const RenderOptions& options, const RenderResult& result,
                 const std::optional<double>& denoised, double seconds) {
  if (options.quiet)
    return;
  const auto files = join(options.outputs, ", ", [](const auto& path) { return path.string(); });
  const SampleCounts counts = result.film.sampleCounts();
  const double noise = result.film.noise();
  std::string line =
      concat(files, ": ", options.scene.width, "x", options.scene.height, " pixels, ",
             result.finishedSamples, result.finishedSamples == 1 ? " sample" : " samples");
  line += counts.min == counts.max ? " per pixel"
                                   : concat(" per pixel (", counts.min, " to ", counts.max, ")");
  if (denoised)
    line += concat(", noise ", formatPercent(*denoised), " (", formatPercent(noise),
                   " before denoising)");
  else if (noise < infinity)
    line += ", noise " + formatPercent(noise);
  line += ", " + toString(seconds, 3) + " s";
  if (result.reason == StopReason::request)
    line += options.checkpoint ? " (stopped on request; the same command resumes)"
                               : " (stopped on request)";
  printLine(line);
}

void warn(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings)
    printWarning(warning);
}

/// Writes the checkpoint file of a shard. Returns the exit status.
int finishShard(const RenderOptions& options, const RenderResult& result, Checkpoint& checkpoint,
                double seconds) {
  checkpoint.save(result);
  const bool isStopped = result.reason == StopReason::request;
  if (!options.quiet)
    printLine(concat(*options.checkpoint, ": shard ", formatShard(options.settings.shard), " of ",
                     options.scene.width, "x", options.scene.height, " pixels, ",
                     result.finishedSamples, result.finishedSamples == 1 ? " sample" : " samples",
                     " per pixel, ", toString(seconds, 3), " s",
                     isStopped ? " (stopped on request; the same command resumes)" : ""));
  return isStopped ? stopStatus() : 0;
}

/// True for `--device list`, which needs no input.
bool hasDeviceList(const std::vector<std::string>& arguments) {
  const auto option = std::ranges::find(arguments, "--device");
  return std::ranges::find(arguments, "--device=list") != arguments.end() ||
         (option != arguments.end() && option + 1 != arguments.end() && option[1] == "list");
}

std::string listDevices() {
  std::string text;
  for (const GpuInfo& gpu : listGpus())
    text += concat(gpu.name, gpu.isUsed ? "" : " (not used: software)", "\n");
  return text.empty() ? "no GPU found\n" : text;
}

/// Measures the focus, unless a stop was requested, and writes options.stats, if set.
void writeStats(const RenderOptions& options, const PreparedScene& scene,
                const RenderResult& result, const Stopwatch& total, RenderMonitor& monitor,
                RenderStats& stats, Outputs& outputs) {
  if (!options.stats)
    return;
  const Stopwatch watch;
  const std::vector<double>& depth = scene.clipResult().focusDepth;
  if (!depth.empty() && !monitor.stop) // a stop must not wait for measures
    stats.focus = measureFocus(scene.view(), scene.minMaxGrid(), *scene.focus(), depth,
                               options.settings.seed, monitor.stop);
  stats.measure = watch.seconds();
  stats.total = total.seconds();
  outputs.write(*options.stats, makeStatsJson(stats, options, scene, result));
}

/// Renders, resuming from the checkpoint if there is one, and saves checkpoints.
RenderResult renderFilm(const RenderOptions& options, const PreparedScene& scene,
                        std::optional<Checkpoint>& checkpoint, RenderMonitor& monitor,
                        const ShareRender& share, RenderStats& stats) {
  RenderSettings settings = makeSettings(options, scene.background());
  if (options.device == DeviceChoice::gpu)
    if (const auto obstacle = findGpuObstacle(scene.view()))
      warn({concat("--device gpu: ", *obstacle, "; the CPU renders")});
  std::optional<RenderResult> begun;
  if (checkpoint) {
    begun = checkpoint->load(scene, settings);
    checkpoint->attach(monitor);
  }
  if (begun)
    stats.checkpointPaths = begun->counters.paths;
  if (share)
    share(options, scene, settings, monitor);
  RenderResult result = [&] {
    const Progress progress(options, settings, monitor);
    return render(scene.view(), settings, monitor, std::move(begun));
  }();
  if (options.checkpoint && !options.isShard)
    checkpoint->trySave(result);
  return result;
}

} // namespace

int renderScene(const RenderJob& job, const std::vector<std::string>& arguments,
                std::optional<Checkpoint>& checkpoint, Outputs& outputs, const ShareRender& share) {
  const RenderOptions& options = job.options;
  const Stopwatch total;
  const PreparedScene scene(options.scene, job.input);
  outputs.checkInputs(); // now including files that the scene refers to
  requireScale(options, scene.camera().pose().projection);
  warn(composeMessages(scene.warnings()));
  if (options.verbose)
    printFacts(scene);

  RenderMonitor monitor;
  const DeferredStop stopInstead(monitor.stop);
  std::future<void> surface = startSurfaceWriter(options, scene, outputs);
  Stopwatch watch;
  RenderStats stats;
  ImageDenoiser filter(scene);
  filter.attach(monitor);
  const RenderResult result = renderFilm(options, scene, checkpoint, monitor, share, stats);
  stats.transport = watch.seconds();
  surface.get();
  if (options.isShard)
    return finishShard(options, result, *checkpoint, total.seconds());
  if (result.finishedSamples == 0) {
    printLine("fenestra: stopped on request before the first pass; no image was written");
    return stopStatus();
  }
  watch.lap();
  const std::optional<FilteredImage> filtered = filter.apply(result);
  stats.filtered = denoisedNoise(filtered);
  stats.filter = watch.lap();
  writeImages(options, scene, result, filtered, arguments, outputs);
  outputs.commit();
  stats.write = watch.lap();
  stats.warnings = findStaleFiles(options, outputs);
  if (!result.gpuFailure.empty())
    stats.warnings.push_back(describeGpuFailure(result.gpuFailure));
  warn(stats.warnings);

  writeStats(options, scene, result, total, monitor, stats, outputs);
  if (options.returnValues)
    outputs.write(
        *options.returnValues,
        formatReturnValues({result.film.sampleCounts().mean,
                            stats.filtered.value_or(result.film.noise()), stats.transport}));
  outputs.commit();
  printResult(options, result, stats.filtered, total.seconds());
  return result.reason == StopReason::request ? stopStatus() : 0;
}

int renderCommand(int argc, char** argv, int first) {
  return runRender({}, argc, argv, first);
}

int runRender(const ShareRender& share, int argc, char** argv, int first) {
  if (std::find(argv + first, argv + argc, std::string_view("--xml")) != argv + argc) {
    allowClosedOutput();
    std::cout << makeSlicerXml(renderSyntax) << std::flush;
    return 0;
  }
  if (hasDeviceList({argv + first, argv + argc})) {
    allowClosedOutput();
    std::cout << listDevices() << std::flush;
    return 0;
  }
  const std::optional<OptionValues> given = parseCommandLine(renderSyntax, argc, argv, first);
  if (!given)
    return 0;
  if (given->has("returnparameterfile"))
    printLinesToOutput();
  configureMachine(*given);
  RenderJob job = makeRenderJob(*given);
  if (given->has("echo"))
    std::cout << job.values.echo() << std::flush;
  std::optional<Checkpoint> checkpoint;
  if (job.options.checkpoint)
    checkpoint.emplace(job, *given, printWarning);
  Outputs outputs;
  declareOutputs(job.options, outputs);
  checkMemory(job.options.scene);
  return renderScene(job, {argv + 1, argv + argc}, checkpoint, outputs, share);
}

} // namespace fenestra::core
