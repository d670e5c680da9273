#include "program/RenderFlags.h"

#include "program/ClipFlags.h"

#include "base/Error.h"
#include "base/safe/ShownText.h"
#include "files/looks/LookText.h"
#include "files/pictures/ImageFormat.h"
#include "files/slicer/SceneFiles.h"

#include <algorithm>

namespace fenestra {
namespace {

constexpr const char* sceneGroup = "What is shown";
constexpr const char* clipGroup = "What is clipped";
constexpr const char* viewGroup = "View";
constexpr const char* lookGroup = "Look";
constexpr const char* qualityGroup = "Quality";
constexpr const char* outputGroup = "More";
constexpr const char* slicerGroup = "3D Slicer's own";

constexpr double unlimited = 0x1p40; // limit of samples and of scatterings

constexpr Flag renderFlags[] = {
    {"segmentation", "FILE|NAME", sceneGroup,
     "Segments: a .seg.nrrd, any label map, or a node of the scene [the scene's]", Takes::labels()},
    {"focus", "A,B,...", sceneGroup,
     "Segments to show unoccluded, by id, name or label value (a comma in a name is \\,); may be "
     "repeated",
     Takes::list()},
    {"preset", "NAME|FILE|auto", sceneGroup,
     "Focus, look, view and clip of an anatomy in one: brain-surface, brain-tumour, fetal-face, "
     "foot-bones, heart, knee-cartilage, liver, lungs, spine, a .json, or auto (by the segments' "
     "names); other flags win over it"},
    {"output", "FILE", sceneGroup,
     "Picture: .png .tif (display), .exr (all channels), .nrrd (linear RGBA and depth); may be "
     "repeated [INPUT.png]",
     Takes::picture()},
    {"margin", "MM,...", clipGroup,
     "Grows the focus, or shrinks it (negative): one for all its segments together, or one "
     "each [0]",
     Takes::numbers()},
    {"labelsmoothing", "MM", clipGroup,
     "Smooths the focus's labels by a Gaussian of this deviation, against stair steps; thick "
     "slices are interpolated first [0]",
     Takes::number(0.0, 100.0), "0"},
    {"clip", "MODE", clipGroup,
     "none, plane, hole, cutaway, ghost, surface, or auto: surface with a focus, else none [auto]",
     Takes::word("auto|none|plane|hole|cutaway|ghost|surface"), "auto"},
    {"boundary", "KIND", clipGroup,
     "How the surface leaves the focus: spline (the paper's) or exact (with its depth and slope at "
     "every point) [spline]",
     Takes::word("spline|exact"), "spline"},
    {"controlpoints", "N", clipGroup, "Control points of the spline, 3 to 1000 [50]",
     Takes::whole(3, 1000), "50"},
    {"smoothing", "P", clipGroup,
     "Spline's p in mm, from 0 (a plane) to 1 (through the points) [0.5]", Takes::number(0.0, 1.0),
     "0.5"},
    {"plane", "OX,OY,OZ,NX,NY,NZ", clipGroup,
     "Clip plane in RAS mm; what the normal points at is removed [the focus's best plane]",
     Takes::numbers()},
    {"hole", "SHAPE", clipGroup, "Shape of --clip hole: box, cylinder or sphere [cylinder]",
     Takes::word("box|cylinder|sphere"), "cylinder"},
    {"holemargin", "MM", clipGroup, "How much wider than the focus a hole is [5]",
     Takes::number(0.0, 1e6), "5"},
    {"ghost", "SHARE", clipGroup, "Share of the extinction that --clip ghost leaves, 0 to 1 [0.1]",
     Takes::number(0.0, 1.0), "0.1"},
    {"offset", "MM", clipGroup,
     "Moves the cut away from the eye, into the focus, or toward it (negative) [0]",
     Takes::number(-1e6, 1e6), "0"},
    {"soft", "MM", clipGroup, "Matter comes back gradually over this depth behind the cut [0]",
     Takes::number(0.0, 1e6), "0"},
    {"contextdensity", "F", clipGroup,
     "Multiplies the extinction of everything that is not focus, 0 to 1 [1]",
     Takes::number(0.0, 1.0), "1"},
    {"contextsaturation", "S", clipGroup,
     "Colour of everything that is not focus, from 0 (grey) to 1 (as it is) [1]",
     Takes::number(0.0, 1.0), "1"},
    {"view", "NAME", viewGroup,
     "anterior, posterior, left, right, superior, inferior, or auto: the direction that shows most "
     "of the focus, least foreshortened, with least removed [the scene's camera, else anterior]",
     Takes::word("anterior|posterior|left|right|superior|inferior|auto"), "anterior"},
    {"position", "R,A,S", viewGroup, "Eye, mm", Takes::numbers()},
    {"target", "R,A,S", viewGroup, "Point looked at, mm [centre of the focus, else of the volume]",
     Takes::numbers()},
    {"up", "R,A,S", viewGroup, "Direction that is up in the picture", Takes::numbers()},
    {"projection", "KIND", viewGroup,
     "orthographic or perspective [the scene's, else orthographic]",
     Takes::word("orthographic|perspective"), "orthographic"},
    {"scale", "MM", viewGroup, "Orthographic: half the picture's height [frames the focus]",
     Takes::number(1e-9, 1e9)},
    {"angle", "DEGREES", viewGroup,
     "Perspective: full vertical angle [30, or less to frame the focus]",
     Takes::number(1e-6, 179.0)},
    {"transfer", "FILE|PRESET|JSON", lookGroup,
     "Transfer function: .vp, .vp.json, Fenestra .json or its text, a preset such as ct-soft, or a "
     "volume property of the scene or of 3D Slicer by name, such as CT-AAA [the scene's, else by "
     "modality]"},
    {"shift", "X", lookGroup, "Moves the transfer function along the scalar [0]",
     Takes::number(-1e30, 1e30), "0"},
    {"density", "D", lookGroup, "Multiplies the extinction, 0 to 1000 [1]",
     Takes::number(0.0, 1000.0), "1"},
    {"lights",
     "FILE|PRESET|JSON",
     lookGroup,
     "Lights: .json, studio, headlight, soft, or the text of a .json itself, {...} [studio]",
     {},
     "studio"},
    {"environment", "R,G,B|FILE", lookGroup,
     "Radiance from all around, or a latitude-longitude .exr; replaces the lights' own"},
    {"background", "R,G,B|KIND", lookGroup,
     "Linear colour (the photographic tone curve of a .png makes 1,1,1 light grey, 100,100,100 "
     "white), transparent or environment [the scene's, else 0,0,0]"},
    {"size", "WxH", qualityGroup, "Pixels [512x512]", {}, "512x512"},
    {"samples", "N", qualityGroup,
     "Stop at N samples a pixel [64 unless seconds or noise are given]",
     Takes::whole(1, unlimited)},
    {"seconds", "T", qualityGroup,
     "Stop after T seconds of rendering, but not before one sample a pixel",
     Takes::number(1e-3, 1e9)},
    {"noise", "E", qualityGroup,
     "Stop when the relative noise is at most E, for example 0.03; noisier pixels get more "
     "samples",
     Takes::number(1e-6, 1e6)},
    {"bounces", "B", qualityGroup, "Scatterings a path, at most (biased) [unlimited]",
     Takes::whole(0, unlimited)},
    {"seed", "S", qualityGroup, "Random seed [0]", Takes::whole(0, 0x1p64), "0"},
    {"threads", "K", qualityGroup, "Threads, at most one a core; 0 is all [0]",
     Takes::whole(0, 1024), "0"},
    {"volume", "NAME", outputGroup,
     "Which volume of a scene (name or id), or which series of a DICOM folder [as in Slicer]"},
    {"layers", "L,...", outputGroup,
     "Channels of an .exr: color, depth, clip, albedo, normal, error, samples; of a .nrrd: color, "
     "depth (a file of its own) [all]",
     Takes::list(), "color"},
    {"surface", "FILE", outputGroup,
     "Clipping surface as triangles in RAS mm, to a tenth of a pixel in depth (any --clip but none "
     "and plane): .vtp .ply (with depths) .stl",
     Takes::surface()},
    {"stats", "FILE", outputGroup, "Times, counts and measures as .json", Takes::report()},
    {"progress", "KIND", outputGroup, "auto, bar, xml (Slicer's tags) or none [auto]",
     Takes::word("auto|bar|xml|none"), "auto"},
    {"xml", "", slicerGroup, "Describe the flags to 3D Slicer, and exit", Takes::slicersOwn()},
    {"echo", "", slicerGroup, "Print the flags as they were understood", Takes::slicersOwn()},
    {"returnparameterfile", "FILE", slicerGroup, "Write what the render reached, a line each",
     Takes::slicersOwn()},
    {"processinformationaddress", "ADDRESS", slicerGroup,
     "For modules inside Slicer's process: ignored", Takes::slicersOwn()},
};

void refuseTogether(const FlagValues& flags, const char* a, const char* b) {
  if (flags.differs(a) && flags.differs(b))
    throw usageError(std::string("--") + a + " and --" + b + " contradict each other; give one");
}

ViewRequest viewRequest(const FlagValues& flags, bool sceneCamera) {
  refuseTogether(flags, "view", "position");
  ViewRequest view;
  if (const auto word = flags.word("projection"))
    view.projection = *word == "perspective" ? Projection::perspective : Projection::orthographic;
  view.name = flags.word("view");
  if (view.isAutomatic() && !flags.has("focus"))
    throw usageError("--view: auto looks for a focus; add --focus A,B,..., or name a direction");
  view.position = flags.triple("position");
  view.target = flags.triple("target");
  view.up = flags.triple("up");
  view.scale = flags.number("scale");
  view.angle = flags.number("angle");
  // A scene's camera may apply, whose projection is not known yet.
  if (sceneCamera && !view.projection && view.followsScene())
    return view;
  const bool perspective = view.projection == Projection::perspective;
  if (perspective && view.scale)
    throw usageError("--scale: only for --projection orthographic; use --angle");
  if (!perspective && view.angle)
    throw usageError("--angle: only for --projection perspective; use --scale");
  return view;
}

void readSize(const FlagValues& flags, SceneRequest& scene) {
  const auto text = flags.text("size");
  if (!text)
    return;
  constexpr int largest = 16384;
  int width = 0;
  int height = 0;
  char rest = 0;
  if (std::sscanf(text->c_str(), "%dx%d%c", &width, &height, &rest) != 2 || width < 1 ||
      height < 1 || width > largest || height > largest)
    throw usageError("--size: expected WIDTHxHEIGHT in pixels, each from 1 to " +
                     std::to_string(largest) + ", got '" + oneLine(*text) + "'");
  scene.width = width;
  scene.height = height;
}

bool isExr(const std::filesystem::path& path) {
  return imageFormat(path) == ImageFormat::exr;
}
bool isNrrd(const std::filesystem::path& path) {
  return imageFormat(path) == ImageFormat::nrrd;
}

/// Linear R,G,B; `otherwise`: the flag's other values, for the message.
Rgb color(const FlagValues& flags, const std::string& name, const std::string& otherwise) {
  constexpr double brightest = 1e12; // keeps products within a float's range
  const std::string text = *flags.text(name);
  const bool numbers = text.find_first_not_of("0123456789+-.,eE ") == std::string::npos;
  Rgb value = numbers ? Rgb(flags.triple(name)->array()) : Rgb::Constant(-1.0);
  if (value.minCoeff() < 0.0 || value.maxCoeff() > brightest)
    throw usageError("--" + name + ": expected R,G,B, each from 0 to 1e12, or " + otherwise +
                     ", got '" + oneLine(text) + "'");
  return value;
}

void readEnvironment(const FlagValues& flags, SceneRequest& scene) {
  const auto text = flags.text("environment");
  if (!text)
    return;
  if (isExr(*text))
    scene.environmentMap = *text;
  else
    scene.environment = color(flags, "environment", "an .exr file");
}

std::optional<Background> background(const FlagValues& flags) {
  const auto text = flags.text("background");
  if (!text)
    return std::nullopt;
  if (*text == "transparent")
    return Background{Background::Kind::transparent, Rgb::Zero()};
  if (*text == "environment")
    return Background{Background::Kind::environment, Rgb::Zero()};
  return Background{Background::Kind::color,
                    color(flags, "background", "transparent or environment")};
}

RenderSettings renderSettings(const FlagValues& flags) {
  RenderSettings settings;
  const bool otherStop = flags.has("seconds") || flags.has("noise");
  settings.samples = flags.count("samples").value_or(
      otherStop ? static_cast<std::uint64_t>(unlimited) : settings.samples);
  settings.seconds = flags.number("seconds").value_or(settings.seconds);
  settings.noise = flags.number("noise").value_or(settings.noise);
  settings.seed = flags.count("seed").value_or(0);
  settings.threads = static_cast<int>(flags.count("threads").value_or(0));
  settings.path.bounces = flags.count("bounces").value_or(settings.path.bounces);
  return settings;
}

ProgressMode progressMode(const FlagValues& flags) {
  const std::string word = flags.word("progress").value_or("auto");
  if (word == "bar")
    return ProgressMode::bar;
  if (word == "xml")
    return ProgressMode::xml;
  return word == "none" ? ProgressMode::none : ProgressMode::automatic;
}

/// INPUT.png in the current folder, without the input's own endings. Throws Error (usage) if no
/// name is left.
std::filesystem::path defaultOutput(const std::filesystem::path& input) {
  std::filesystem::path named = input.lexically_normal();
  if (!named.has_filename()) // folder name with a slash at its end
    named = named.parent_path();
  if (std::error_code failed; named.filename() == "." || named.filename() == "..")
    named = std::filesystem::canonical(named, failed);
  std::string name = named.filename().string();
  for (const char* ending : {".gz", ".nii", ".nrrd", ".nhdr", ".mha", ".mhd", ".mrml", ".mrb"})
    if (name.ends_with(ending))
      name.resize(name.size() - std::string_view(ending).size());
  if (name.empty())
    throw usageError("--output: is missing, and " + input.string() +
                     " gives the picture no name; add --output FILE.png");
  return name + ".png";
}

std::vector<std::filesystem::path> inputFiles(const FlagValues& flags) {
  std::vector<std::filesystem::path> files;
  for (const char* name : {"INPUT", "segmentation", "preset", "transfer", "lights", "environment"})
    if (const auto file = flags.text(name); file && !isLookText(*file))
      files.emplace_back(*file);
  return files;
}

/// File of the clipping surface. Throws Error (usage) unless the clip is by depth.
std::optional<std::filesystem::path> surfaceFile(const FlagValues& flags,
                                                 const SceneRequest& scene) {
  const auto file = flags.text("surface");
  if (file && !isDepthClip(scene.clip.modeWith(!scene.focus.empty())))
    throw usageError("--surface: --clip none and plane have none; add --focus A,B,... without "
                     "another --clip, or drop it");
  return file;
}

void readOutputs(const FlagValues& flags, RenderOptions& options) {
  for (const std::string& file : flags.texts("output"))
    options.outputs.emplace_back(file);
  if (options.outputs.empty()) {
    options.outputs.push_back(defaultOutput(options.scene.input));
    options.outputsNamedBy = NamedBy::standard;
  }
  options.surface = surfaceFile(flags, options.scene);
  options.stats = flags.text("stats");
  options.scene.measure = options.stats.has_value();
  options.layers = layerSet(flags.list("layers"));
  const auto exrs = std::count_if(options.outputs.begin(), options.outputs.end(), isExr);
  const auto nrrds = std::count_if(options.outputs.begin(), options.outputs.end(), isNrrd);
  if (exrs + nrrds == 0 && flags.differs("layers"))
    throw usageError("--layers: only .exr and .nrrd have them; add --output FILE.exr");
  for (const std::filesystem::path& path : options.outputs)
    if (!options.layers.color && !isExr(path))
      throw usageError("--layers: " + path.string() + " needs color; add it, or write .exr alone");
  options.settings.path.wantNormals = exrs > 0 && options.layers.normal;
}

} // namespace

const CommandSyntax renderSyntax = {
    "render",
    "Renders a medical volume by Monte Carlo path tracing; a focus segment is shown unoccluded by "
    "a clipping surface. \"render\" may be left out. Other subcommands: fenestra inspect, fenestra "
    "compare, fenestra phantom, fenestra serve, fenestra turntable.",
    {{"INPUT", "Volume (.nrrd .nhdr .nii .nii.gz .mha .mhd), DICOM folder, or Slicer scene (.mrml "
               ".mrb)"}},
    renderFlags,
};

bool shapesPicture(const Flag& flag) {
  static constexpr std::string_view others[] = {"output", "layers",  "surface",
                                                "stats",  "threads", "progress"};
  return flag.takes.kind != Takes::Kind::slicersOwn &&
         std::find(std::begin(others), std::end(others), flag.name) == std::end(others);
}

bool shapesLook(const Flag& flag) {
  const std::string_view group = flag.group;
  return group == clipGroup || group == viewGroup || group == lookGroup;
}

RenderOptions renderOptions(const FlagValues& flags) {
  RenderOptions options;
  SceneRequest& scene = options.scene;
  scene.input = *flags.text("INPUT");
  scene.volume = flags.text("volume");
  scene.segmentation = flags.text("segmentation");
  scene.focus = flags.list("focus");
  const bool isScene = isSceneFile(scene.input);
  if (scene.volume && !isScene && !isFolder(scene.input))
    throw usageError("--volume: only a scene or a DICOM folder holds several; drop it");
  if (!scene.focus.empty() && !scene.segmentation && !isScene)
    throw usageError("--focus: needs --segmentation FILE to find segments in");
  options.preset = flags.text("preset");
  if (scene.segmentation && scene.focus.empty())
    throw usageError(
        "--segmentation: only --focus and --preset use it; add --focus A,B,... or --preset auto");
  scene.transfer = flags.text("transfer");
  scene.shift = flags.number("shift").value_or(0.0);
  scene.density = flags.number("density").value_or(1.0);
  scene.lights = flags.text("lights").value_or(scene.lights);
  readEnvironment(flags, scene);
  scene.view = viewRequest(flags, isScene);
  scene.clip = clipRequest(flags);
  scene.focusLook = focusRequest(flags);
  readSize(flags, scene);

  options.settings = renderSettings(flags);
  options.background = background(flags);
  options.inputs = inputFiles(flags);
  readOutputs(flags, options);
  options.returnValues = flags.text("returnparameterfile");
  options.progress = progressMode(flags);
  if (options.returnValues && options.progress == ProgressMode::automatic)
    options.progress = ProgressMode::xml;
  return options;
}

RenderSettings settingsFor(const RenderOptions& options, const std::optional<Background>& scene) {
  RenderSettings settings = options.settings;
  settings.path.background = options.background.value_or(scene.value_or(settings.path.background));
  return settings;
}

} // namespace fenestra
