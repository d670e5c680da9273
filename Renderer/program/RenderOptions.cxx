// From flags to a render: values go where the table says; contradictions are refused.

#include "program/RenderOptions.h"
#include "base/Error.h"
#include "files/images/ImageFormat.h"
#include "files/slicer/SceneFiles.h"
#include "scene/NamedPresets.h"

#include <algorithm>

namespace fenestra {
namespace {

bool hasMaterials(const RenderRequest& scene) {
  return scene.materials.value_or(noMaterials) != noMaterials;
}

void checkInput(const OptionValues& values, const RenderRequest& scene) {
  const bool isScene = isSceneFile(scene.input),
             usesLabels = !scene.focus.empty() || hasMaterials(scene);
  if (scene.volume && !isScene && !isFolder(scene.input))
    throw usageError("--volume: only a scene or a DICOM folder holds several; drop it");
  if (!scene.focus.empty() && !scene.segmentation && !isScene)
    throw usageError("--focus: needs --segmentation FILE to find segments in");
  if (hasMaterials(scene) && !scene.segmentation && !isScene)
    throw usageError("--materials: needs --segmentation FILE with the segments to colour");
  if (!scene.materialChanges.empty() && !hasMaterials(scene))
    throw usageError("--material: changes what --materials gives; add --materials library");
  for (const char* name : {"segmentation", "labels"})
    if (values.has(name) && !usesLabels)
      throw usageError("--", name,
                       ": only --focus, --materials and --preset use it; add --focus A,B,..., "
                       "--materials library or --preset auto");
  if (values.hasNonDefault("view") && values.hasNonDefault("position"))
    throw usageError("--view and --position contradict each other; give one");
}

void checkView(const ViewRequest& view, const RenderRequest& scene) {
  if (view.isAutomatic() && scene.focus.empty())
    throw usageError("--view: auto looks for a focus; add --focus A,B,..., or name a direction");
  // A scene's camera may apply, whose projection is not known yet.
  if (isSceneFile(scene.input) && !view.projection && view.isSceneCamera())
    return;
  const bool perspective = view.projection == Projection::perspective;
  if (perspective && view.scale)
    throw usageError("--scale: only for --projection orthographic; use --angle");
  if (!perspective && view.angle)
    throw usageError("--angle: only for --projection perspective; use --scale");
}

/// Reason why a flag has no effect with this clip; empty: it has one.
std::string_view findNoEffectReason(Requires requirement, bool hasFocus, bool hasLabels,
                                    ClipMode mode, Boundary boundary) {
  const bool isSurface = mode == ClipMode::surface || mode == ClipMode::ghost;
  if (requirement == Requires::focus && !hasFocus)
    return "needs a focus; add --focus, or drop it";
  if (requirement == Requires::labels && !hasLabels)
    return "needs a focus or materials; add --focus or --materials, or drop it";
  if (requirement == Requires::clip && mode == ClipMode::none)
    return "without a clip there is nothing to change; drop it";
  if (requirement == Requires::plane && mode != ClipMode::plane)
    return "only --clip plane uses it; add --clip plane, or drop it";
  if (requirement == Requires::hole && mode != ClipMode::hole)
    return "only --clip hole uses it; add --clip hole, or drop it";
  if (requirement == Requires::ghost && mode != ClipMode::ghost)
    return "only --clip ghost uses it; add --clip ghost, or drop it";
  if ((requirement == Requires::surface || requirement == Requires::spline) && !isSurface)
    return "only --clip surface and ghost use it; drop it";
  if (requirement == Requires::spline && boundary != Boundary::spline)
    return "only --boundary spline uses it; drop it";
  return "";
}

void checkClip(const OptionValues& values, const RenderRequest& scene) {
  const ClipRequest& clip = scene.clip;
  const bool hasFocus = values.has("focus"), hasLabels = hasFocus || hasMaterials(scene);
  const ClipMode mode = clip.resolveMode(hasFocus);
  if (!hasFocus && isDepthClip(mode))
    throw usageError("--clip: ", *values.text("clip"), " needs a focus; add --focus");
  if (mode == ClipMode::plane && !clip.plane && !hasFocus)
    throw usageError("--clip: plane needs --plane OX,OY,OZ,NX,NY,NZ, or a --focus to place it by");
  for (const Option& option : renderSyntax.options)
    if (const auto reason = findNoEffectReason(option.requirement, hasFocus, hasLabels, mode,
                                               clip.surface.boundary);
        !reason.empty() && values.hasNonDefault(option.name) && !values.hasNoEffect(option.name))
      throw usageError("--", option.name, ": ", reason);
  if (values.has("surface") && !isDepthClip(mode))
    throw usageError("--surface: --clip none and plane have none; add --focus A,B,... without "
                     "another --clip, or drop it");
}

/// INPUT.png in the current folder, without the input's own endings. Throws Error (usage) if no
/// name is left.
std::filesystem::path makeDefaultOutput(const std::filesystem::path& input) {
  std::filesystem::path path = input.lexically_normal();
  if (!path.has_filename()) // folder name with a slash at its end
    path = path.parent_path();
  if (std::error_code failed; path.filename() == "." || path.filename() == "..")
    path = std::filesystem::canonical(path, failed);
  std::string name = path.filename().string();
  for (const char* ending : {".gz", ".nii", ".nrrd", ".nhdr", ".mha", ".mhd", ".mrml", ".mrb"})
    if (name.ends_with(ending))
      name.resize(name.size() - std::string_view(ending).size());
  if (name.empty())
    throw usageError("--output: is missing, and ", input,
                     " gives the picture no name; add --output FILE.png");
  return name + ".png";
}

/// Input files that flags name, or may name.
std::vector<std::filesystem::path> listInputFiles(const OptionValues& values) {
  std::vector<std::filesystem::path> files = {*values.text("INPUT")};
  for (const Option& option : renderSyntax.options)
    if (option.canNameFile() && isImageOption(option) && values.has(option.name))
      files.emplace_back(*values.text(option.name));
  std::erase_if(files, [](const auto& file) { return isInlineJson(file.string()); });
  return files;
}

/// Checks the layers against the pictures, and asks for normals if one of these has them.
void resolveLayers(const OptionValues& values, RenderOptions& options) {
  const auto has = [&options](ImageFormat format) {
    return std::ranges::count(options.outputs, format, findImageFormat) > 0;
  };
  const bool hasExr = has(ImageFormat::exr);
  if (!hasExr && !has(ImageFormat::nrrd) && values.hasNonDefault("layers"))
    throw usageError("--layers: only .exr and .nrrd have them; add --output FILE.exr");
  for (const std::filesystem::path& path : options.outputs)
    if (!options.layers.contains("color") && findImageFormat(path) != ImageFormat::exr)
      throw usageError("--layers: ", path, " needs color; add it, or write .exr alone");
  // A film holds all that a later command may write.
  options.settings.path.wantNormals =
      (hasExr && options.layers.contains("normal")) || options.checkpoint;
}

/// Settles what is filtered, and which noise ends the render.
void resolveDenoising(const OptionValues& values, RenderOptions& options) {
  const bool hasDisplay = std::ranges::any_of(options.outputs, isDisplayFile);
  const bool hasLayers = options.hasFilterLayer("denoised") || options.hasFilterLayer("expected");
  options.scene.features = options.denoise != Denoise::off && (hasDisplay || hasLayers);
  if (options.denoise == Denoise::on && !hasLayers)
    throw usageError(
        "--denoise: on adds the layers denoised and expected; name one in --layers, or "
        "drop --denoise");
  if (options.noiseTarget == NoiseTarget::filtered && !options.scene.features)
    throw usageError("--noisetarget: filtered needs a filtered picture; write a .png, or add "
                     "--denoise on");
  if (values.hasNonDefault("noisetarget") && !values.has("noise"))
    throw usageError("--noisetarget: only --noise uses it; add --noise E, or drop it");
  for (const char* layer : {"denoised", "expected"})
    if (values.has("layers") && options.layers.contains(layer) && options.denoise != Denoise::on)
      throw usageError("--layers: ", layer, " needs --denoise on; add it");
  if (options.noiseTarget == NoiseTarget::automatic)
    options.noiseTarget =
        options.scene.features && std::ranges::all_of(options.outputs, isDisplayFile)
            ? NoiseTarget::filtered
            : NoiseTarget::raw;
}

/// Checks the flags of a part of a picture, which has no picture yet.
void checkShard(const OptionValues& values, const RenderOptions& options) {
  if (!options.checkpoint)
    throw usageError("--shard: needs --checkpoint FILE, the film of that part; add it");
  for (const char* name : {"output", "surface", "stats", "layers"})
    if (values.hasNonDefault(name))
      throw usageError("--", name, ": is for the whole picture; give it to fenestra merge");
  for (const char* name : {"noise", "seconds"})
    if (values.has(name))
      throw usageError("--", name,
                       ": depends on the whole picture, and parts must have the same "
                       "samples; with --shard give --samples N");
}

} // namespace

RenderOptions makeRenderOptions(const OptionValues& values) {
  RenderOptions options = readOptions(values);
  RenderRequest& scene = options.scene;
  scene.input = *values.text("INPUT");
  checkInput(values, scene);
  checkView(scene.view, scene);
  checkClip(values, scene);

  if (!values.has("samples") && (values.has("seconds") || values.has("noise")))
    options.settings.samples = static_cast<std::uint64_t>(unlimited);
  options.inputs = listInputFiles(values);
  if (options.isShard) {
    checkShard(values, options);
  } else if (options.outputs.empty()) {
    options.outputs.push_back(makeDefaultOutput(scene.input));
    options.outputNaming = NameOrigin::standard;
  }
  resolveLayers(values, options);
  resolveDenoising(values, options);
  scene.measure = options.stats.has_value();
  if (options.returnValues && options.progress == ProgressMode::automatic)
    options.progress = ProgressMode::xml;
  return options;
}

RenderSettings makeSettings(const RenderOptions& options, const std::optional<Background>& scene) {
  RenderSettings settings = options.settings;
  settings.path.background = options.background.value_or(scene.value_or(Background::makeDefault()));
  return settings;
}

} // namespace fenestra
