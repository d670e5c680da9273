// Error against time over scenes and modes (see README.md in this folder).

#include "Program.h"
#include "Report.h"

#include "base/Error.h"
#include "program/CommandLine.h"

#include <algorithm>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <thread>

namespace fenestra::benchmarks {
namespace {

constexpr const char* group = "Benchmark";
const Option optionTable[] = {
    {"scenes", "A,B,...", group, "Scenes of the table [all]"},
    {"modes", "A,B,...", group, "Render modes of Modes.cxx [all]"},
    {"budget", "SECONDS", group, "CPU time per curve [60]", ValueSpec::number(1e-3, 1e6)},
    {"seeds", "N", group, "Maximum renders per point, within the budget [3]",
     ValueSpec::integer(1, 1000)},
    {"threads", "K", group, "Threads per render [all]", ValueSpec::integer(1, 1024)},
    {"size", "WxH", group, "Image size in pixels [from the table]"},
    {"noise", "E", group, "Noise target of new references [0.03]", ValueSpec::number(1e-4, 1.0)},
    {"limit", "SECONDS", group, "Time limit of a new reference [1800]",
     ValueSpec::number(1e-3, 1e6)},
    {"references", "DIR", group, "Cache of references [benchmarks/references of the build]"},
    {"phantoms", "DIR", group, "Folder of the phantoms [benchmarks of the build]"},
    {"table", "FILE", group, "Table of scenes [scenes.txt of the source tree]"},
    {"output", "DIR", group,
     "Report folder; results of other scenes and modes in it are kept [benchmarks/report of "
     "the build]"},
};

const CommandSyntax syntax = {
    "EfficiencyBenchmark", "Measures relMSE against CPU seconds.", {}, optionTable};

struct Options {
  std::vector<SceneCase> table;
  std::vector<std::string> scenes;
  std::vector<const Mode*> modes;
  CurveSettings curve;
  ReferenceSettings reference;
  int threads = 0;
  std::optional<std::pair<int, int>> size;
  std::filesystem::path output;
};

/// Width and height from --size.
std::optional<std::pair<int, int>> parseSize(const OptionValues& values) {
  const auto text = values.text("size");
  if (!text)
    return std::nullopt;
  int width = 0, height = 0;
  if (std::sscanf(text->c_str(), "%dx%d", &width, &height) != 2 || width < 1 || height < 1)
    throw usageError("--size: expected WIDTHxHEIGHT in pixels, got '" + *text + "'");
  return std::pair(width, height);
}

Options parseOptions(const OptionValues& values) {
  const std::filesystem::path build = FENESTRA_BENCHMARK_FOLDER;
  const auto folder = [&](const char* name, const std::filesystem::path& otherwise) {
    return std::filesystem::path(values.text(name).value_or(otherwise.string()));
  };
  Options options;
  options.table = readScenes(folder("table", FENESTRA_BENCHMARK_TABLE),
                             {FENESTRA_REFERENCE, FENESTRA_DATA, folder("phantoms", build)});
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
  options.reference.seconds = values.number("limit").value_or(options.reference.seconds);
  options.reference.folder = folder("references", build / "references");
  options.threads = static_cast<int>(values.integer("threads").value_or(0));
  options.size = parseSize(values);
  options.output = folder("output", build / "report");
  return options;
}

std::vector<CurveRecord> measureScene(const SceneCase& sceneCase, const Options& options) {
  if (!sceneCase.missing.empty()) {
    std::cerr << sceneCase.name << ": not present: " << sceneCase.missing << std::endl;
    return {{sceneCase.name, "", "", 0.0}};
  }
  RenderOptions wanted = sceneCase.options();
  if (options.size)
    std::tie(wanted.scene.width, wanted.scene.height) = *options.size;
  const PreparedScene scene(wanted.scene);
  RenderSettings settings = makeSettings(wanted, scene.background());
  settings.threads = options.threads;
  const Reference reference = getOrRenderReference(sceneCase, scene, settings, options.reference);
  std::vector<CurveRecord> curves;
  for (const Mode* mode : options.modes) {
    curves.push_back({sceneCase.name, mode->name, reference.source, reference.relMse,
                      measureCurve(*mode, scene, settings, reference.image, options.curve)});
    const Point& last = curves.back().points.back();
    std::cout << std::setprecision(3) << sceneCase.name << ", " << mode->name << ": "
              << last.samples << " samples, " << last.cpuSeconds << " CPU s, relMSE " << last.relMse
              << ", bias " << 100.0 * last.bias << " ± " << 100.0 * last.biasError << " %"
              << std::endl;
  }
  return curves;
}

std::string processorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name"))
      return line.substr(line.find(':') + 2);
  return "an unknown CPU";
}

std::string makeNotes(const Options& options) {
  std::ostringstream out;
  out << "Last run on " << processorName() << ", " << std::thread::hardware_concurrency()
      << " threads, with " << options.curve.budget << " CPU seconds per curve and up to "
      << options.curve.seeds << " seeds per point.";
  return out.str();
}

int benchmark(int argc, char** argv) {
  const std::optional<OptionValues> values = parseCommandLine(syntax, argc, argv, 1);
  if (!values)
    return 0;
  const Options options = parseOptions(*values);
  std::vector<std::string> names;
  for (const SceneCase& scene : options.table)
    names.push_back(scene.name);
  for (const SceneCase& scene : options.table) {
    if (!options.scenes.empty() &&
        std::ranges::find(options.scenes, scene.name) == options.scenes.end())
      continue;
    // Written after each scene, so that an interrupted run keeps its finished scenes.
    writeReport(options.output,
                mergeCurves(readCurves(options.output), measureScene(scene, options), names),
                makeNotes(options));
  }
  std::cout << (options.output / "README.md").string() << std::endl;
  return 0;
}

} // namespace
} // namespace fenestra::benchmarks

int main(int argc, char** argv) {
  using namespace fenestra::benchmarks;
  return runBenchmark("EfficiencyBenchmark", benchmark, argc, argv);
}
