// Error against time over scenes and modes (see README.md in this folder). Prints CSV, one row per
// curve, and the points of the curves on standard error.

#include "Curve.h"
#include "Program.h"

#include "program/CommandLine.h"
#include "program/UsageError.h"

#include <algorithm>
#include <iomanip>
#include <iostream>

namespace fenestra::core::benchmarks {
namespace {

constexpr const char* group = "Benchmark";
const Option optionTable[] = {
    {"scenes", "A,B,...", group, "Scenes of the table [all]"},
    {"modes", "A,B,...", group, "Render modes of Modes.cxx [all]"},
    {"budget", "SECONDS", group, "CPU time per curve [60]", ValueSpec::number(1e-3, 1e6)},
    {"seeds", "N", group, "Maximum renders per point, within the budget [3]",
     ValueSpec::integer(1, 1000)},
    {"threads", "K", group, "Threads per render [all]", ValueSpec::integer(1, 1024)},
    {"noise", "E", group, "Noise target of new references [0.03]", ValueSpec::number(1e-4, 1.0)},
    {"references", "DIR", group, "Cache of references [benchmarks/references of the build]"},
    {"phantoms", "DIR", group, "Folder of the phantoms [benchmarks of the build]"},
    {"table", "FILE", group, "Table of scenes [scenes.txt of the source tree]"},
};

const CommandSyntax syntax = {
    "EfficiencyBenchmark", "Measures relMSE against CPU seconds.", {}, optionTable};

constexpr double quotedRelMse = 1e-3; ///< at which efficiency is printed

struct Options {
  std::vector<SceneCase> table;
  std::vector<std::string> scenes;
  std::vector<const Mode*> modes;
  CurveSettings curve;
  ReferenceSettings reference;
  int threads = 0;
};

Options parseOptions(const OptionValues& values) {
  Options options;
  options.table = readScenes(values.text("table").value_or(FENESTRA_BENCHMARK_TABLE),
                             findFolders(values.text("phantoms")));
  options.scenes = values.list("scenes");
  for (const std::string& name : options.scenes)
    if (std::ranges::find(options.table, name, &SceneCase::name) == options.table.end())
      throw usageError("--scenes: '" + name + "' is not in the table of scenes");
  for (const std::string& name : values.list("modes"))
    options.modes.push_back(&findMode(name));
  if (options.modes.empty())
    for (const Mode& mode : modes())
      options.modes.push_back(&mode);
  options.curve.budget = values.number("budget").value_or(options.curve.budget);
  options.curve.seeds = static_cast<int>(values.integer("seeds").value_or(3));
  options.reference.noise = values.number("noise").value_or(options.reference.noise);
  options.reference.folder =
      values.text("references").value_or(FENESTRA_BENCHMARK_FOLDER "/references");
  options.threads = static_cast<int>(values.integer("threads").value_or(0));
  return options;
}

void printPoints(const std::string& name, const std::vector<Point>& curve) {
  for (const Point& point : curve)
    std::cerr << std::setprecision(3) << name << ": " << point.samples << " samples, "
              << point.seeds << " seeds, " << point.cpuSeconds << " CPU s, relMSE " << point.relMse
              << " ± " << point.spread << std::endl;
}

/// Bias: that of the point with the most samples.
void printRow(const std::string& scene, const Mode& mode, const Reference& reference,
              const std::vector<Point>& curve) {
  const std::optional<Efficiency> efficiency = findEfficiency(curve, quotedRelMse);
  const Point& last = curve.back();
  std::cout << std::setprecision(3) << scene << ',' << mode.name << ',' << reference.source << ','
            << reference.relMse << ',';
  if (efficiency)
    std::cout << efficiency->value << ',' << efficiency->relMse;
  else
    std::cout << ','; // no measurable error
  std::cout << ',' << last.samples << ',' << 100.0 * last.bias << ',' << 100.0 * last.biasError
            << std::endl;
}

void measureScene(const SceneCase& sceneCase, const Options& options) {
  if (!sceneCase.missing.empty()) {
    std::cerr << sceneCase.name << ": not present: " << sceneCase.missing << std::endl;
    return;
  }
  const RenderOptions wanted = sceneCase.options();
  const PreparedScene scene(wanted.scene);
  RenderSettings settings = makeSettings(wanted, scene.background());
  settings.threads = options.threads;
  const Reference reference = getOrRenderReference(sceneCase, scene, settings, options.reference);
  for (const Mode* mode : options.modes) {
    const std::vector<Point> curve =
        measureCurve(*mode, scene, settings, reference.image, options.curve);
    printPoints(sceneCase.name + ", " + mode->name, curve);
    printRow(sceneCase.name, *mode, reference, curve);
  }
}

int benchmark(int argc, char** argv) {
  const std::optional<OptionValues> values = parseCommandLine(syntax, argc, argv, 1);
  if (!values)
    return 0;
  const Options options = parseOptions(*values);
  std::cout << "scene,mode,reference,reference_relmse,efficiency,at_relmse,samples,bias_percent,"
               "bias_error_percent"
            << std::endl;
  for (const SceneCase& scene : options.table)
    if (options.scenes.empty() ||
        std::ranges::find(options.scenes, scene.name) != options.scenes.end())
      measureScene(scene, options);
  return 0;
}

} // namespace
} // namespace fenestra::core::benchmarks

int main(int argc, char** argv) {
  using namespace fenestra::core::benchmarks;
  return runBenchmark("EfficiencyBenchmark", benchmark, argc, argv);
}
