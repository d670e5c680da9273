// Time from a change to the first new sample, which the user of a preview waits for all day.
//
//     ChangeBenchmark FOCUS ARGUMENTS...     (FOCUS: the changed focus, or coloured segment;
//                                             ARGUMENTS: of `fenestra`)

#include "base/Error.h"
#include "base/Stopwatch.h"
#include "program/CommandLine.h"
#include "program/RenderFlags.h"
#include "session/Scene.h"

#include <functional>
#include <iomanip>
#include <iostream>
#include <vector>

namespace fenestra {
namespace {

struct Change {
  const char* name;
  std::function<void(SceneRequest&)> apply;
};

std::string text(const StagesMade& made) {
  const std::pair<const char*, bool> stages[] = {
      {"volume", made.volume}, {"focus", made.focus},         {"transfer function", made.transfer},
      {"camera", made.camera}, {"lights", made.lights},       {"clip", made.clip},
      {"ranges", made.ranges}, {"majorants", made.majorants}, {"materials", made.tint}};
  std::string list;
  for (const auto& [name, isMade] : stages)
    if (isMade)
      list.append(list.empty() ? "" : ", ").append(name);
  return list;
}

/// Seconds for one sample in every pixel.
double firstSample(const Scene& scene, RenderSettings settings) {
  settings.samples = 1;
  settings.noise = -1.0;
  RenderMonitor monitor;
  const Stopwatch watch;
  render(scene.forRender(), settings, monitor);
  return watch.seconds();
}

void measure(const std::string& otherFocus, const RenderOptions& options) {
  std::vector<Change> changes = {
      {"nothing, from the start", [](SceneRequest&) {}},
      {"camera", [](SceneRequest& r) { r.view.name = "left"; }},
      {"focus", [&](SceneRequest& r) { r.focus = {otherFocus}; }},
      {"clip", [](SceneRequest& r) { r.clip.mode = ClipMode::cutaway; }},
      {"transfer function", [](SceneRequest& r) { r.density *= 2.0; }},
      {"lights", [](SceneRequest& r) { r.environment = Rgb(1.0, 1.0, 1.0); }}};
  if (options.scene.materials.value_or(noMaterials) != noMaterials)
    changes.push_back({"a segment's colour", [&](SceneRequest& r) {
                         r.materialChanges.push_back(otherFocus + ": color=#3060c0");
                       }});
  std::cout << "| change | made anew | seconds | and with the first sample |\n|---|---|---|---|\n"
            << std::fixed << std::setprecision(3);
  const Scene before(options.scene);
  for (const Change& change : changes) {
    SceneRequest request = options.scene;
    change.apply(request);
    const Stopwatch watch;
    const Scene scene = &change == &changes.front() ? Scene(request) : before.changed(request);
    const double made = watch.seconds();
    std::cout << "| " << change.name << " | " << text(scene.made()) << " | " << made << " | "
              << made + firstSample(scene, options.settings) << " |\n";
  }
}

} // namespace
} // namespace fenestra

int main(int argc, char** argv) {
  try {
    if (argc < 3)
      throw fenestra::usageError("usage: ChangeBenchmark FOCUS ARGUMENTS...");
    if (const auto flags = fenestra::parseCommandLine(fenestra::renderSyntax, argc, argv, 2))
      fenestra::measure(argv[1], fenestra::renderOptions(*flags));
    return 0;
  } catch (const fenestra::Error& error) {
    std::cerr << "ChangeBenchmark: " << error.what() << '\n';
    return error.exitStatus();
  }
}
