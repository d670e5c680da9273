#include "program/TurntableOptions.h"

#include "base/Error.h"
#include "files/images/ImageWriter.h"

#include <cstdio>

namespace fenestra::core {
namespace {

constexpr const char* turntableGroup = "Turntable";

const Option turntableTable[] = {
    {"frames", "N", turntableGroup, "Number of frames, 1 to 10000",
     ValueSpec::integer(1, maxFrames).withDefault("36")},
    {"degrees", "D", turntableGroup, "Total rotation; frame i of N is at i D / N",
     ValueSpec::number(-36000.0, 36000.0).withDefault("360")},
    {"steady", "DEGREES", turntableGroup,
     "Temporal smoothing of the clipping surface away from the focus, over this many degrees "
     "before and after each frame; 0: off [twice the step between frames, at most 10]",
     ValueSpec::number(0.0, 45.0)},
    {"restart", "", turntableGroup,
     "Start over, replacing the frames of another turntable with these names"},
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
      "Renders a rotation of the camera around its target, about the up axis: --output turn.png "
      "gives turn_0000.png, turn_0001.png and so on, each as by fenestra render. The file "
      "turn.turntable.json records the finished frames, so that the same command resumes after a "
      "stop. --samples, --seconds and --noise are per frame; --stats-json covers all frames.",
      renderSyntax.positionals,
      options,
      {{{"surface", "returnparameterfile", "xml", "echo"},
        "only for a single image; use fenestra render, or omit it"},
       {{"checkpoint"}, "not needed, since a turntable resumes by itself; omit it"}},
      "Render a rotation as numbered frames",
      "turntable knee.mrml --focus FemoralCartilage -o turn.png",
  };
  return syntax;
}

TurntableOptions makeTurntableOptions(const OptionValues& values, const RenderOptions& render) {
  TurntableOptions options{render};
  options.render.scene.measure = false; // the statistics are of all frames
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
    if (render.layers.contains("depth50"))
      files.push_back(parts[3]);
  }
  return files;
}

std::filesystem::path manifestPath(const std::filesystem::path& output, const Shard& shard) {
  std::filesystem::path path = output;
  const std::string part =
      shard.isComplete() ? "" : concat(".", shard.index + 1, "of", shard.count);
  return path.replace_filename(output.stem().string() + part + ".turntable.json");
}

} // namespace fenestra::core
