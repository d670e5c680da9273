// From option values to render options: checks that the options fit each other and the input, and
// resolves defaults that depend on several of them.

#include "program/RenderOptions.h"
#include "base/Error.h"
#include "files/images/ImageFormat.h"
#include "files/slicer/SceneFiles.h"
#include "program/Quality.h"
#include "program/UsageError.h"
#include "scene/Input.h"
#include "scene/NamedPresets.h"

#include <algorithm>

namespace fenestra::core {
namespace {

bool hasMaterials(const RenderRequest& scene) {
  return scene.materials.value_or(noMaterials) != noMaterials;
}

void checkInput(const OptionValues& values, const RenderRequest& scene) {
  const bool isScene = isSceneFile(scene.input), isDicom = !isScene && isDicomInput(scene.input),
             usesLabels = !scene.focus.empty() || hasMaterials(scene);
  if (scene.volume.name && !isScene && !isDicom)
    throw usageError("--volume: only for a scene or DICOM folder with several volumes; omit it");
  if (!scene.focus.empty() && !scene.segmentation && !isScene && !isDicom)
    throw usageError("--focus: requires --segmentation FILE, which holds the segments");
  if (hasMaterials(scene) && !scene.segmentation && !isScene && !isDicom)
    throw usageError("--materials: requires --segmentation FILE, which holds the segments");
  if (!scene.materialChanges.empty() && !hasMaterials(scene))
    throw usageError("--material: contradicts --materials none; omit one of them");
  for (const char* name : {"segmentation", "labels"})
    if (values.has(name) && !usesLabels)
      throw usageError("--", name,
                       ": used only with --focus, --materials or --preset; add --focus A,B,..., "
                       "--materials library or --preset auto");
  if (values.hasNonDefault("view") && values.hasNonDefault("position"))
    throw usageError("--view and --position contradict each other; give only one");
}

void checkView(const ViewRequest& view, const RenderRequest& scene) {
  if (view.isAutomatic() && scene.focus.empty())
    throw usageError("--view: auto requires a focus; add --focus A,B,..., or name a direction");
  // The scene's camera may apply, whose projection is not known yet.
  if (isSceneFile(scene.input) && !view.projection && view.isSceneCamera())
    return;
  const bool perspective = view.projection == Projection::perspective;
  if (perspective && view.scale)
    throw usageError("--scale: only for --projection orthographic; use --angle");
  if (!perspective && view.angle)
    throw usageError("--angle: only for --projection perspective; use --scale");
}

/// Reason why an option has no effect with this clip; empty: it has an effect.
std::string_view findNoEffectReason(Requires requirement, bool hasFocus, bool hasLabels,
                                    ClipMode mode, Boundary boundary) {
  const bool isSurface = mode == ClipMode::surface || mode == ClipMode::ghost;
  if (requirement == Requires::focus && !hasFocus)
    return "requires a focus; add --focus A,B,..., or omit it";
  if (requirement == Requires::labels && !hasLabels)
    return "requires a focus or materials; add --focus or --materials, or omit it";
  if (requirement == Requires::clip && mode == ClipMode::none)
    return "has no effect without a clip; omit it";
  if (requirement == Requires::plane && mode != ClipMode::plane)
    return "used only with --clip plane; add that, or omit it";
  if (requirement == Requires::hole && mode != ClipMode::hole)
    return "used only with --clip hole; add that, or omit it";
  if (requirement == Requires::ghost && mode != ClipMode::ghost)
    return "used only with --clip ghost; add that, or omit it";
  if ((requirement == Requires::surface || requirement == Requires::spline ||
       requirement == Requires::exact) &&
      !isSurface)
    return "used only with --clip surface and ghost; omit it";
  if (requirement == Requires::spline && boundary != Boundary::spline)
    return "used only with --clip-boundary spline; add that, or omit it";
  if (requirement == Requires::exact && boundary != Boundary::exact)
    return "used only with --clip-boundary exact; omit one of them";
  return "";
}

void checkClip(const OptionValues& values, const RenderRequest& scene) {
  const ClipRequest& clip = scene.clip;
  const bool hasFocus = values.has("focus"), hasLabels = hasFocus || hasMaterials(scene);
  const ClipMode mode = clip.resolveMode(hasFocus);
  if (!hasFocus && isDepthClip(mode))
    throw usageError("--clip: ", *values.text("clip"), " requires a focus; add --focus A,B,...");
  if (mode == ClipMode::plane && !clip.plane && !hasFocus)
    throw usageError("--clip: plane requires --plane OX,OY,OZ,NX,NY,NZ or a --focus; add one");
  for (const Option& option : renderSyntax.options)
    if (const auto reason = findNoEffectReason(option.requirement, hasFocus, hasLabels, mode,
                                               clip.surface.boundary);
        !reason.empty() && values.hasNonDefault(option.name) && !values.hasNoEffect(option.name))
      throw usageError("--", option.name, ": ", reason);
  if (values.has("surface") && !isDepthClip(mode))
    throw usageError("--surface: not available with --clip none and plane; add --focus A,B,... "
                     "without another --clip, or omit it");
}

/// INPUT.png in the current folder, without the input's extensions. Throws Error (usage) if no name
/// is left.
std::filesystem::path makeDefaultOutput(const std::filesystem::path& input) {
  std::filesystem::path path = input.lexically_normal();
  if (!path.has_filename()) // folder name with a trailing slash
    path = path.parent_path();
  if (std::error_code failed; path.filename() == "." || path.filename() == "..")
    path = std::filesystem::canonical(path, failed);
  std::string name = path.filename().string();
  for (const char* ending : {".gz", ".nii", ".hdr", ".img", ".mgz", ".mgh", ".nrrd", ".nhdr",
                             ".mha", ".mhd", ".vti", ".tif", ".tiff", ".mrml", ".mrb"})
    if (name.ends_with(ending))
      name.erase(name.size() - std::string_view(ending).size());
  if (name.empty())
    throw usageError("--output: missing, and ", input,
                     " gives no name for the image; add --output FILE.png");
  return name + ".png";
}

/// Input files that options name or may name.
std::vector<std::filesystem::path> listInputFiles(const OptionValues& values) {
  std::vector<std::filesystem::path> files = {*values.text("INPUT")};
  for (const Option& option : renderSyntax.options)
    if (option.canNameFile() && isImageOption(option) && values.has(option.name))
      files.emplace_back(*values.text(option.name));
  std::erase_if(files, [](const auto& file) { return isInlineJson(file.string()); });
  return files;
}

/// Checks that the outputs support the layers, and requests normals if one of them stores normals.
void resolveLayers(const OptionValues& values, RenderOptions& options) {
  const auto has = [&options](ImageFormat format) {
    return std::ranges::count(options.outputs, format, findImageFormat) > 0;
  };
  const bool hasExr = has(ImageFormat::exr);
  if (!hasExr && !has(ImageFormat::nrrd) && values.hasNonDefault("layers"))
    throw usageError("--layers: only for .exr and .nrrd; add --output FILE.exr");
  for (const std::filesystem::path& path : options.outputs)
    if (!options.layers.contains("color") && findImageFormat(path) != ImageFormat::exr)
      throw usageError("--layers: ", path, " requires color; add it, or write .exr only");
  // A checkpoint file holds everything that a later command may write.
  options.settings.path.wantNormals =
      (hasExr && options.layers.contains("normal")) || options.checkpoint;
}

/// Resolves which images are denoised, and which noise stops the render.
void resolveDenoising(const OptionValues& values, RenderOptions& options) {
  const bool hasDisplay = std::ranges::any_of(options.outputs, isDisplayFile);
  const bool hasLayers = options.hasFilterLayer("denoised") || options.hasFilterLayer("expected") ||
                         options.hasFilterLayer("depth50");
  options.scene.features = options.denoise != Denoise::off && (hasDisplay || hasLayers);
  if (options.denoise != Denoise::on && !values.has("layers")) // only if named
    options.layers.erase("depth50");
  if (options.layers.contains("depth50") && !options.scene.features)
    throw usageError(
        "--layers: depth50 requires denoising; add --denoise on, or write a .png, too");
  if (options.denoise == Denoise::on && !hasLayers)
    throw usageError(
        "--denoise: on requires the layer denoised, expected or depth50; add one to --layers, or "
        "omit --denoise");
  if (options.noiseTarget == NoiseTarget::denoised && !options.scene.features)
    throw usageError("--noise-target: denoised requires a denoised image; write a .png, or add "
                     "--denoise on");
  if (values.hasNonDefault("noise-target") && !values.has("noise"))
    throw usageError("--noise-target: used only with --noise; add --noise E, or omit it");
  for (const char* layer : {"denoised", "expected"})
    if (values.has("layers") && options.layers.contains(layer) && options.denoise != Denoise::on)
      throw usageError("--layers: ", layer, " requires --denoise on; add it");
  if (options.noiseTarget == NoiseTarget::automatic)
    options.noiseTarget =
        options.scene.features && std::ranges::all_of(options.outputs, isDisplayFile)
            ? NoiseTarget::denoised
            : NoiseTarget::raw;
}

/// Rejects options that a shard cannot use, since it is not a complete image.
void checkShard(const OptionValues& values, const RenderOptions& options, bool isFromQuality) {
  if (!options.checkpoint)
    throw usageError("--shard: requires --checkpoint FILE, which the shard is saved to; add it");
  for (const char* name : {"output", "surface", "stats-json", "layers"})
    if (values.hasNonDefault(name))
      throw usageError("--", name, ": not for a shard; give it to fenestra merge");
  for (const char* name : {"noise", "seconds"})
    if (values.has(name))
      throw usageError(isFromQuality ? concat("--quality: sets --", name, ", which")
                                     : concat("--", name, ":"),
                       " depends on the complete image, and all shards need the same number of "
                       "samples; with --shard use --samples N");
}

} // namespace

void resolveSmoothing(RenderOptions& options, bool isServer) {
  const SmoothingPurpose purpose{.hasDisplayImage =
                                     std::ranges::any_of(options.outputs, isDisplayFile),
                                 .isServer = isServer,
                                 .isShard = options.isShard};
  options.scene.smoothing =
      isSmoothed(options.smoothing, purpose) ? options.smoothing : SmoothingRequest();
}

std::string formatSmoothing(const SmoothingRequest& smoothing) {
  constexpr int exact = 17; // significant digits
  switch (smoothing.kind) {
  case SmoothingRequest::Kind::automatic:
    return "auto";
  case SmoothingRequest::Kind::off:
    return "off";
  case SmoothingRequest::Kind::given:
    break;
  }
  return toString(smoothing.noise, exact);
}

SmoothingRequest parseSmoothing(const std::string& text) {
  OptionValues values(renderSyntax.options);
  values.add(smoothingOption, text);
  return readOptions(values).smoothing;
}

RenderOptions resolveProgress(RenderOptions options) {
  if (options.quiet && options.verbose)
    throw usageError("--quiet and --verbose contradict each other; give only one");
  if (options.returnValues && options.progress == ProgressMode::automatic)
    options.progress = ProgressMode::xml;
  if (options.quiet && options.progress != ProgressMode::xml)
    options.progress = ProgressMode::none;
  return options;
}

RenderOptions makeRenderOptions(const OptionValues& given) {
  const OptionValues values = expandQuality(given);
  RenderOptions options = readOptions(values);
  RenderRequest& scene = options.scene;
  scene.input = *values.text("INPUT");
  if (!scene.materialChanges.empty() && !scene.materials)
    scene.materials = libraryMaterials;
  checkInput(values, scene);
  checkView(scene.view, scene);
  requireScale(options, scene.view.projection.value_or(Projection::orthographic));
  checkClip(values, scene);

  if (!values.has("samples") && (values.has("seconds") || values.has("noise")))
    options.settings.samples = static_cast<std::uint64_t>(unlimited);
  options.inputs = listInputFiles(values);
  if (options.isShard) {
    checkShard(values, options, given.has("quality"));
  } else if (options.outputs.empty()) {
    options.outputs.push_back(makeDefaultOutput(scene.input));
    options.outputNaming = NameOrigin::standard;
  }
  resolveLayers(values, options);
  resolveDenoising(values, options);
  resolveSmoothing(options);
  scene.measure = options.stats.has_value();
  return resolveProgress(std::move(options));
}

void requireScale(const RenderOptions& options, Projection projection) {
  if (options.display.annotations.scale && projection == Projection::perspective)
    throw usageError("--annotate: scale requires an orthographic projection, since lengths in a "
                     "perspective image depend on the depth; add --projection orthographic, or use "
                     "--annotate orientation");
}

RenderSettings makeSettings(const RenderOptions& options, const std::optional<Background>& scene) {
  RenderSettings settings = options.settings;
  settings.path.background = options.background.value_or(scene.value_or(Background::makeDark()));
  settings.isDisplayNoise = options.noiseTarget == NoiseTarget::denoised;
  if (options.device != DeviceChoice::cpu)
    settings.integrator = Integrator::gpu;
  return settings;
}

} // namespace fenestra::core
