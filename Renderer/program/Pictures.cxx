#include "program/Pictures.h"

#include "base/Error.h"
#include "base/TextStream.h"
#include "base/safe/Inputs.h"
#include "base/safe/ShownText.h"
#include "clip/mesh/SurfaceWriter.h"
#include "files/pictures/ImageWriter.h"
#include "program/FileNames.h"
#include "program/SceneFlags.h"
#include "program/Version.h"

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

/// `fenestra words…`, quoted for a shell, with files named relative to `folder`.
std::string shellCommand(const std::vector<std::string>& words,
                         const std::filesystem::path& folder) {
  return textOf("fenestra ",
                joined(relativeArguments(words, renderSyntax.flags, folder), " ", quoted));
}

std::string text(const Vec3& v) {
  TextWriter out;
  out.precision(17);
  out << v.x() << ',' << v.y() << ',' << v.z();
  return out.str();
}

std::map<std::string, std::string> header(const Scene& scene, const RenderOptions& options,
                                          const RenderResult& result,
                                          const std::vector<std::string>& words) {
  const std::filesystem::path folder = options.outputs.front().parent_path();
  const CameraPose& pose = scene.camera().pose();
  const bool perspective = pose.projection == Projection::perspective;
  TextWriter camera;
  camera.precision(17);
  camera << "--projection " << (perspective ? "perspective --angle " : "orthographic --scale ")
         << (perspective ? pose.angle : pose.scale) << " --position=" << text(pose.position)
         << " --target=" << text(pose.target) << " --up=" << text(pose.up);
  std::map<std::string, std::string> entries = {{"version", versionText},
                                                {"target", processorText + ("-" + result.target)},
                                                {"seed", std::to_string(options.settings.seed)},
                                                {"samples", std::to_string(result.finishedSamples)},
                                                {"camera", camera.str()},
                                                {"look", relativeName(scene.look(), folder)},
                                                {"command", shellCommand(words, folder)}};
  if (options.preset)
    entries["preset"] = relativeName(*options.preset, folder);
  return entries;
}

} // namespace

void refuseFlags(const FlagValues& given, std::initializer_list<const char*> names,
                 const std::string& why) {
  for (const char* name : names)
    if (given.has(name))
      throw usageError(std::string("--") + name + ": " + why);
}

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
  TextWriter line;
  line.precision(3);
  line << "a picture of " << scene.width << "x" << scene.height << " pixels takes "
       << needed / gigabyte << " GB of memory, this machine has " << there / gigabyte
       << "; choose a smaller one";
  throw outputError("--size", line.str());
}

RenderResult renderPicture(const RenderOptions& options, const Scene& scene,
                           RenderMonitor& monitor) {
  return render(scene.forRender(), settingsFor(options, scene.background()), monitor);
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

std::vector<std::string> staleParts(const RenderOptions& options, const Outputs& outputs) {
  std::vector<std::string> warnings;
  std::error_code failed;
  for (const std::filesystem::path& path : options.outputs)
    for (const std::filesystem::path& file : imageFiles(path))
      if (!outputs.written(file) && std::filesystem::exists(file, failed))
        warnings.push_back(oneLine(file.string()) + ": is of an earlier picture than " +
                           oneLine(path.filename().string()) + "; remove it");
  return warnings;
}

std::future<void> startSurface(const RenderOptions& options, const Scene& scene, Outputs& outputs) {
  if (!options.surface)
    return std::async(std::launch::deferred, [] {});
  return std::async([&options, &scene, &outputs] {
    const auto& clip = std::get<ClipDepth>(scene.clip());
    writeSurface(surfaceMesh(clip, scene.domain(), surfaceTolerance(clip.camera)), *options.surface,
                 outputs);
  });
}

} // namespace fenestra
