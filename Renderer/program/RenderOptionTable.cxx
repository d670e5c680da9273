#include "program/RenderOptions.h"

#include "base/Error.h"
#include "files/images/ImageFormat.h"
#include "io/MessageText.h"
#include "scene/NamedPresets.h"

#include <algorithm>
#include <cstdio>

namespace fenestra {
namespace {

constexpr const char* sceneGroup = "What is shown";
constexpr const char* clipGroup = "What is clipped";
constexpr const char* viewGroup = "View";
constexpr const char* appearanceGroup = "Look";
constexpr const char* qualityGroup = "Quality";
constexpr const char* outputGroup = "More";
constexpr const char* slicerGroup = "3D Slicer's own";

// ---- values of a form of their own

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

/// R,G,B, or one number for all three; `otherwise`: the flag's other values, for the message.
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
    throw usageError("--", name, ": expected R,G,B, or one number for grey, from 0 to 1e12, or ",
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
    throw usageError("--", name, ": expected K/N, the K-th of N parts, from 1/1 to ", maxShards,
                     "/", maxShards, ", got '", toOneLine(text), "'");
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

/// Names of the program's own presets, and others.
std::vector<std::string> presetNames(const std::string& kind,
                                     const std::vector<std::string>& others) {
  std::vector<std::string> names = listBuiltinPresets(kind);
  std::ranges::copy(others, std::back_inserter(names));
  return names;
}

// ---- the table

/// Flags with the places of their values: the members of `options`, at first the defaults.
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
       "Segments: a .seg.nrrd, any label map, or a node of the scene [the scene's]",
       ValueSpec::labels().bind(scene.segmentation), OverrideGroup::focus},
      {"labels", "FILE|NAME", sceneGroup,
       "Names of a label map's values: a .ctbl, .label, .json or .csv, or one of totalsegmentator, "
       "totalsegmentator1, totalsegmentator2, freesurfer [in or beside the label map]",
       ValueSpec::text()
           .bind(scene.labels)
           .withNamedValues(presetNames("labels", {"totalsegmentator"})),
       OverrideGroup::focus},
      {"focus", "A,B,...", sceneGroup,
       "Segments to show unoccluded, by id, name or label value (a comma in a name is \\,); may be "
       "repeated",
       ValueSpec::list().bind(scene.focus), OverrideGroup::focus},
      {"preset", "NAME|FILE|auto", sceneGroup,
       concat("Focus, look, view and clip of an anatomy in one: ",
              join(listBuiltinPresets("presets"), ", "),
              ", a .json, or auto (by the segments' names); other flags win over it"),
       ValueSpec::text().bind(options.preset).withNamedValues(presetNames("presets", {"auto"}))},
      {"output", "FILE", sceneGroup,
       "Picture: .png .tif (display), .exr (all channels), .nrrd (linear RGBA and depth); may be "
       "repeated [INPUT.png]",
       ValueSpec::outputImage().bind(options.outputs), OverrideGroup::process},
      {"margin", "MM,...", clipGroup,
       "Grows the focus, or shrinks it (negative): one for all its segments together, or one "
       "each [0]",
       ValueSpec::numbers().bind(focus.shaping.margins, readMargins), OverrideGroup::focus,
       Requires::focus},
      {"labelsmoothing", "MM", clipGroup,
       "Smooths the labels of focus and materials by a Gaussian of this deviation, against stair "
       "steps; thick slices are interpolated first; auto: 0.6 of a voxel's longest edge, not for "
       "thin parts",
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
       "How the surface leaves the focus: spline (the paper's) or exact (with its depth and slope "
       "at every point)",
       ValueSpec::choice(surface.boundary,
                         {{"spline", Boundary::spline}, {"exact", Boundary::exact}}),
       OverrideGroup::boundary, Requires::surface},
      {"controlpoints", "N", clipGroup, "Control points of the spline, 3 to 1000",
       ValueSpec::integer(3, 1000).bind(surface.controlPoints), OverrideGroup::boundary,
       Requires::spline},
      {"smoothing", "P", clipGroup, "Spline's p in mm, from 0 (a plane) to 1 (through the points)",
       ValueSpec::number(0.0, 1.0).bind(surface.smoothing), OverrideGroup::boundary,
       Requires::spline},
      {"plane", "OX,OY,OZ,NX,NY,NZ", clipGroup,
       "Clip plane in RAS mm; what the normal points at is removed [the focus's best plane]",
       ValueSpec::numbers().bind(clip.plane, readPlane), OverrideGroup::clip, Requires::plane},
      {"hole", "SHAPE", clipGroup, "Shape of --clip hole: box, cylinder or sphere",
       ValueSpec::choice(surface.hole.shape, {{"box", HoleShape::box},
                                              {"cylinder", HoleShape::cylinder},
                                              {"sphere", HoleShape::sphere}}),
       OverrideGroup::clip, Requires::hole},
      {"holemargin", "MM", clipGroup, "How much wider than the focus a hole is",
       ValueSpec::number(0.0, 1e6).bind(surface.hole.margin), OverrideGroup::clip, Requires::hole},
      {"ghost", "SHARE", clipGroup, "Share of the extinction that --clip ghost leaves, 0 to 1",
       ValueSpec::number(0.0, 1.0).bind(clip.ghost), OverrideGroup::clip, Requires::ghost},
      {"offset", "MM", clipGroup,
       "Moves the cut away from the eye, into the focus, or toward it (negative)",
       ValueSpec::number(-1e6, 1e6).bind(surface.offset), OverrideGroup::clip, Requires::clip},
      {"soft", "MM", clipGroup,
       "Matter comes back gradually over this depth behind the cut; auto: as for --labelsmoothing, "
       "with --clip surface, hole and cutaway, else 0",
       ValueSpec::numberOrAuto(clip.softness, 0.0, 1e6, 0.0), OverrideGroup::clip, Requires::clip},
      {"contextdensity", "F", clipGroup,
       "Multiplies the extinction of everything that is not focus, 0 to 1",
       ValueSpec::number(0.0, 1.0).bind(focus.contextExtinction), OverrideGroup::own,
       Requires::focus},
      {"contextsaturation", "S", clipGroup,
       "Colour of everything that is not focus, from 0 (grey) to 1 (as it is); auto: the "
       "first of 1, 0.35 and 0 with which the focus is told from its surroundings; 1 with "
       "materials",
       ValueSpec::numberOrAuto(focus.contextSaturation, 0.0, 1.0, 1.0), OverrideGroup::own,
       Requires::focus},
      {"view", "NAME", viewGroup,
       "anterior, posterior, left, right, superior, inferior, or auto: the direction that shows "
       "most of the focus, least foreshortened, with least removed [the scene's camera, else "
       "anterior]",
       ValueSpec::choice({"anterior", "posterior", "left", "right", "superior", "inferior", "auto"})
           .bind(view.name)
           .withDefault("anterior"),
       OverrideGroup::viewpoint},
      {"position", "R,A,S", viewGroup, "Eye, mm", ValueSpec::numbers().bind(view.position),
       OverrideGroup::viewpoint},
      {"target", "R,A,S", viewGroup,
       "Point looked at, mm [focus's centre, higher or lower at an end of the scan; else volume's]",
       ValueSpec::numbers().bind(view.target), OverrideGroup::view},
      {"up", "R,A,S", viewGroup, "Direction that is up in the picture",
       ValueSpec::numbers().bind(view.up), OverrideGroup::view},
      {"projection", "KIND", viewGroup,
       "orthographic or perspective [the scene's, else orthographic]",
       ValueSpec::choice(view.projection, {{"orthographic", Projection::orthographic},
                                           {"perspective", Projection::perspective}})
           .withDefault("orthographic"),
       OverrideGroup::extent},
      {"scale", "MM", viewGroup,
       "Orthographic: half the picture's height [frames the focus, else all that is visible]",
       ValueSpec::number(1e-9, 1e9).bind(view.scale), OverrideGroup::extent},
      {"angle", "DEGREES", viewGroup,
       "Perspective: full vertical angle [30, or less to frame the focus]",
       ValueSpec::number(1e-6, 179.0).bind(view.angle), OverrideGroup::extent},
      {"transfer", "FILE|PRESET|JSON", appearanceGroup,
       "Transfer function: .vp, .vp.json, Fenestra .json or its text, a preset such as ct-soft, or "
       "a volume property of the scene or of 3D Slicer by name, such as CT-AAA [the scene's, else "
       "by modality]",
       ValueSpec::text().bind(scene.transfer).withNamedValues(listBuiltinPresets("transfer"))},
      {"shift", "X", appearanceGroup, "Moves the transfer function along the scalar",
       ValueSpec::number(-1e30, 1e30).bind(scene.shift)},
      {"density", "D", appearanceGroup, "Multiplies the extinction, 0 to 1000",
       ValueSpec::number(0.0, 1000.0).bind(scene.density)},
      {"materials", "none|auto|library|FILE", appearanceGroup,
       "Colours of the segments by what they are made of: Fenestra's library, or a .json over it; "
       "auto: the library's, changed until the focus is told from its neighbours; surfaces stay "
       "the data's [auto with a focus of which something is known and without "
       "--contextsaturation, else none]",
       ValueSpec::text().bind(scene.materials).withNamedValues({"none", "auto", "library"}),
       OverrideGroup::materials},
      {"material", "TEXT", appearanceGroup,
       "Changes the material of one segment, such as \"Liver: color=#963e2e\" or \"Aorta: "
       "clip=no\", "
       "which then stays where all else is clipped; may be repeated",
       ValueSpec::texts().bind(scene.materialChanges, readTexts), OverrideGroup::materials},
      {"lights", "FILE|PRESET|JSON", appearanceGroup,
       "Lights: .json, cinema, studio, headlight, soft, amber, or the text of a .json itself, "
       "{...}",
       ValueSpec::text().bind(scene.lights).withNamedValues(listBuiltinPresets("lights")),
       OverrideGroup::lights},
      {"environment", "R,G,B|GREY|FILE", appearanceGroup,
       "Radiance from all around, or a latitude-longitude .exr; replaces the lights' own",
       ValueSpec::text().bind(scene, readEnvironment), OverrideGroup::lights},
      {"background", "R,G,B|GREY|KIND", appearanceGroup,
       "Linear colour (the tone curve of a .png makes 1,1,1 light grey, 100,100,100 "
       "white), gradient (dark greys), transparent or environment [the scene's, else gradient]",
       ValueSpec::text()
           .bind(options.background, readBackground)
           .withNamedValues({"gradient", "transparent", "environment"})},
      {"exposure", "EV", appearanceGroup,
       "Stops, -16 to 16, by which .png and .tif are shown brighter or darker; .exr and .nrrd stay",
       ValueSpec::number(-16.0, 16.0).bind(options.display.exposure)},
      {"tone", "CURVE", appearanceGroup,
       "Tone curve of .png and .tif: film (more contrast, colours keep their hue) or photographic "
       "(dark and middle values as they are, for measuring)",
       ValueSpec::choice(options.display.view, {{"film", DisplayView::film},
                                                {"photographic", DisplayView::photographic}})},
      {"size", "WxH", qualityGroup, "Pixels",
       ValueSpec::text()
           .bind(scene, readSize)
           .withDefault(std::to_string(scene.width) + "x" + std::to_string(scene.height))},
      {"samples", "N", qualityGroup,
       "Stop at N samples a pixel [" + std::to_string(settings.samples) +
           " unless seconds or noise are given]",
       ValueSpec::integer(1, unlimited).bind(settings.samples).withDefault(""),
       OverrideGroup::stop},
      {"seconds", "T", qualityGroup,
       "Stop after T seconds of rendering, but not before one sample a pixel",
       ValueSpec::number(1e-3, 1e9).bind(settings.seconds).withDefault(""), OverrideGroup::stop},
      {"noise", "E", qualityGroup, "Stop when the relative noise is at most E, for example 0.03",
       ValueSpec::number(1e-6, 1e6).bind(settings.noise).withDefault(""), OverrideGroup::stop},
      {"noisetarget", "KIND", qualityGroup,
       "Which noise --noise means: raw (of the samples; noisier pixels get more), filtered (what "
       "the "
       "filter tells of its own error), or auto: filtered if all outputs are .png or .tif",
       ValueSpec::choice(options.noiseTarget, {{"auto", NoiseTarget::automatic},
                                               {"raw", NoiseTarget::raw},
                                               {"filtered", NoiseTarget::filtered}}),
       OverrideGroup::stop},
      {"denoise", "KIND", qualityGroup,
       "auto: filter .png and .tif, for the eye, and leave colours of .exr and .nrrd raw; on: "
       "filtered channels in these, too, beside the raw ones; off",
       ValueSpec::choice(
           options.denoise,
           {{"auto", Denoise::automatic}, {"on", Denoise::on}, {"off", Denoise::off}})},
      {"bounces", "B", qualityGroup, "Scatterings a path, at most (biased) [unlimited]",
       ValueSpec::integer(0, unlimited).bind(settings.path.bounces).withDefault("")},
      {"seed", "S", qualityGroup, "Random seed", ValueSpec::integer(0, 0x1p64).bind(settings.seed)},
      {"sampling", "KIND", qualityGroup,
       "strata: a pixel's samples share out the numbers that decide most of its noise, eight by "
       "eight; independent: they share nothing (noisier). Both are unbiased",
       ValueSpec::choice(settings.sampling, {{"strata", Sampling::stratified},
                                             {"independent", Sampling::independent}})},
      {"threads", "K", qualityGroup, "Threads, at most one a core; 0 is all",
       ValueSpec::integer(0, 1024).bind(settings.threads), OverrideGroup::process},
      {"volume", "NAME", outputGroup,
       "Which volume of a scene (name or id), or which series of a DICOM folder [as in Slicer]",
       ValueSpec::text().bind(scene.volume)},
      // Slicer takes one file, hence colour alone in its panel.
      {"layers", "L,...", outputGroup,
       "Channels of an .exr: color, depth, clip, albedo, normal, error, samples, and with "
       "--denoise "
       "on denoised, expected; of a .nrrd: color, depth and denoised (files of their own) [all]",
       ValueSpec::list()
           .bind(options.layers, readLayers)
           .withDefault("color")
           .withNamedValues({allLayers.begin(), allLayers.end()}),
       OverrideGroup::process},
      {"surface", "FILE", outputGroup,
       "Clipping surface as triangles in RAS mm, to a tenth of a pixel in depth (any --clip but "
       "none and plane): .vtp .ply (with depths) .stl",
       ValueSpec::surface().bind(options.surface), OverrideGroup::process},
      {"stats", "FILE", outputGroup, "Times, counts and measures as .json",
       ValueSpec::jsonFile().bind(options.stats), OverrideGroup::process},
      {"checkpoint", "FILE", outputGroup,
       "Keeps what is rendered so far in this film (.film), so that the same command goes on after "
       "a stop, a crash or a power cut, and ends with the same picture; --samples, --noise, "
       "--seconds, --threads and outputs may change",
       ValueSpec::checkpointFile().bind(options.checkpoint), OverrideGroup::process},
      {"shard", "K/N", outputGroup,
       "Renders the K-th of N parts of the picture alone, for fenestra merge: --checkpoint names "
       "the part's film; of a turntable, the frames of that part",
       ValueSpec::text().bind(options, readShard), OverrideGroup::process},
      {"progress", "KIND", outputGroup, "auto, bar, xml (Slicer's tags) or none",
       ValueSpec::choice(options.progress, {{"auto", ProgressMode::automatic},
                                            {"bar", ProgressMode::bar},
                                            {"xml", ProgressMode::xml},
                                            {"none", ProgressMode::none}}),
       OverrideGroup::process},
      {"xml", "", slicerGroup, "Describe the flags to 3D Slicer, and exit", ValueSpec::notInPanel(),
       OverrideGroup::process},
      {"echo", "", slicerGroup, "Print the flags as they were understood", ValueSpec::notInPanel(),
       OverrideGroup::process},
      {"returnparameterfile", "FILE", slicerGroup, "Write what the render reached, a line each",
       ValueSpec::notInPanel().bind(options.returnValues), OverrideGroup::process},
      {"processinformationaddress", "ADDRESS", slicerGroup,
       "For modules inside Slicer's process: ignored", ValueSpec::notInPanel(),
       OverrideGroup::process},
  };
};

const RenderOptionTable defaultTable; // nobody fills its places

} // namespace

const CommandSyntax renderSyntax = {
    "render",
    "Renders a medical volume by Monte Carlo path tracing; a focus segment is shown unoccluded by "
    "a clipping surface. \"render\" may be left out. Other subcommands: fenestra inspect, fenestra "
    "compare, fenestra phantom, fenestra serve, fenestra turntable, fenestra study, fenestra "
    "merge, "
    "fenestra describe.",
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
