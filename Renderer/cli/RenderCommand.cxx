#include "cli/Commands.h"

#include "cli/CommandLine.h"
#include "cli/OutputFiles.h"
#include "cli/Progress.h"
#include "cli/RenderFlags.h"
#include "cli/Stats.h"
#include "cli/Stop.h"
#include "cli/Version.h"
#include "core/Error.h"
#include "io/AtomicFile.h"
#include "io/pictures/ImageWriter.h"
#include "scene/Scene.h"
#include "tracking/WideTracker.h"

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <iostream>
#include <sstream>
#include <unistd.h>

namespace fenestra {
namespace {

/// As a shell takes it back.
std::string quoted(const std::string& argument) {
  const char* const plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  if (!argument.empty() && argument.find_first_not_of(plain) == std::string::npos)
    return argument;
  std::string result(1, '\'');
  for (const char c : argument)
    if (c == '\'')
      result += "'\\''";
    else
      result += c;
  result += '\'';
  return result;
}

std::string commandLine(int argc, char** argv) {
  std::string line = "fenestra";
  for (int i = 1; i < argc; ++i)
    line.append(" ").append(quoted(argv[i]));
  return line;
}

std::string text(const Vec3& v) {
  std::ostringstream out;
  out.precision(17);
  out << v.x() << ',' << v.y() << ',' << v.z();
  return out.str();
}

std::map<std::string, std::string> header(const Scene& scene, const RenderSettings& settings,
                                          const RenderResult& result, const std::string& command) {
  const CameraPose& pose = scene.camera().pose();
  const bool perspective = pose.projection == Projection::perspective;
  std::ostringstream camera;
  camera.precision(17);
  camera << (perspective ? "--projection perspective --angle "
                         : "--projection orthographic --scale ")
         << (perspective ? pose.angle : pose.scale) << " --position=" << text(pose.position)
         << " --target=" << text(pose.target) << " --up=" << text(pose.up);
  return {{"version", versionText},
          {"target", processorText + ("-" + result.target)},
          {"seed", std::to_string(settings.seed)},
          {"samples", std::to_string(result.finishedSamples)},
          {"camera", camera.str()},
          {"look", scene.look()},
          {"command", command}};
}

/// Fails before the long work, not after it.
void checkOutputs(const RenderOptions& options) {
  std::vector<std::filesystem::path> results;
  for (const std::filesystem::path& path : options.outputs)
    for (const std::filesystem::path& file : imageFiles(path))
      results.push_back(file);
  if (options.stats)
    results.push_back(*options.stats);
  checkDistinct(options.inputs, results);
  for (const std::filesystem::path& path : options.outputs)
    checkImagePath(path);
  if (options.stats)
    checkWritable(*options.stats);
}

/// Linux grants memory that it does not have, and ends the process when it is used.
void checkMemory(const SceneRequest& scene) {
  constexpr double bytesPerPixel = 2.0 * sizeof(PixelSums); // the film, and its channels as written
  constexpr double gigabyte = 1e9;
  const double needed = bytesPerPixel * scene.width * scene.height;
  const double there =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  if (needed <= there)
    return;
  std::ostringstream line;
  line.precision(3);
  line << "a picture of " << scene.width << "x" << scene.height << " pixels takes "
       << needed / gigabyte << " GB of memory, this machine has " << there / gigabyte
       << "; choose a smaller one";
  throw outputError("--size", line.str());
}

std::size_t threadCount(const RenderSettings& settings) {
  const auto cores = static_cast<std::size_t>(tbb::info::default_concurrency());
  return settings.threads > 0 ? std::min(static_cast<std::size_t>(settings.threads), cores) : cores;
}

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
  const std::optional<FlagValues> flags = parseCommandLine(renderSyntax, argc, argv, first);
  if (!flags)
    return 0;
  const RenderOptions options = renderOptions(*flags);
  if (const char* pinned = std::getenv("FENESTRA_INSTRUCTIONS"))
    WideTracker::useInstructionSet(pinned);
  RenderMonitor monitor;
  StopOnSignal stopOnSignal;
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    threadCount(options.settings));
  checkOutputs(options);
  checkMemory(options.scene);

  const Stopwatch total;
  RenderStats stats;
  const Scene scene(options.scene);
  for (const std::string& warning : scene.warnings())
    std::cerr << "fenestra: warning: " << warning << '\n';

  stopOnSignal.setInstead(monitor.stop);
  const Stopwatch transport;
  const RenderResult result = renderWithProgress(scene, options, monitor);
  stats.transport = transport.seconds();
  if (result.finishedSamples == 0) {
    std::cerr << "fenestra: stopped on request before the first pass; nothing was written\n";
    return stoppedStatus;
  }

  if (options.stats && !scene.focusDepth().empty()) {
    const Stopwatch focus;
    stats.focusCoverage =
        focusCoverage(scene.forRender(), scene.focusDepth(), options.settings.seed);
    stats.stages.focus = focus.seconds();
  }
  const Stopwatch write;
  Image image = picture(result.film, scene.camera(), scene.clip(), options.layers);
  image.header = header(scene, options.settings, result, commandLine(argc, argv));
  for (const std::filesystem::path& path : options.outputs)
    writeImage(image, picturePlane(scene.camera()), path);
  if (options.stats) {
    const double coverageSeconds = stats.stages.focus;
    stats.stages = scene.seconds();
    stats.stages.focus += coverageSeconds;
    stats.mismatch = scene.mismatch();
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
  report(options, result, total.seconds());
  return result.reason == StopReason::request ? stoppedStatus : 0;
}

} // namespace fenestra
