#include "program/Pictures.h"

#include "base/Error.h"
#include "base/safe/Inputs.h"
#include "base/safe/ShownText.h"
#include "clip/mesh/SurfaceWriter.h"
#include "files/pictures/ImageWriter.h"
#include "program/FileNames.h"
#include "program/MergedFlags.h"
#include "program/Version.h"

#include <future>

#include <unistd.h>

namespace fenestra {
namespace {

/// Quotes an argument for a shell.
std::string quoted(const std::string& argument) {
  const char* const plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  if (!argument.empty() && argument.find_first_not_of(plain) == std::string::npos)
    return argument;
  return textOf("'", replacedAll(argument, "'", "'\\''"), "'");
}

/// Flags that reproduce the camera.
std::string cameraFlags(const CameraPose& pose) {
  constexpr int exact = 17; // significant digits
  const bool perspective = pose.projection == Projection::perspective;
  return textOf("--projection ", perspective ? "perspective --angle " : "orthographic --scale ",
                numberText(perspective ? pose.angle : pose.scale, exact),
                " --position=", numbersText(pose.position, ",", exact),
                " --target=", numbersText(pose.target, ",", exact),
                " --up=", numbersText(pose.up, ",", exact));
}

std::map<std::string, std::string> header(const Scene& scene, const RenderOptions& options,
                                          const RenderResult& result,
                                          const std::vector<std::string>& words) {
  const std::filesystem::path folder = options.outputs.front().parent_path();
  const std::vector<std::string> arguments = relativeArguments(words, renderSyntax.flags, folder);
  std::map<std::string, std::string> entries = {
      {"version", versionText},
      {"target", textOf(processorText, "-", result.target)},
      {"seed", textOf(options.settings.seed)},
      {"samples", textOf(result.finishedSamples)},
      {"camera", cameraFlags(scene.camera().pose())},
      {"look", relativeName(scene.look(), folder)},
      {"command", textOf("fenestra ", joined(arguments, " ", quoted))}};
  if (options.preset)
    entries["preset"] = relativeName(*options.preset, folder);
  return entries;
}

} // namespace

PictureRequest pictureRequest(const FlagValues& given) {
  const Input input(*given.text("INPUT"));
  const SceneFlags stored = withSceneFlags(given, input);
  const PresetFlags flags = withPreset(stored.flags, input);
  PictureRequest request{stored.flags, flags.flags, renderOptions(flags), input};
  request.options.scene.leftOut = stored.leftOut;
  return request;
}

void declareOutputs(const RenderOptions& options, Outputs& outputs) {
  for (const std::filesystem::path& input : options.inputs)
    expectInput(input);
  for (const std::filesystem::path& path : options.outputs)
    declareImage(path, outputs, options.outputsNamedBy);
  if (options.surface)
    declareSurface(*options.surface, outputs);
  for (const auto& file : {options.stats, options.returnValues})
    if (file)
      outputs.add(*file);
}

/// Compared with physical memory: Linux grants more, and ends the process when it is used.
void checkMemory(const SceneRequest& scene) {
  constexpr double bytesPerPixel = 2.0 * sizeof(PixelSums); // the film, and its channels as written
  constexpr double gigabyte = 1e9;
  const double needed = bytesPerPixel * scene.width * scene.height;
  const double there =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  if (needed <= there)
    return;
  throw outputError("--size", "a picture of ", scene.width, "x", scene.height, " pixels takes ",
                    numberText(needed / gigabyte, 3), " GB of memory, this machine has ",
                    numberText(there / gigabyte, 3), "; choose a smaller one");
}

void writePictures(const RenderOptions& options, const Scene& scene, const RenderResult& result,
                   const std::vector<std::string>& words, Outputs& outputs) {
  Image image = picture(result.film, scene.camera(), scene.clip(), options.layers);
  image.header = header(scene, options, result, words);
  // All files at once if threads are free: compressing one does not delay another.
  std::vector<std::future<void>> files;
  for (const std::filesystem::path& path : options.outputs)
    files.push_back(std::async([&image, &scene, &path, &outputs] {
      writeImage(image, picturePlane(scene.camera()), path, outputs);
    }));
  for (std::future<void>& file : files)
    file.get();
}

} // namespace fenestra
