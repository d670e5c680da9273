#include "program/RenderSteps.h"

#include "base/Error.h"
#include "clip/mesh/SurfaceWriter.h"
#include "files/images/ImageFormat.h"
#include "files/images/ImageWriter.h"
#include "io/InputRegistry.h"
#include "io/MessageText.h"
#include "program/FileNames.h"
#include "program/MergedOptions.h"
#include "program/Messages.h"
#include "program/ShellCommand.h"
#include "program/about/Version.h"

#include <algorithm>
#include <future>

namespace fenestra::core {
namespace {

/// Options that reproduce the camera.
std::string formatCamera(const CameraPose& pose) {
  constexpr int exact = 17; // significant digits
  const bool perspective = pose.projection == Projection::perspective;
  return concat("--projection ", perspective ? "perspective --angle " : "orthographic --scale ",
                toString(perspective ? pose.angle : pose.scale, exact),
                " --position=", joinNumbers(pose.position, ",", exact),
                " --target=", joinNumbers(pose.target, ",", exact),
                " --up=", joinNumbers(pose.up, ",", exact));
}

std::string describeFilter(const std::optional<FilteredImage>& filtered) {
  return describeDenoising(filtered) + "; --denoise off leaves the image raw";
}

std::map<std::string, std::string> makeHeader(const PreparedScene& scene,
                                              const RenderOptions& options,
                                              const RenderResult& result,
                                              const std::vector<std::string>& words) {
  const std::filesystem::path folder = options.outputs.front().parent_path();
  const std::vector<std::string> arguments =
      toRelativeArguments(words, renderSyntax.options, folder);
  std::map<std::string, std::string> entries = makeImageHeader(scene, options.settings, result);
  entries["version"] = versionText;
  entries["camera"] = formatCamera(scene.camera().pose());
  entries["target"] = concat(processorText, "-", result.target);
  entries["look"] = toRelativeName(scene.transferName(), folder);
  entries["command"] = concat("fenestra ", join(arguments, " ", quoteForShell));
  if (options.preset)
    entries["preset"] = toRelativeName(*options.preset, folder);
  return entries;
}

/// Adds the denoiser's channels that the layers include; R, G, B and A stay unchanged.
void addDenoisedChannels(const RenderOptions& options, const PreparedScene& scene,
                         const FilteredImage& filtered, Image& image) {
  if (options.hasFilterLayer("expected"))
    addExpected(image, *scene.features());
  if (!options.hasFilterLayer("denoised"))
    return;
  addDenoised(image, filtered);
  image.header["filter"] = concat("channels denoised.* are ", describeFilter(filtered),
                                  "; R, G, B and A are not denoised");
}

} // namespace

RenderJob makeRenderJob(const OptionValues& given) {
  const Input input(*given.text("INPUT"));
  const SceneOptions stored = mergeSceneOptions(given, input);
  const PresetOptions preset = mergePreset(stored.values, input);
  RenderJob job{stored.values, preset.values, makeRenderOptions(preset), input};
  for (const std::string& line : stored.ignored)
    job.options.scene.omissions.push_back({ErrorCode::ignoredRequest, "", line});
  return job;
}

void declareOutputs(const RenderOptions& options, Outputs& outputs) {
  for (const std::filesystem::path& input : options.inputs)
    registerInput(input);
  for (const std::filesystem::path& path : options.outputs)
    declareImage(path, outputs, options.outputNaming, options.extraFiles());
  if (options.surface)
    declareSurface(*options.surface, outputs);
  for (const auto& file : {options.stats, options.returnValues, options.checkpoint})
    if (file)
      outputs.add(*file);
}

void printFacts(const PreparedScene& scene) {
  for (const std::string& fact : scene.choices())
    printLine(fact);
}

std::string describeGpuFailure(const std::string& reason) {
  return concat("--device: the GPU failed: ", reason, "; the CPU rendered");
}

void writeImages(const RenderOptions& options, const PreparedScene& scene,
                 const RenderResult& result, const std::optional<FilteredImage>& filtered,
                 const std::vector<std::string>& arguments, Outputs& outputs) {
  const bool isRawWanted = !filtered || !std::ranges::all_of(options.outputs, isDisplayFile);
  Image raw{
      options.scene.width, options.scene.height, {}, makeHeader(scene, options, result, arguments)};
  Image shown = raw;
  if (isRawWanted) {
    Image channels = makeImage(result.film, scene.camera(), scene.clip(), options.layers);
    raw.channels = std::move(channels.channels);
    if (options.layers.contains("depth50"))
      raw.channels["depth50"] = scene.features()->depth50;
  }
  if (filtered) {
    shown.channels = makeFilteredImage(*filtered, raw.width, raw.height).channels;
    shown.header["filter"] = describeFilter(filtered);
    addDenoisedChannels(options, scene, *filtered, raw);
  }
  // Writes all files in parallel: compressing one does not delay the others.
  std::vector<std::future<void>> files;
  for (const std::filesystem::path& path : options.outputs) {
    const Image& image = filtered && isDisplayFile(path) ? shown : raw;
    files.push_back(std::async([&image, &scene, &path, &options, &outputs] {
      writeImage(image, makeImagePlane(scene.camera()), path, outputs, options.display);
    }));
  }
  for (std::future<void>& file : files)
    file.get();
}

} // namespace fenestra::core
