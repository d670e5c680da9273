#include "program/RenderOptions.h"

#include "program/PaperConditions.h"
#include "program/Quality.h"
#include "program/RenderOptionValues.h"
#include "scene/NamedPresets.h"

#include <algorithm>

namespace fenestra::core {
namespace {

constexpr const char* sceneGroup = "Input and focus";
constexpr const char* clipGroup = "Clipping";
constexpr const char* viewGroup = "View";
constexpr const char* appearanceGroup = "Appearance";
constexpr const char* qualityGroup = "Quality";
constexpr const char* outputGroup = "Output";
constexpr const char* slicerGroup = ""; ///< only in --xml and its users

constexpr OptionGroup groupTable[] = {
    {"input", sceneGroup},           {"clip", clipGroup},       {"view", viewGroup},
    {"appearance", appearanceGroup}, {"quality", qualityGroup}, {"output", outputGroup},
};

/// Names of built-in presets, and of others.
std::vector<std::string> presetNames(const std::string& kind,
                                     const std::vector<std::string>& others) {
  std::vector<std::string> names = listBuiltinPresets(kind);
  std::ranges::copy(others, std::back_inserter(names));
  return names;
}

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
      {OptionNames("segmentation", 's'), "FILE|NAME", sceneGroup,
       "Segmentation of the volume: a .seg.nrrd, DICOM SEG or RTSTRUCT file, a label map or "
       "probability map, a folder of masks with one structure per file, or a segmentation of the "
       "scene, by name or id [the scene's]",
       ValueSpec::labels().bind(scene.segmentation), OverrideGroup::focus},
      {"labels", "FILE|NAME", sceneGroup,
       "Names of label values: a .ctbl, .txt, .label, .json, .csv or .tsv file, or "
       "totalsegmentator, "
       "totalsegmentator1, totalsegmentator2 or freesurfer [in or beside the label map]",
       ValueSpec::text()
           .bind(scene.labels)
           .withNamedValues(presetNames("labels", {"totalsegmentator"})),
       OverrideGroup::focus},
      {"focus", "A,B,...", sceneGroup,
       "Segments to show unobstructed: names, ids or label values, separated by commas (write a "
       "comma in a name as \\,); may be repeated",
       ValueSpec::list().bind(scene.focus), OverrideGroup::focus},
      {"preset", "NAME|FILE|auto", sceneGroup,
       concat("Focus and view, and possibly other options, for one anatomy: ",
              join(listBuiltinPresets("presets"), ", "),
              ", a .json file, or auto (chosen by the segment names); other options override it"),
       ValueSpec::text()
           .bind(options.preset)
           .withNamedValues(presetNames("presets", {"auto"}))
           .withAliases({{"brain-tumour", "brain-tumor"}})},
      {OptionNames("output", 'o'), "FILE", sceneGroup,
       "Image to write: .png or .tif (for display), .exr (all channels) or .nrrd (linear RGBA, and "
       "depth); may be repeated [INPUT.png]",
       ValueSpec::outputImage().bind(options.outputs), OverrideGroup::process},
      {"paper", "", sceneGroup, describePaperConditions(), ValueSpec::notInPanel()},
      {"margin", "MM,...", clipGroup,
       "Grows the focus by this distance, or shrinks it (negative): one value for all its "
       "segments, or one per segment; auto: in CT, removes what is another tissue",
       ValueSpec::text().withNamedValues({"auto"}).withDefault("auto").bind(focus, readMargins),
       OverrideGroup::focus, Requires::focus},
      {"label-smoothing", "MM", clipGroup,
       "Smooths the segments by a Gaussian of this standard deviation; thick slices are "
       "interpolated first; auto: 1.25 times the edge of the voxels on which they were made, at "
       "equal volume, and 0.4 times that for thin parts and narrow gaps",
       ValueSpec::numberOrAuto(focus.shaping.smoothing, 0.0, 100.0, 0.0), OverrideGroup::own,
       Requires::labels},
      {"clip", "MODE", clipGroup,
       "What is removed in front of the focus: none; plane; hole (a box, cylinder or sphere); "
       "cutaway (all that hides it); ghost (as surface, but faded); surface (all in front of a "
       "smooth surface through the focus); auto: surface with a focus, else none",
       ValueSpec::choice(clip.mode, {{"auto", std::nullopt},
                                     {"none", ClipMode::none},
                                     {"plane", ClipMode::plane},
                                     {"hole", ClipMode::hole},
                                     {"cutaway", ClipMode::cutaway},
                                     {"ghost", ClipMode::ghost},
                                     {"surface", ClipMode::surface}}),
       OverrideGroup::clip},
      {OptionNames("clip-boundary", "boundary"), "KIND", clipGroup,
       "How the clipping surface meets the outline of the focus: spline (approximately) or exact "
       "(with equal depth and slope)",
       ValueSpec::choice(surface.boundary,
                         {{"spline", Boundary::spline}, {"exact", Boundary::exact}}),
       OverrideGroup::boundary, Requires::surface},
      {"control-points", "N", clipGroup,
       "Control points of the clipping spline, on the outline of the focus, 3 to 1000",
       ValueSpec::integer(3, 1000).bind(surface.controlPoints), OverrideGroup::boundary,
       Requires::spline},
      {OptionNames("spline-smoothing", "smoothing"), "P", clipGroup,
       "Smoothing parameter p of the clipping spline, from 0 (a plane) to 1 (through all control "
       "points)",
       ValueSpec::number(0.0, 1.0).bind(surface.smoothing), OverrideGroup::boundary,
       Requires::spline},
      {"plane", "OX,OY,OZ,NX,NY,NZ", clipGroup,
       "Clip plane: a point on it and its normal, RAS, mm; the side that the normal points to is "
       "removed [fitted to the focus]",
       ValueSpec::numbers().bind(clip.plane, readPlane), OverrideGroup::clip, Requires::plane},
      {"hole", "SHAPE", clipGroup, "Shape of the hole of --clip hole: box, cylinder or sphere",
       ValueSpec::choice(surface.hole.shape, {{"box", HoleShape::box},
                                              {"cylinder", HoleShape::cylinder},
                                              {"sphere", HoleShape::sphere}}),
       OverrideGroup::clip, Requires::hole},
      {"hole-margin", "MM", clipGroup, "Distance from the focus to the wall of the hole",
       ValueSpec::number(0.0, 1e6).bind(surface.hole.margin), OverrideGroup::clip, Requires::hole},
      {"ghost", "FRACTION", clipGroup,
       "Fraction of the opacity per mm that --clip ghost leaves in front of the focus, 0 to 1",
       ValueSpec::number(0.0, 1.0).bind(clip.ghost), OverrideGroup::clip, Requires::ghost},
      {OptionNames("clip-offset", "offset"), "MM", clipGroup,
       "Moves the cut away from the camera (into the focus) or, if negative, toward it",
       ValueSpec::number(-1e6, 1e6).bind(surface.offset), OverrideGroup::clip, Requires::clip},
      {OptionNames("clip-softness", "soft"), "MM", clipGroup,
       "Depth behind the cut over which the volume fades in; auto: 0.6 for --clip surface, hole "
       "and cutaway, else 0",
       ValueSpec::numberOrAuto(clip.softness, 0.0, 1e6, 0.0), OverrideGroup::clip, Requires::clip},
      {"context-density", "F", clipGroup,
       "Opacity of everything but the focus: factor on its extinction, 0 (invisible) to 1",
       ValueSpec::number(0.0, 1.0).bind(focus.contextExtinction), OverrideGroup::own,
       Requires::focus},
      {"context-saturation", "S", clipGroup,
       "Color saturation of everything but the focus, 0 (gray) to 1 (unchanged); auto: "
       "0.75, or as --materials contrast finds necessary",
       ValueSpec::numberOrAuto(focus.contextSaturation, 0.0, 1.0, 1.0), OverrideGroup::own,
       Requires::focus},
      {"view", "NAME", viewGroup,
       "Side that the camera looks from: anterior, posterior, left, right, superior, inferior, or "
       "auto: the direction that shows most of the focus, with the least foreshortening and the "
       "least removed [the scene's camera, else anterior]",
       ValueSpec::choice({"anterior", "posterior", "left", "right", "superior", "inferior", "auto"})
           .bind(view.name)
           .withDefault("anterior"),
       OverrideGroup::viewpoint},
      {"position", "R,A,S", viewGroup, "Position of the camera, RAS, mm",
       ValueSpec::numbers().bind(view.position), OverrideGroup::viewpoint},
      {"target", "R,A,S", viewGroup,
       "Point that the camera looks at, RAS, mm [center of the focus, shifted if that is at an end "
       "of the scan; else center of the volume]",
       ValueSpec::numbers().bind(view.target), OverrideGroup::view},
      {"up", "R,A,S", viewGroup, "Direction that is up in the image, RAS",
       ValueSpec::numbers().bind(view.up), OverrideGroup::view},
      {"projection", "KIND", viewGroup,
       "orthographic (parallel rays) or perspective [the scene's, else orthographic]",
       ValueSpec::choice(view.projection, {{"orthographic", Projection::orthographic},
                                           {"perspective", Projection::perspective}})
           .withDefault("orthographic"),
       OverrideGroup::extent},
      {"scale", "MM", viewGroup,
       "Orthographic projection: half the height of the image, mm [fits the focus, else everything "
       "visible]",
       ValueSpec::number(1e-9, 1e9).bind(view.scale), OverrideGroup::extent},
      {"angle", "DEGREES", viewGroup,
       "Perspective projection: vertical angle of view [30, or less to fit the focus]",
       ValueSpec::number(1e-6, 179.0).bind(view.angle), OverrideGroup::extent},
      {"transfer", "FILE|PRESET|JSON", appearanceGroup,
       "Transfer function, which gives voxel values color and opacity: a .vp, .vp.json or Fenestra "
       ".json file, inline JSON, a preset such as ct-anatomy, or a volume property of the scene or "
       "of 3D Slicer by name, such as CT-AAA [the scene's, else by modality]",
       ValueSpec::text()
           .bind(scene.transfer)
           .withNamedValues(listBuiltinPresets("transfer"))
           .withAliases({{"ct-liver", "ct-anatomy"},
                         {"ct-heart", "ct-contrast"},
                         {"mr-brain", "mr-anatomy"}})},
      {OptionNames("transfer-shift", "shift"), "X", appearanceGroup,
       "Shifts the transfer function to higher (or lower) voxel values",
       ValueSpec::number(-1e30, 1e30).bind(scene.shift)},
      {OptionNames("density-scale", "density"), "D", appearanceGroup,
       "Opacity of the whole volume: factor on its extinction, 0 to 1000",
       ValueSpec::number(0.0, 1000.0).bind(scene.density)},
      {"gradient", "KIND", appearanceGroup,
       "Gradient of the voxel values that gives surfaces and their normals: sobel (3x3x3 voxels, "
       "smoother) or central (differences between opposite neighbors, as in VTK); gradient opacity "
       "is always central",
       ValueSpec::choice(scene.gradient,
                         {{"sobel", GradientKind::sobel}, {"central", GradientKind::central}})},
      {"volume-smoothing", "auto|off|N", appearanceGroup,
       "Smooths the volume by non-local means, for all outputs alike: off, N (standard deviation "
       "of the noise, in scalar units, such as HU), or auto: by the estimated noise, if an output "
       "is .png or .tif; a render that resumes from a checkpoint stays raw or smoothed",
       ValueSpec::text()
           .bind(options.smoothing, readVolumeSmoothing)
           .withDefault("auto")
           .withNamedValues({"auto", "off"})},
      {"table", "auto|keep|remove", appearanceGroup,
       "The table of the scanner: remove it, with what is below its top but for segments, keep it, "
       "or auto: remove it from CT if it is found with certainty",
       ValueSpec::choice(scene.table, {{"auto", TableRequest::automatic},
                                       {"keep", TableRequest::keep},
                                       {"remove", TableRequest::remove}})},
      {"materials", "none|library|contrast|FILE", appearanceGroup,
       "Segment colors by material: none, library (Fenestra's), a .json file that extends the "
       "library, or contrast: library colors, adjusted so that the focus is distinguishable; "
       "opacity and surfaces are unaffected [library in CT if the material of the focus is known, "
       "else none]",
       ValueSpec::text()
           .bind(scene.materials, readWord)
           .withNamedValues({"none", "library", "contrast"})
           .withAliases({{"auto", "contrast"}}),
       OverrideGroup::materials},
      {"material", "TEXT", appearanceGroup,
       "Changes the material of one segment, such as \"Liver: color=#963e2e\" or \"Aorta: "
       "clip=no\" (exempt from clipping), of the library or --materials; may be repeated",
       ValueSpec::texts().bind(scene.materialChanges, readTexts), OverrideGroup::materials},
      {"lights", "FILE|PRESET|JSON", appearanceGroup,
       "Lights: theatre-wet (with highlights), theatre, cinema, studio, headlight, soft, amber, a "
       ".json file, or inline JSON, {...} [theatre-wet with a focus, else theatre]",
       ValueSpec::text().bind(scene.lights).withNamedValues(listBuiltinPresets("lights")),
       OverrideGroup::lights},
      {"environment", "R,G,B|GRAY|FILE", appearanceGroup,
       "Light from all directions: its radiance, or a latitude-longitude .exr image; replaces the "
       "environment of --lights",
       ValueSpec::text().bind(scene, readEnvironment), OverrideGroup::lights},
      {"background", "R,G,B|GRAY|KIND", appearanceGroup,
       "Color behind the volume, linear (the tone curve of a .png maps 1,1,1 to light gray, "
       "100,100,100 to white), dark (nearly black), gradient (dark grays), gray, transparent or "
       "environment [the scene's, else dark]",
       ValueSpec::text()
           .bind(options.background, readBackground)
           .withNamedValues({"dark", "gradient", "gray", "transparent", "environment"})},
      {"exposure", "EV", appearanceGroup,
       "Brightness of .png and .tif in stops (1 doubles it), -16 to 16; .exr and .nrrd are "
       "unaffected",
       ValueSpec::number(-16.0, 16.0).bind(options.display.exposure)},
      {"tone", "CURVE", appearanceGroup,
       "Tone curve of .png and .tif: film (more contrast, preserves hue) or photographic "
       "(preserves dark and middle values, for measuring)",
       ValueSpec::choice(options.display.view, {{"film", DisplayView::film},
                                                {"photographic", DisplayView::photographic}})},
      {"annotate", "MARK,...", appearanceGroup,
       "Marks on .png and .tif: scale (a bar with its length in mm, for an orthographic "
       "projection), orientation (R/L, A/P, S/I at the edges: the sides of the patient), or none",
       ValueSpec::list()
           .bind(options.display.annotations, readAnnotations)
           .withDefault("none")
           .withNamedValues({"scale", "orientation", "none"})},
      {"size", "WxH", qualityGroup, "Width and height of the image in pixels",
       ValueSpec::text()
           .bind(scene, readSize)
           .withDefault(std::to_string(scene.width) + "x" + std::to_string(scene.height))},
      {"quality", "LEVEL", qualityGroup, describeQuality(), ValueSpec::choice(listQualityNames()),
       OverrideGroup::stop},
      {"samples", "N", qualityGroup,
       "Stops at N samples per pixel [" + std::to_string(settings.samples) +
           " unless quality, seconds or noise are given]",
       ValueSpec::integer(1, unlimited).bind(settings.samples).withDefault(""),
       OverrideGroup::stop},
      {"seconds", "T", qualityGroup,
       "Stops after T seconds of rendering, but not before one sample per pixel",
       ValueSpec::number(1e-3, 1e9).bind(settings.seconds).withDefault(""), OverrideGroup::stop},
      {"noise", "E", qualityGroup,
       "Stops when the noise relative to the image is at most E, for example 0.03 (3 %)",
       ValueSpec::number(1e-6, 1e6).bind(settings.noise).withDefault(""), OverrideGroup::stop},
      {"noise-target", "KIND", qualityGroup,
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
      {"bounces", "B", qualityGroup,
       "Most scattering events per light path; a limit makes the image darker [unlimited]",
       ValueSpec::integer(0, unlimited).bind(settings.path.bounces).withDefault("")},
      {"seed", "S", qualityGroup, "Seed of the random numbers; the same seed gives the same image",
       ValueSpec::integer(0, 0x1p64).bind(settings.seed)},
      {"sampling", "KIND", qualityGroup,
       "Random numbers of a pixel's samples: stratified in groups of 8, or independent (noisier); "
       "both are unbiased",
       ValueSpec::choice(settings.sampling, {{"stratified", Sampling::stratified},
                                             {"independent", Sampling::independent}})
           .withAliases({{"strata", "stratified"}})},
      {"device", "KIND", qualityGroup,
       "Renders on the cpu, on the gpu, or auto: on the GPU where a device and the scene allow it; "
       "list prints the GPUs of this machine",
       ValueSpec::choice(options.device, {{"cpu", DeviceChoice::cpu},
                                          {"gpu", DeviceChoice::gpu},
                                          {"auto", DeviceChoice::automatic}}),
       OverrideGroup::process},
      {OptionNames("threads", 'j'), "K", qualityGroup,
       "Number of threads, at most one per core; 0: all cores",
       ValueSpec::integer(0, 1024).bind(settings.threads), OverrideGroup::process},
      {"volume", "NAME", outputGroup,
       "Volume of a scene (name or id), or series of a DICOM folder (number or uid) [as in Slicer]",
       ValueSpec::text().bind(scene.volume.name)},
      {"frame", "N", outputGroup,
       "Frame of a series over time or of a 4D file, from 0 [0, with a warning if there are more]",
       ValueSpec::integer(0, unlimited).bind(scene.volume.frame)},
      {"nifti-form", "FORM", outputGroup,
       "Geometry of a NIfTI volume: its sform or qform; auto: the sform, unless only the qform "
       "agrees with the segmentation",
       ValueSpec::choice(
           scene.volume.niftiForm,
           {{"auto", std::nullopt}, {"qform", NiftiForm::qform}, {"sform", NiftiForm::sform}})},
      {"spacing", "X,Y,Z", outputGroup,
       "Spacing of the voxels in mm, or one number for all axes: required for a folder of image "
       "slices and a TIFF stack; also for a NRRD or MetaImage that states none [1 there]",
       ValueSpec::text().bind(scene.volume.spacing, readSpacing)},
      {"strict", "", outputGroup,
       "Refuses an input of which positions, units, frames or slices would be assumed, "
       "interpolated or left out",
       ValueSpec::notInPanel().bind(scene.isStrict, readSwitch), OverrideGroup::process},
      {"layers", "L,...", outputGroup,
       "Channels of .exr: color, depth, clip, albedo, normal, error, samples, and with --denoise "
       "on denoised, expected, depth50 (where half of the light is stopped; if named, also of raw "
       "images beside a denoised .png); of .nrrd: color, and as separate files depth, denoised and "
       "depth50 [all]",
       ValueSpec::list()
           .bind(options.layers, readLayers)
           .withDefault("color") // Slicer takes one file
           .withNamedValues({allLayers.begin(), allLayers.end()}),
       OverrideGroup::process},
      {"surface", "FILE", outputGroup,
       "Writes the clipping surface as triangles, RAS, mm, accurate to a tenth of a pixel in depth "
       "(any --clip but none and plane): .vtp, .ply (with depths) or .stl",
       ValueSpec::surface().bind(options.surface), OverrideGroup::process},
      {OptionNames("stats-json", "stats"), "FILE", outputGroup,
       "Writes times, counts and measurements as .json", ValueSpec::jsonFile().bind(options.stats),
       OverrideGroup::process},
      {"checkpoint", "FILE", outputGroup,
       "Saves the samples so far to this checkpoint file (.film). The same command resumes from it "
       "after a stop or a crash, and ends with the same image; --samples, --noise, --seconds, "
       "--threads and outputs may change",
       ValueSpec::checkpointFile().bind(options.checkpoint), OverrideGroup::process},
      {"shard", "K/N", outputGroup,
       "Renders only the K-th of N shards of the image, to the file of --checkpoint, for fenestra "
       "merge; of a turntable, the frames of that shard",
       ValueSpec::text().bind(options, readShard), OverrideGroup::process},
      {"progress", "KIND", outputGroup,
       "Progress: bar, xml (Slicer's tags), none, or auto: a bar on a terminal",
       ValueSpec::choice(options.progress, {{"auto", ProgressMode::automatic},
                                            {"bar", ProgressMode::bar},
                                            {"xml", ProgressMode::xml},
                                            {"none", ProgressMode::none}}),
       OverrideGroup::process},
      {OptionNames("quiet", 'q'), "", outputGroup, "Prints only warnings and errors",
       ValueSpec::notInPanel().bind(options.quiet, readSwitch), OverrideGroup::process},
      {OptionNames("verbose", 'v'), "", outputGroup,
       "Also prints what was chosen, such as the transfer function, and the contrast of the focus",
       ValueSpec::notInPanel().bind(options.verbose, readSwitch), OverrideGroup::process},
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
    "Renders a medical volume by Monte Carlo path tracing. A clipping surface uncovers the "
    "segments "
    "of --focus. The word \"render\" is optional. Ctrl-C writes the image of the samples so far.",
    {{"INPUT", "Volume (.nrrd .nhdr .nii .nii.gz .hdr .mgz .mha .mhd .vti .tif), folder of DICOM "
               "files or of "
               "TIFF or PNG slices, or Slicer scene (.mrml .mrb)"}},
    defaultTable.rows,
    {},
    "Render an image of a volume (the default command)",
    "knee.mrml --focus FemoralCartilage --quality high -o knee.png",
};

const std::span<const OptionGroup> renderGroups = groupTable;

RenderOptions readOptions(const OptionValues& values) {
  RenderOptionTable table;
  for (const Option& option : table.rows)
    if (option.spec.store && values.has(option.name))
      option.spec.store(values, option.name);
  return table.options;
}

VolumeChoice readVolumeChoice(const OptionValues& values) {
  OptionValues chosen(renderSyntax.options);
  for (const char* name : {"volume", "frame", "nifti-form", "spacing"})
    if (const auto value = values.text(name))
      chosen.add(name, *value);
  return readOptions(chosen).scene.volume;
}

bool isClipOption(const Option& option) {
  return option.group == clipGroup;
}

bool isAppearanceOption(const Option& option) {
  return isClipOption(option) || option.group == viewGroup || option.group == appearanceGroup;
}

} // namespace fenestra::core
