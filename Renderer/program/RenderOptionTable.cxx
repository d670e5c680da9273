#include "program/RenderOptions.h"

#include "base/Error.h"
#include "files/images/ImageFormat.h"
#include "io/MessageText.h"
#include "program/UsageError.h"
#include "scene/NamedPresets.h"

#include <algorithm>
#include <cstdio>

namespace fenestra {
namespace {

constexpr const char* sceneGroup = "Input, focus and output";
constexpr const char* clipGroup = "Clipping";
constexpr const char* viewGroup = "View";
constexpr const char* appearanceGroup = "Appearance";
constexpr const char* qualityGroup = "Quality";
constexpr const char* outputGroup = "More";
constexpr const char* slicerGroup = "Used by 3D Slicer";

// ---- values with a syntax of their own

void readMargins(const OptionValues& values, const std::string& name,
                 std::vector<double>& margins) {
  const auto commas = std::ranges::count(*values.text(name), ',');
  margins = values.numbers(name, 1 + static_cast<std::size_t>(commas));
  for (const double margin : margins)
    if (std::abs(margin) > 1000.0)
      throw usageError("--" + name + ": must be from -1000 to 1000 mm");
}

void readPlane(const OptionValues& values, const std::string& name,
               std::optional<PlaneRequest>& plane) {
  const std::vector<double> numbers = values.numbers(name, 6);
  const Vec3 normal(numbers[3], numbers[4], numbers[5]);
  if (normal.isZero(0.0))
    throw usageError("--" + name + ": the normal NX,NY,NZ must not be zero");
  plane = {Vec3(numbers[0], numbers[1], numbers[2]), normal.stableNormalized()};
}

/// R,G,B, or one number for all three. `alternatives`: other valid values, for the message.
Rgb parseLinearColor(const OptionValues& values, const std::string& name,
                     const std::string& alternatives) {
  constexpr double brightest = 1e12; // keeps products within a float's range
  const std::string text = *values.text(name);
  const bool numbers = text.find_first_not_of("0123456789+-.,eE ") == std::string::npos;
  const bool isGray = text.find(',') == std::string::npos;
  const Rgb value = !numbers ? Rgb::Constant(-1.0)
                    : isGray ? Rgb::Constant(values.numbers(name, 1)[0])
                             : Rgb(values.triple(name).array());
  if (value.minCoeff() < 0.0 || value.maxCoeff() > brightest)
    throw usageError("--", name, ": expected R,G,B, or one number for gray, from 0 to 1e12, or ",
                     alternatives, ", got '", toOneLine(text), "'");
  return value;
}

void readEnvironment(const OptionValues& values, const std::string& name, RenderRequest& scene) {
  const std::string text = *values.text(name);
  if (findImageFormat(text) == ImageFormat::exr)
    scene.environmentMap = text;
  else
    scene.environment = parseLinearColor(values, name, "an .exr file");
}

void readBackground(const OptionValues& values, const std::string& name,
                    std::optional<Background>& background) {
  const std::string text = *values.text(name);
  if (text == "transparent")
    background = Background{Background::Kind::transparent};
  else if (text == "environment")
    background = Background{Background::Kind::environment};
  else if (text == "gradient")
    background = Background::makeDefault();
  else
    background = Background{Background::Kind::color,
                            parseLinearColor(values, name, "gradient, transparent or environment")};
}

void readSize(const OptionValues& values, const std::string& name, RenderRequest& scene) {
  constexpr int largest = 16384;
  const std::string text = *values.text(name);
  char rest = 0;
  const int parts = std::sscanf(text.c_str(), "%dx%d%c", &scene.width, &scene.height, &rest);
  if (parts != 2 || std::min(scene.width, scene.height) < 1 ||
      std::max(scene.width, scene.height) > largest)
    throw usageError("--", name, ": expected WIDTHxHEIGHT in pixels, each from 1 to ", largest,
                     ", got '", toOneLine(text), "'");
}

void readShard(const OptionValues& values, const std::string& name, RenderOptions& options) {
  const std::string text = *values.text(name);
  int number = 0, count = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%d/%d%c", &number, &count, &rest) != 2 || number < 1 ||
      number > count || count > maxShards)
    throw usageError("--", name, ": expected K/N, shard K of N, from 1/1 to ", maxShards, "/",
                     maxShards, ", got '", toOneLine(text), "'");
  options.settings.shard = {number - 1, count};
  options.isShard = true;
}

void readTexts(const OptionValues& values, const std::string& name,
               std::vector<std::string>& texts) {
  texts = values.texts(name);
}

void readLayers(const OptionValues& values, const std::string& name, LayerSet& layers) {
  layers = parseLayers(values.list(name));
}

/// Names of built-in presets, and of others.
std::vector<std::string> presetNames(const std::string& kind,
                                     const std::vector<std::string>& others) {
  std::vector<std::string> names = listBuiltinPresets(kind);
  std::ranges::copy(others, std::back_inserter(names));
  return names;
}

// ---- the table

/// All options. Values are stored in `options`, whose initial values are the defaults.
struct RenderOptionTable {
  RenderOptionTable() = default;
  RenderOptionTable(const RenderOptionTable&) = delete;
  RenderOptionTable& operator=(const RenderOptionTable&) = delete;

  RenderOptions options = {};
  RenderRequest& scene = options.scene;
  ClipRequest& clip = scene.clip;
  SurfaceOptions& surface = clip.surface;
  FocusRequest& focus = scene.focusStyle;
  ViewRequest& view = scene.view;
  RenderSettings& settings = options.settings;

  std::vector<Option> rows = {
      {"segmentation", "FILE|NAME", sceneGroup,
       "Segmentation: a .seg.nrrd, a label map, or a node of the scene [the scene's]",
       ValueSpec::labels().bind(scene.segmentation), OverrideGroup::focus},
      {"labels", "FILE|NAME", sceneGroup,
       "Names of label values: a .ctbl, .label, .json or .csv file, or totalsegmentator, "
       "totalsegmentator1, totalsegmentator2 or freesurfer [in or beside the label map]",
       ValueSpec::text()
           .bind(scene.labels)
           .withNamedValues(presetNames("labels", {"totalsegmentator"})),
       OverrideGroup::focus},
      {"focus", "A,B,...", sceneGroup,
       "Segments to show with nothing in front of them: ids, names or label values (write a comma "
       "in a name as \\,); may be repeated",
       ValueSpec::list().bind(scene.focus), OverrideGroup::focus},
      {"preset", "NAME|FILE|auto", sceneGroup,
       concat("Anatomy preset for focus, appearance, view and clip: ",
              join(listBuiltinPresets("presets"), ", "),
              ", a .json file, or auto (chosen by segment names); other options override it"),
       ValueSpec::text()
           .bind(options.preset)
           .withNamedValues(presetNames("presets", {"auto"}))
           .withAliases({{"brain-tumour", "brain-tumor"}})},
      {"output", "FILE", sceneGroup,
       "Output image: .png .tif (for display), .exr (all channels), .nrrd (linear RGBA and depth); "
       "may be repeated [INPUT.png]",
       ValueSpec::outputImage().bind(options.outputs), OverrideGroup::process},
      {"margin", "MM,...", clipGroup,
       "Enlarges the focus, or shrinks it (negative): one value for all its segments, or one per "
       "segment [0]",
       ValueSpec::numbers().bind(focus.shaping.margins, readMargins), OverrideGroup::focus,
       Requires::focus},
      {"labelsmoothing", "MM", clipGroup,
       "Standard deviation of a Gaussian that smooths the labels of focus and materials; thick "
       "slices are interpolated first; auto: 0.6 of the longest voxel edge, except for thin parts",
       ValueSpec::numberOrAuto(focus.shaping.smoothing, 0.0, 100.0, 0.0), OverrideGroup::own,
       Requires::labels},
      {"clip", "MODE", clipGroup,
       "none, plane, hole, cutaway, ghost, surface, or auto: surface with a focus, else none",
       ValueSpec::choice(clip.mode, {{"auto", std::nullopt},
                                     {"none", ClipMode::none},
                                     {"plane", ClipMode::plane},
                                     {"hole", ClipMode::hole},
                                     {"cutaway", ClipMode::cutaway},
                                     {"ghost", ClipMode::ghost},
                                     {"surface", ClipMode::surface}}),
       OverrideGroup::clip},
      {"boundary", "KIND", clipGroup,
       "How the clipping surface meets the outline of the focus: spline (approximately, as in the "
       "paper) or exact (with equal depth and slope)",
       ValueSpec::choice(surface.boundary,
                         {{"spline", Boundary::spline}, {"exact", Boundary::exact}}),
       OverrideGroup::boundary, Requires::surface},
      {"controlpoints", "N", clipGroup, "Number of control points of the spline, 3 to 1000",
       ValueSpec::integer(3, 1000).bind(surface.controlPoints), OverrideGroup::boundary,
       Requires::spline},
      {"smoothing", "P", clipGroup,
       "Smoothing parameter p of the spline, for mm, from 0 (a plane) to 1 (meets all control "
       "points)",
       ValueSpec::number(0.0, 1.0).bind(surface.smoothing), OverrideGroup::boundary,
       Requires::spline},
      {"plane", "OX,OY,OZ,NX,NY,NZ", clipGroup,
       "Clip plane as point and normal, RAS mm; the side the normal points to is removed "
       "[fitted to the focus]",
       ValueSpec::numbers().bind(clip.plane, readPlane), OverrideGroup::clip, Requires::plane},
      {"hole", "SHAPE", clipGroup, "Shape of --clip hole: box, cylinder or sphere",
       ValueSpec::choice(surface.hole.shape, {{"box", HoleShape::box},
                                              {"cylinder", HoleShape::cylinder},
                                              {"sphere", HoleShape::sphere}}),
       OverrideGroup::clip, Requires::hole},
      {"holemargin", "MM", clipGroup, "Distance from the focus to the wall of the hole",
       ValueSpec::number(0.0, 1e6).bind(surface.hole.margin), OverrideGroup::clip, Requires::hole},
      {"ghost", "FRACTION", clipGroup, "Fraction of the extinction that --clip ghost keeps, 0 to 1",
       ValueSpec::number(0.0, 1.0).bind(clip.ghost), OverrideGroup::clip, Requires::ghost},
      {"offset", "MM", clipGroup,
       "Moves the cut away from the camera, into the focus, or toward the camera (negative)",
       ValueSpec::number(-1e6, 1e6).bind(surface.offset), OverrideGroup::clip, Requires::clip},
      {"soft", "MM", clipGroup,
       "Depth behind the cut over which the volume fades in; auto: as --labelsmoothing for --clip "
       "surface, hole and cutaway, else 0",
       ValueSpec::numberOrAuto(clip.softness, 0.0, 1e6, 0.0), OverrideGroup::clip, Requires::clip},
      {"contextdensity", "F", clipGroup,
       "Factor on the extinction of everything but the focus, 0 to 1",
       ValueSpec::number(0.0, 1.0).bind(focus.contextExtinction), OverrideGroup::own,
       Requires::focus},
      {"contextsaturation", "S", clipGroup,
       "Color saturation of everything but the focus, from 0 (gray) to 1 (unchanged); auto: the "
       "largest of 1, 0.35 and 0 that makes the focus distinguishable; 1 with materials",
       ValueSpec::numberOrAuto(focus.contextSaturation, 0.0, 1.0, 1.0), OverrideGroup::own,
       Requires::focus},
      {"view", "NAME", viewGroup,
       "anterior, posterior, left, right, superior, inferior, or auto: the direction that shows "
       "most of the focus, with the least foreshortening and the least removed [the scene's "
       "camera, else anterior]",
       ValueSpec::choice({"anterior", "posterior", "left", "right", "superior", "inferior", "auto"})
           .bind(view.name)
           .withDefault("anterior"),
       OverrideGroup::viewpoint},
      {"position", "R,A,S", viewGroup, "Camera position, mm",
       ValueSpec::numbers().bind(view.position), OverrideGroup::viewpoint},
      {"target", "R,A,S", viewGroup,
       "Point that the camera looks at, mm [center of the focus, shifted if that is at an end of "
       "the scan; else center of the volume]",
       ValueSpec::numbers().bind(view.target), OverrideGroup::view},
      {"up", "R,A,S", viewGroup, "Up direction of the image", ValueSpec::numbers().bind(view.up),
       OverrideGroup::view},
      {"projection", "KIND", viewGroup,
       "orthographic or perspective [the scene's, else orthographic]",
       ValueSpec::choice(view.projection, {{"orthographic", Projection::orthographic},
                                           {"perspective", Projection::perspective}})
           .withDefault("orthographic"),
       OverrideGroup::extent},
      {"scale", "MM", viewGroup,
       "Orthographic: half the height of the image [fits the focus, else everything visible]",
       ValueSpec::number(1e-9, 1e9).bind(view.scale), OverrideGroup::extent},
      {"angle", "DEGREES", viewGroup,
       "Perspective: full vertical angle [30, or less to fit the focus]",
       ValueSpec::number(1e-6, 179.0).bind(view.angle), OverrideGroup::extent},
      {"transfer", "FILE|PRESET|JSON", appearanceGroup,
       "Transfer function: a .vp, .vp.json or Fenestra .json file, inline JSON, a preset such as "
       "ct-soft, or a volume property by name, of the scene or of 3D Slicer, such as CT-AAA [the "
       "scene's, else by modality]",
       ValueSpec::text().bind(scene.transfer).withNamedValues(listBuiltinPresets("transfer"))},
      {"shift", "X", appearanceGroup, "Shifts the transfer function along the scalar axis",
       ValueSpec::number(-1e30, 1e30).bind(scene.shift)},
      {"density", "D", appearanceGroup, "Factor on the extinction, 0 to 1000",
       ValueSpec::number(0.0, 1000.0).bind(scene.density)},
      {"materials", "none|auto|library|FILE", appearanceGroup,
       "Segment colors by material: none, library (Fenestra's), a .json file that extends the "
       "library, or auto: library colors, adjusted so that the focus is distinguishable; opacity "
       "and surfaces are unaffected [auto if the material of the focus is known and "
       "--contextsaturation is not given, else none]",
       ValueSpec::text().bind(scene.materials).withNamedValues({"none", "auto", "library"}),
       OverrideGroup::materials},
      {"material", "TEXT", appearanceGroup,
       "Changes the material of one segment, such as \"Liver: color=#963e2e\" or \"Aorta: "
       "clip=no\" (exempt from clipping); may be repeated",
       ValueSpec::texts().bind(scene.materialChanges, readTexts), OverrideGroup::materials},
      {"lights", "FILE|PRESET|JSON", appearanceGroup,
       "Lights: cinema, studio, headlight, soft, amber, a .json file, or inline JSON, {...}",
       ValueSpec::text().bind(scene.lights).withNamedValues(listBuiltinPresets("lights")),
       OverrideGroup::lights},
      {"environment", "R,G,B|GRAY|FILE", appearanceGroup,
       "Radiance from all directions, or a latitude-longitude .exr; replaces the environment of "
       "--lights",
       ValueSpec::text().bind(scene, readEnvironment), OverrideGroup::lights},
      {"background", "R,G,B|GRAY|KIND", appearanceGroup,
       "Linear color (the tone curve of a .png maps 1,1,1 to light gray, 100,100,100 to white), "
       "gradient (dark grays), transparent or environment [the scene's, else gradient]",
       ValueSpec::text()
           .bind(options.background, readBackground)
           .withNamedValues({"gradient", "transparent", "environment"})},
      {"exposure", "EV", appearanceGroup,
       "Exposure of .png and .tif in stops, -16 to 16; .exr and .nrrd are unaffected",
       ValueSpec::number(-16.0, 16.0).bind(options.display.exposure)},
      {"tone", "CURVE", appearanceGroup,
       "Tone curve of .png and .tif: film (more contrast, preserves hue) or photographic "
       "(preserves dark and middle values, for measuring)",
       ValueSpec::choice(options.display.view, {{"film", DisplayView::film},
                                                {"photographic", DisplayView::photographic}})},
      {"size", "WxH", qualityGroup, "Image size in pixels",
       ValueSpec::text()
           .bind(scene, readSize)
           .withDefault(std::to_string(scene.width) + "x" + std::to_string(scene.height))},
      {"samples", "N", qualityGroup,
       "Stop at N samples per pixel [" + std::to_string(settings.samples) +
           " unless seconds or noise are given]",
       ValueSpec::integer(1, unlimited).bind(settings.samples).withDefault(""),
       OverrideGroup::stop},
      {"seconds", "T", qualityGroup,
       "Stop after T seconds of rendering, but not before one sample per pixel",
       ValueSpec::number(1e-3, 1e9).bind(settings.seconds).withDefault(""), OverrideGroup::stop},
      {"noise", "E", qualityGroup, "Stop when the relative noise is at most E, for example 0.03",
       ValueSpec::number(1e-6, 1e6).bind(settings.noise).withDefault(""), OverrideGroup::stop},
      {"noisetarget", "KIND", qualityGroup,
       "Noise that --noise limits: raw (before denoising; noisier pixels get more samples), "
       "denoised (estimated error after denoising), or auto: denoised if all outputs are .png or "
       ".tif",
       ValueSpec::choice(options.noiseTarget, {{"auto", NoiseTarget::automatic},
                                               {"raw", NoiseTarget::raw},
                                               {"denoised", NoiseTarget::denoised}})
           .withAliases({{"filtered", "denoised"}}),
       OverrideGroup::stop},
      {"denoise", "KIND", qualityGroup,
       "auto: denoise .png and .tif, leave the colors of .exr and .nrrd raw; on: also write "
       "denoised channels to .exr and .nrrd; off",
       ValueSpec::choice(
           options.denoise,
           {{"auto", Denoise::automatic}, {"on", Denoise::on}, {"off", Denoise::off}})},
      {"bounces", "B", qualityGroup, "Maximum scattering events per path (biased) [unlimited]",
       ValueSpec::integer(0, unlimited).bind(settings.path.bounces).withDefault("")},
      {"seed", "S", qualityGroup, "Random seed", ValueSpec::integer(0, 0x1p64).bind(settings.seed)},
      {"sampling", "KIND", qualityGroup,
       "stratified: first-bounce dimensions are stratified in groups of 8 samples; independent: "
       "plain "
       "random numbers (noisier); both are unbiased",
       ValueSpec::choice(settings.sampling, {{"stratified", Sampling::stratified},
                                             {"independent", Sampling::independent}})
           .withAliases({{"strata", "stratified"}})},
      {"threads", "K", qualityGroup, "Number of threads, at most one per core; 0: all cores",
       ValueSpec::integer(0, 1024).bind(settings.threads), OverrideGroup::process},
      {"volume", "NAME", outputGroup,
       "Volume of a scene (name or id), or series of a DICOM folder [as in Slicer]",
       ValueSpec::text().bind(scene.volume)},
      // Slicer takes one file, hence color alone in its panel.
      {"layers", "L,...", outputGroup,
       "Channels of .exr: color, depth, clip, albedo, normal, error, samples, and with --denoise "
       "on denoised, expected; of .nrrd: color, depth and denoised (separate files) [all]",
       ValueSpec::list()
           .bind(options.layers, readLayers)
           .withDefault("color")
           .withNamedValues({allLayers.begin(), allLayers.end()}),
       OverrideGroup::process},
      {"surface", "FILE", outputGroup,
       "Clipping surface as triangles, RAS mm, accurate to a tenth of a pixel in depth (any --clip "
       "but none and plane): .vtp .ply (with depths) .stl",
       ValueSpec::surface().bind(options.surface), OverrideGroup::process},
      {"stats", "FILE", outputGroup, "Times, counts and measurements as .json",
       ValueSpec::jsonFile().bind(options.stats), OverrideGroup::process},
      {"checkpoint", "FILE", outputGroup,
       "Saves the samples so far to this checkpoint file (.film). The same command resumes from it "
       "after a stop or a crash, and ends with the same image; --samples, --noise, --seconds, "
       "--threads and outputs may change",
       ValueSpec::checkpointFile().bind(options.checkpoint), OverrideGroup::process},
      {"shard", "K/N", outputGroup,
       "Renders only the K-th of N shards of the image, to the file of --checkpoint, for fenestra "
       "merge; of a turntable, the frames of that shard",
       ValueSpec::text().bind(options, readShard), OverrideGroup::process},
      {"progress", "KIND", outputGroup, "auto, bar, xml (Slicer's tags) or none",
       ValueSpec::choice(options.progress, {{"auto", ProgressMode::automatic},
                                            {"bar", ProgressMode::bar},
                                            {"xml", ProgressMode::xml},
                                            {"none", ProgressMode::none}}),
       OverrideGroup::process},
      {"xml", "", slicerGroup, "Print the XML description for 3D Slicer, and exit",
       ValueSpec::notInPanel(), OverrideGroup::process},
      {"echo", "", slicerGroup, "Print the parsed options", ValueSpec::notInPanel(),
       OverrideGroup::process},
      {"returnparameterfile", "FILE", slicerGroup, "Write result values as name = value lines",
       ValueSpec::notInPanel().bind(options.returnValues), OverrideGroup::process},
      {"processinformationaddress", "ADDRESS", slicerGroup,
       "Ignored; for modules inside Slicer's process", ValueSpec::notInPanel(),
       OverrideGroup::process},
  };
};

const RenderOptionTable defaultTable; // serves as syntax; no value is stored in it

} // namespace

const CommandSyntax renderSyntax = {
    "render",
    "Renders a medical volume by Monte Carlo path tracing, with a clipping surface that uncovers a "
    "focus segment. The word \"render\" is optional. Other commands: fenestra inspect, fenestra "
    "compare, fenestra phantom, fenestra serve, fenestra turntable, fenestra batch, fenestra "
    "merge, fenestra describe.",
    {{"INPUT", "Volume (.nrrd .nhdr .nii .nii.gz .mha .mhd), DICOM folder, or Slicer scene (.mrml "
               ".mrb)"}},
    defaultTable.rows,
};

RenderOptions readOptions(const OptionValues& values) {
  RenderOptionTable table;
  for (const Option& option : table.rows)
    if (option.spec.store && values.has(option.name))
      option.spec.store(values, option.name);
  return table.options;
}

bool isClipOption(const Option& option) {
  return option.group == clipGroup;
}

bool isAppearanceOption(const Option& option) {
  return isClipOption(option) || option.group == viewGroup || option.group == appearanceGroup;
}

} // namespace fenestra
