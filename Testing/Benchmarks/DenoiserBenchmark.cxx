// Gain and cost of the denoiser, and accuracy of its error estimate, over scenes and sample counts
// (see README.md in this folder). Prints CSV.

#include "Program.h"
#include "References.h"
#include "denoise/features/Denoising.h"
#include "image/Compare.h"
#include "program/CommandLine.h"
#include "program/UsageError.h"
#include "scene/PreparedScene.h"

#include <algorithm>
#include <charconv>
#include <iomanip>
#include <iostream>

namespace fenestra::core::benchmarks {
namespace {

constexpr const char* group = "Benchmark";
const Option optionTable[] = {
    {"scenes", "A,B,...", group, "Scenes of the table [all]"},
    {"counts", "N,...", group, "Samples per pixel [1,2,4,8,16,64,1024]"},
    {"seeds", "N", group, "Renders per count below 1024 [3]", ValueSpec::integer(1, 1000)},
    {"referencesamples", "N", group, "Samples per pixel of new references [1024]",
     ValueSpec::integer(16, 1 << 20)},
    {"references", "DIR", group, "Cache of references [benchmarks/filter of the build]"},
    {"phantoms", "DIR", group, "Folder of the phantoms [benchmarks of the build]"},
    {"table", "FILE", group, "Table of scenes [denoiser-scenes.txt of the source tree]"},
};

const CommandSyntax syntax = {
    "DenoiserBenchmark", "Compares denoised images with references.", {}, optionTable};

/// Runs some work; returns its result and its CPU seconds.
template <typename Work>
auto timeWork(const Work& work, double& seconds) {
  const double before = cpuSeconds();
  auto result = work();
  seconds = cpuSeconds() - before;
  return result;
}

/// Means over the seeds of one sample count.
struct Row {
  double raw = 0.0, filtered = 0.0;  ///< relMSE
  double estimated = 0.0;            ///< relMSE as estimated by the denoiser
  double render = 0.0, filter = 0.0; ///< CPU seconds

  void add(const Row& other, double weight) {
    raw += weight * other.raw;
    filtered += weight * other.filtered;
    estimated += weight * other.estimated;
    render += weight * other.render;
    filter += weight * other.filter;
  }
};

Row measureRender(const PreparedScene& scene, const RenderSettings& settings,
                  const Image& reference) {
  Row row;
  const Film film = timeWork(
      [&] {
        RenderMonitor monitor;
        return render(scene.view(), settings, monitor).film;
      },
      row.render);
  const FilteredImage denoised =
      timeWork([&] { return denoise(film, scene.view(), *scene.features()); }, row.filter);
  row.raw = compareImages(toImage(film, scene), reference).relMse;
  row.filtered =
      compareImages(makeFilteredImage(denoised, film.width(), film.height()), reference).relMse;
  row.estimated = denoised.estimatedError;
  return row;
}

void print(const std::string& scene, std::uint64_t samples, const Row& row, double featureSeconds) {
  const double efficiency =
      row.raw * row.render / (row.filtered * (row.render + row.filter + featureSeconds));
  std::cout << std::setprecision(3) << scene << ',' << samples << ',' << row.raw << ','
            << row.filtered << ',' << row.raw / row.filtered << ',';
  if (row.estimated > 0.0)
    std::cout << row.estimated / row.filtered;
  std::cout << ',' << efficiency << ',' << row.render << ',' << featureSeconds << ',' << row.filter
            << std::endl;
}

/// Throws Error (usage).
std::uint64_t parseCount(const std::string& text) {
  std::uint64_t count = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (failed != std::errc() || end != text.data() + text.size() || count == 0)
    throw usageError("--counts: expected positive integers, got '" + text + "'");
  return count;
}

std::vector<std::uint64_t> parseCounts(const OptionValues& values) {
  std::vector<std::uint64_t> counts;
  for (const std::string& text : values.list("counts"))
    counts.push_back(parseCount(text));
  return counts.empty() ? std::vector<std::uint64_t>{1, 2, 4, 8, 16, 64, 1024} : counts;
}

void measureScene(const SceneCase& sceneCase, const OptionValues& values,
                  const ReferenceSettings& wanted) {
  if (!sceneCase.missing.empty()) {
    std::cerr << sceneCase.name << ": not present: " << sceneCase.missing << std::endl;
    return;
  }
  RenderOptions options = sceneCase.options();
  options.scene.features = true;
  const PreparedScene scene(options.scene);
  RenderSettings settings = makeSettings(options, scene.background());
  const Reference reference = getOrRenderReference(sceneCase, scene, settings, wanted);
  double featureSeconds = 0.0;
  timeWork([&] { return computeFeatures(scene.view()); }, featureSeconds);
  for (const std::uint64_t count : parseCounts(values)) {
    settings.samples = count;
    const std::uint64_t seeds = count < 1024 ? values.integer("seeds").value_or(3) : 1;
    Row mean;
    for (settings.seed = 1; settings.seed <= seeds; ++settings.seed)
      mean.add(measureRender(scene, settings, reference.image), 1.0 / static_cast<double>(seeds));
    print(sceneCase.name, count, mean, featureSeconds);
  }
}

int benchmark(int argc, char** argv) {
  const std::optional<OptionValues> values = parseCommandLine(syntax, argc, argv, 1);
  if (!values)
    return 0;
  const ReferenceSettings wanted{
      .folder = values->text("references").value_or(FENESTRA_BENCHMARK_FOLDER "/filter"),
      .samples = values->integer("referencesamples").value_or(1024)};
  const std::vector<std::string> scenes = values->list("scenes");
  std::cout << "scene,samples,relmse_raw,relmse_denoised,gain,estimated_over_true_error,"
               "efficiency_gain,render_cpu_seconds,features_cpu_seconds,denoise_cpu_seconds"
            << std::endl;
  for (const SceneCase& scene : readScenes(values->text("table").value_or(FENESTRA_DENOISER_TABLE),
                                           findFolders(values->text("phantoms"))))
    if (scenes.empty() || std::ranges::find(scenes, scene.name) != scenes.end())
      measureScene(scene, *values, wanted);
  return 0;
}

} // namespace
} // namespace fenestra::core::benchmarks

int main(int argc, char** argv) {
  using namespace fenestra::core::benchmarks;
  return runBenchmark("DenoiserBenchmark", benchmark, argc, argv);
}
