#include "program/TurntableFrames.h"

#include "base/Error.h"
#include "files/pictures/ImageWriter.h"
#include "model/camera/Turn.h"

#include <cstdio>

namespace fenestra {
namespace {

constexpr const char* turntableGroup = "Turntable";

const Flag ownFlags[] = {
    {"frames", "N", turntableGroup, "Pictures, 1 to 10000",
     Takes::whole(1, mostFrames).shows("36")},
    {"degrees", "D", turntableGroup, "How far the eye goes around; frame i of N stands at i D / N",
     Takes::number(-36000.0, 36000.0).shows("360")},
    {"steady", "DEGREES", turntableGroup,
     "Spreads what the clipping surface does suddenly, away from the focus, over so far to both "
     "sides; 0: every frame as render makes it [twice from frame to frame, 10 at most]",
     Takes::number(0.0, 45.0)},
    {"restart", "", turntableGroup,
     "Begin anew, in place of another turntable's frames of these names"},
};

} // namespace

const CommandSyntax& turntableSyntax() {
  static const std::vector<Flag> flags = [] {
    std::vector<Flag> all(std::begin(ownFlags), std::end(ownFlags));
    all.insert(all.end(), renderSyntax.flags.begin(), renderSyntax.flags.end());
    return all;
  }();
  static const CommandSyntax syntax = {
      "turntable",
      "Renders what the eye sees while it goes around its target, about the axis that is up: "
      "--output turn.png gives turn_0000.png, turn_0001.png and so on, each as fenestra render "
      "makes it. Beside them turn.turntable.json records what is finished: the same command goes "
      "on where it was stopped. Takes all flags of fenestra render but --surface; --samples, "
      "--seconds and --noise are for a frame, --stats for all of them.",
      renderSyntax.positionals,
      flags,
  };
  return syntax;
}

TurntableOptions turntableOptions(const PresetFlags& given) {
  const FlagValues& flags = given.flags;
  for (const char* name : {"surface", "returnparameterfile", "xml", "echo"})
    if (flags.has(name))
      throw usageError(std::string("--") + name +
                       ": is for a single picture; use it with fenestra render, or drop it");
  TurntableOptions options{renderOptions(given)};
  options.render.scene.measure = false; // the statistics cover all frames
  options.frames = static_cast<int>(flags.count("frames").value_or(36));
  options.degrees = flags.number("degrees").value_or(options.degrees);
  const double usual = std::min(10.0, 2.0 * std::abs(options.angle(1)));
  options.render.scene.steadyDegrees = flags.number("steady").value_or(usual);
  options.restart = flags.has("restart");
  return options;
}

std::filesystem::path framePath(const std::filesystem::path& output, int frame) {
  char number[16];
  std::snprintf(number, sizeof number, "_%04d", frame);
  std::filesystem::path path = output;
  return path.replace_filename(output.stem().string() + number + output.extension().string());
}

std::filesystem::path recordPath(const std::filesystem::path& output) {
  std::filesystem::path path = output;
  return path.replace_filename(output.stem().string() + ".turntable.json");
}

RenderOptions frameOptions(const TurntableOptions& options, int frame) {
  RenderOptions result = options.render;
  for (std::filesystem::path& output : result.outputs)
    output = framePath(output, frame);
  return result;
}

std::vector<std::filesystem::path> frameFiles(const TurntableOptions& options, int frame) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& output : frameOptions(options, frame).outputs)
    for (const std::filesystem::path& file : imageFiles(output))
      files.push_back(file);
  return files;
}

SceneRequest turnedRequest(const SceneRequest& request, const CameraPose& start, double degrees) {
  const CameraPose pose = turnedAroundTarget(start, degrees);
  SceneRequest turned = request;
  turned.view = {.projection = pose.projection,
                 .position = pose.position,
                 .target = pose.target,
                 .up = pose.up};
  if (pose.projection == Projection::perspective)
    turned.view.angle = pose.angle;
  else
    turned.view.scale = pose.scale;
  return turned;
}

} // namespace fenestra
