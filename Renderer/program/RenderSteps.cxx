#include "program/RenderSteps.h"

#include "base/Error.h"
#include "base/PhysicalMemory.h"
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

std::map<std::string, std::string> makeHeader(const PreparedScene& scene,
                                              const RenderOptions& options,
                                              const RenderResult& result,
                                              const std::vector<std::string>& words) {
  const std::filesystem::path folder = options.outputs.front().parent_path();
  const std::vector<std::string> arguments =
      toRelativeArguments(words, renderSyntax.options, folder);
  std::map<std::string, std::string> entries = {
      {"version", versionText},
      {"target", concat(processorText, "-", result.target)},
      {"seed", concat(options.settings.seed)},
      {"sampling", toString(options.settings.sampling)},
      {"samples", concat(result.finishedSamples)},
      {"camera", formatCamera(scene.camera().pose())},
      {"look", toRelativeName(scene.transferName(), folder)},
      {"command", concat("fenestra ", join(arguments, " ", quoteForShell))}};
  if (const auto smoothing = scene.smoothing(); smoothing && smoothing->isApplied())
    entries["volume"] = describe(*smoothing);
  if (options.preset)
    entries["preset"] = toRelativeName(*options.preset, folder);
  return entries;
}

/// Header text on how an image was denoised.
std::string describeDenoising(const std::optional<FilteredImage>& filtered) {
  const std::optional<double> noise = denoisedNoise(filtered);
  return concat("denoised by local linear regression, version ", filterVersion,
                ", on expected albedo, normal, depth and light; estimated error ",
                noise ? toString(*noise, 3) : "unknown", "; --denoise off leaves the image raw");
}

/// Adds the denoiser's channels that the layers include; R, G, B and A stay unchanged.
void addDenoisedChannels(const RenderOptions& options, const PreparedScene& scene,
                         const FilteredImage& filtered, Image& image) {
  if (options.hasFilterLayer("expected"))
    addExpected(image, *scene.features());
  if (!options.hasFilterLayer("denoised"))
    return;
  addDenoised(image, filtered);
  image.header["filter"] = concat("channels denoised.* are ", describeDenoising(filtered),
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
    declareImage(path, outputs, options.outputNaming, options.filteredFiles());
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

/// Compares with physical memory, since Linux grants more and kills the process when it is used.
void checkMemory(const RenderRequest& scene) {
  constexpr double filter = 400.0; // buffers of the denoiser
  const double bytesPerPixel =     // film, and its channels as written
      2.0 * sizeof(PixelSums) + (scene.features ? filter : 0.0);
  constexpr double gigabyte = 1e9;
  const double needed = bytesPerPixel * scene.width * scene.height;
  const double available = physicalMemory();
  if (needed <= available)
    return;
  throw outputError(ErrorCode::outOfMemory, "--size", "an image of ", scene.width, "x",
                    scene.height, " pixels needs ", toString(needed / gigabyte, 3),
                    " GB of memory, but this machine has ", toString(available / gigabyte, 3),
                    "; use a smaller size");
}

RenderSettings ImageDenoiser::settings() {
  RenderSettings settings = makeSettings(m_options, m_scene.background());
  if (m_options.noiseTarget == NoiseTarget::denoised)
    settings.displayNoise = [this](const Film& film) {
      m_checked = denoise(film, m_scene.view(), *m_scene.features());
      m_checkedSamples = film.sampleCounts().max;
      // Two standard errors more, so that the render does not stop by chance.
      return std::sqrt(m_checked.estimatedError + 2.0 * m_checked.errorUncertainty);
    };
  return settings;
}

std::optional<FilteredImage> ImageDenoiser::apply(const RenderResult& result) const {
  if (!m_scene.features())
    return std::nullopt;
  if (result.reason == StopReason::noise && m_checkedSamples == result.finishedSamples)
    return m_checked;
  return denoise(result.film, m_scene.view(), *m_scene.features());
}

std::optional<double> denoisedNoise(const std::optional<FilteredImage>& filtered) {
  if (!filtered || filtered->error[0].empty())
    return std::nullopt;
  return std::sqrt(filtered->estimatedError);
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
  }
  if (filtered) {
    shown.channels = makeFilteredImage(*filtered, raw.width, raw.height).channels;
    shown.header["filter"] = describeDenoising(filtered);
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
