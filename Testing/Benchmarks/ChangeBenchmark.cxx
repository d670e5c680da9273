// Time from a change to the first new sample: the latency of an interactive preview.
//
//     ChangeBenchmark FOCUS ARGUMENTS...     (FOCUS: the new focus, or the recolored segment;
//                                             ARGUMENTS: of `fenestra`); prints CSV

#include "base/Stopwatch.h"
#include "program/CommandLine.h"
#include "program/ErrorAdvice.h"
#include "program/RenderOptions.h"
#include "program/UsageError.h"
#include "scene/PreparedScene.h"

#include <functional>
#include <iomanip>
#include <iostream>
#include <vector>

namespace fenestra::core {
namespace {

struct Change {
  const char* name;
  std::function<void(RenderRequest&)> apply;
};

std::string listStages(const UpdatedStages& updated) {
  const std::pair<const char*, bool> stages[] = {{"volume", updated.volume},
                                                 {"focus", updated.focus},
                                                 {"transfer function", updated.transfer},
                                                 {"camera", updated.camera},
                                                 {"lights", updated.lights},
                                                 {"clip", updated.clip},
                                                 {"ranges", updated.minMaxGrid},
                                                 {"majorants", updated.majorants},
                                                 {"label weights", updated.labelWeights},
                                                 {"colors", updated.tint}};
  std::string list;
  for (const auto& [name, isUpdated] : stages)
    if (isUpdated)
      list.append(list.empty() ? "" : "; ").append(name);
  return list;
}

/// Seconds for one sample per pixel.
double timeFirstSample(const PreparedScene& scene, RenderSettings settings) {
  settings.samples = 1;
  settings.noise = -1.0;
  RenderMonitor monitor;
  const Stopwatch watch;
  render(scene.view(), settings, monitor);
  return watch.seconds();
}

/// Prepares a scene, prints the row of this change, and returns the scene.
PreparedScene printChange(const char* change, const RenderSettings& settings,
                          const std::function<PreparedScene()>& prepare) {
  const Stopwatch watch;
  PreparedScene scene = prepare();
  const double seconds = watch.seconds();
  std::cout << change << ',' << listStages(scene.updatedStages()) << ',' << seconds << ','
            << seconds + timeFirstSample(scene, settings) << '\n';
  return scene;
}

void measure(const std::string& other, const RenderOptions& options) {
  const Change changes[] = {
      {"camera", [](RenderRequest& r) { r.view.name = "left"; }},
      {"focus", [&](RenderRequest& r) { r.focus = {other}; }},
      {"clip", [](RenderRequest& r) { r.clip.mode = ClipMode::cutaway; }},
      {"transfer function", [](RenderRequest& r) { r.density *= 2.0; }},
      {"lights", [](RenderRequest& r) { r.environment = Rgb(1.0, 1.0, 1.0); }}};
  std::cout << "change,recomputed,seconds,seconds_with_first_sample\n"
            << std::fixed << std::setprecision(3);
  const RenderSettings& settings = options.settings;
  const PreparedScene before =
      printChange("none (initial scene)", settings, [&] { return PreparedScene(options.scene); });
  for (const Change& change : changes) {
    RenderRequest request = options.scene;
    change.apply(request);
    printChange(change.name, settings, [&] { return before.withRequest(request); });
  }
  if (!before.tint() && !before.mixture())
    return;
  const auto colored = [&](const char* color) {
    RenderRequest request = options.scene;
    request.materialChanges.push_back(other + ": color=" + color);
    return request;
  };
  const PreparedScene blue = printChange("first color of a segment", settings,
                                         [&] { return before.withRequest(colored("#3060c0")); });
  printChange("next color of the segment", settings,
              [&] { return blue.withRequest(colored("#c06030")); });
}

} // namespace
} // namespace fenestra::core

int main(int argc, char** argv) {
  try {
    if (argc < 3)
      throw fenestra::core::usageError("usage: ChangeBenchmark FOCUS ARGUMENTS...");
    if (const auto values =
            fenestra::core::parseCommandLine(fenestra::core::renderSyntax, argc, argv, 2))
      fenestra::core::measure(argv[1], fenestra::core::makeRenderOptions(*values));
    return 0;
  } catch (const fenestra::core::Error& error) {
    std::cerr << "ChangeBenchmark: " << error.what() << '\n';
    return exitStatus(error.kind());
  }
}
