#include "program/TurntableOptions.h"

#include "base/Error.h"
#include "files/images/ImageWriter.h"

#include <cstdio>

namespace fenestra {
namespace {

constexpr const char* turntableGroup = "Turntable";

const Option turntableTable[] = {
    {"frames", "N", turntableGroup, "Pictures, 1 to 10000",
     ValueSpec::integer(1, maxFrames).withDefault("36")},
    {"degrees", "D", turntableGroup, "How far the eye goes around; frame i of N stands at i D / N",
     ValueSpec::number(-36000.0, 36000.0).withDefault("360")},
    {"steady", "DEGREES", turntableGroup,
     "Spreads what the clipping surface does suddenly, away from the focus, over so far to both "
     "sides; 0: every frame as render makes it [twice from frame to frame, 10 at most]",
     ValueSpec::number(0.0, 45.0)},
    {"restart", "", turntableGroup,
     "Begin anew, in place of another turntable's frames of these names"},
};

} // namespace

const CommandSyntax& turntableSyntax() {
  static const std::vector<Option> options = [] {
    std::vector<Option> all(std::begin(turntableTable), std::end(turntableTable));
    all.insert(all.end(), renderSyntax.options.begin(), renderSyntax.options.end());
    return all;
  }();
  static const CommandSyntax syntax = {
      "turntable",
      "Renders what the eye sees while it goes around its target, about the axis that is up: "
      "--output turn.png gives turn_0000.png, turn_0001.png and so on, each as fenestra render "
      "makes it. Beside them turn.turntable.json records what is finished: the same command goes "
      "on where it was stopped. --samples, --seconds and --noise are for a frame, --stats for all "
      "of them.",
      renderSyntax.positionals,
      options,
      {{{"surface", "returnparameterfile", "xml", "echo"},
        "is for a single picture; use it with fenestra render, or drop it"},
       {{"checkpoint"}, "a turntable records its frames by itself; drop it"}},
  };
  return syntax;
}

TurntableOptions makeTurntableOptions(const OptionValues& values, const RenderOptions& render) {
  TurntableOptions options{render};
  options.render.scene.measure = false; // the statistics cover all frames
  options.frames = static_cast<int>(values.integer("frames").value_or(36));
  options.degrees = values.number("degrees").value_or(options.degrees);
  const double usual = std::min(10.0, 2.0 * std::abs(options.angle(1)));
  options.render.scene.steadyDegrees = values.number("steady").value_or(usual);
  options.restart = values.has("restart");
  return options;
}

std::vector<std::filesystem::path> TurntableOptions::images(int frame) const {
  char number[16];
  std::snprintf(number, sizeof number, "_%04d", frame);
  std::vector<std::filesystem::path> images = render.outputs;
  for (std::filesystem::path& path : images)
    path.replace_filename(path.stem().string() + number + path.extension().string());
  return images;
}

std::vector<std::filesystem::path> TurntableOptions::files(int frame) const {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& picture : images(frame)) {
    const std::vector<std::filesystem::path> parts = listImageFiles(picture);
    files.push_back(parts.front());
    if (parts.size() == 1)
      continue;
    if (render.layers.contains("depth"))
      files.push_back(parts[1]);
    if (render.hasFilterLayer("denoised"))
      files.push_back(parts[2]);
  }
  return files;
}

std::filesystem::path manifestPath(const std::filesystem::path& output, const Shard& shard) {
  std::filesystem::path path = output;
  const std::string part =
      shard.isComplete() ? "" : concat(".", shard.index + 1, "of", shard.count);
  return path.replace_filename(output.stem().string() + part + ".turntable.json");
}

} // namespace fenestra
