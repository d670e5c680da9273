// Organ presets, and Slicer's volume property presets by name, on the command line.

#include "CommandTesting.h"
#include "files/images/ImageReader.h"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <sstream>

namespace fenestra::core::PresetsCommandTests {
namespace {

/// Runs `fenestra knee.nrrd …` in the knee's folder, with 16x16 pixels and 2 samples per pixel.
Outcome renderKnee(const Arguments& arguments, const std::string& input = "knee/knee.nrrd") {
  Arguments all = {input, "--size", "16x16", "--samples", "2", "--output", "preset.exr"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return run(all, kneeFolder().path());
}

Arguments addSegments(const Arguments& arguments) {
  Arguments all = {"--segmentation", "knee/knee.seg.nrrd"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return all;
}

/// Lines printed by --echo.
std::set<std::string> renderEcho(Arguments arguments, const std::string& input = "knee/knee.nrrd") {
  arguments.push_back("--echo");
  const Outcome outcome = renderKnee(arguments, input);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  std::istringstream text(outcome.out);
  std::set<std::string> lines;
  for (std::string line; std::getline(text, line);)
    lines.insert(line);
  return lines;
}

bool hasLine(const std::set<std::string>& lines, const std::string& start) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const std::string& line) { return line.starts_with(start); });
}

/// Name of a preset file that sets lights, view and clip, beyond what the built-in ones do.
std::string writeFullPreset() {
  kneeFolder().write("full.json", R"({"title": "All", "modality": "MR",
    "focus": {"names": ["femoral cartilage", "tibial cartilage"]},
    "flags": {"materials": "none", "transfer": "mr-knee", "lights": "studio", "view": "anterior", "clip": "surface",
              "clip-boundary": "spline", "label-smoothing": 0.6, "clip-softness": 2}})");
  return "full.json";
}

Image readResult() {
  return readImage(kneeFolder() / "preset.exr");
}

/// Of several visible segmentations, whose segments share ids, the preset finds the one that has
/// its segment.
TEST(PresetsCommand, PresetFindsItsSegmentInSeveralSegmentations) {
  const TemporaryFolder& folder = kneeFolder();
  const std::string header = "NRRD0004\ntype: uint8\ndimension: 3\nspace: "
                             "left-posterior-superior\nsizes: 4 4 4\nspace directions: (1,0,0) "
                             "(0,1,0) (0,0,1)\nspace origin: (0,0,0)\nencoding: raw\n";
  folder.write("several.nrrd", header + "\n" + std::string(64, 'a'));
  std::string nodes = R"(<VolumeArchetypeStorage id="sv" fileName="several.nrrd"/>
    <Volume id="v" name="V" references="storage:sv;"/>)";
  for (const std::string name : {"Liver", "Stone"}) {
    folder.write(name + ".seg.nrrd", header + "Segment0_ID:=S\nSegment0_Name:=" + name +
                                         "\nSegment0_LabelValue:=1\n\n" + std::string(64, '\1'));
    nodes += "<SegmentationStorage id=\"s" + name + "\" fileName=\"" + name +
             ".seg.nrrd\"/><Segmentation id=\"" + name + "\" name=\"" + name +
             "\" references=\"storage:s" + name + ";\"/>";
  }
  folder.write("several.mrml", "<MRML>" + nodes + "</MRML>");
  for (const char* preset : {"liver", "auto"})
    EXPECT_TRUE(hasLine(renderEcho({"--preset", preset}, "several.mrml"), "focus: Liver"))
        << preset;
}

TEST(PresetsCommand, PresetSetsFocusAppearanceViewAndClip) {
  const auto lines =
      renderEcho(addSegments({"--preset", writeFullPreset(), "--stats-json", "s.json"}));
  for (const char* line : {"preset: full", "focus: FemoralCartilage", "focus: TibialCartilage",
                           "transfer: mr-knee", "clip: surface"})
    EXPECT_TRUE(lines.contains(line)) << line;
  const Image byPreset = readResult();
  EXPECT_EQ(byPreset.header.at("preset"), "full");
  EXPECT_EQ(byPreset.header.at("look"), "mr-knee");
  const auto stats = nlohmann::json::parse(readBytes(kneeFolder() / "s.json"));
  EXPECT_EQ(stats.at("preset"), "full");

  Arguments written = {"--focus", "FemoralCartilage,TibialCartilage"};
  for (const std::string& line : lines)
    for (const char* option : {"materials", "transfer", "lights", "view", "clip", "clip-boundary",
                               "label-smoothing", "clip-softness"})
      if (line.starts_with(std::string(option) + ": "))
        written.insert(written.end(),
                       {std::string("--") + option, line.substr(std::string(option).size() + 2)});
  EXPECT_EQ(written.size(), 18u);
  ASSERT_EQ(renderKnee(addSegments(written)).status, 0);
  EXPECT_EQ(readResult().channels, byPreset.channels);
  EXPECT_FALSE(readResult().header.contains("preset"));
}

TEST(PresetsCommand, OptionsOverrideThePreset) {
  const auto lines = renderEcho(
      addSegments({"--preset", writeFullPreset(), "--view", "superior", "--clip", "cutaway",
                   "--transfer", "ct-bone", "--focus", "Femur", "--scale", "70"}));
  for (const char* line : {"view: superior", "clip: cutaway", "transfer: ct-bone", "focus: Femur",
                           "scale: 70", "lights: studio", "preset: full"})
    EXPECT_TRUE(lines.contains(line)) << line;
  EXPECT_FALSE(hasLine(lines, "clip-boundary"));
  EXPECT_FALSE(lines.contains("focus: FemoralCartilage"));
  // --control-points and --clip-boundary are alternatives: one overrides the preset's other.
  const auto others = renderEcho(
      addSegments({"--preset", "full.json", "--clip-boundary", "exact", "--position", "0,300,0"}));
  EXPECT_TRUE(others.contains("clip: surface"));
  EXPECT_TRUE(others.contains("clip-boundary: exact"));
  EXPECT_FALSE(hasLine(others, "view"));
}

/// Slicer's panel passes all options, most with their default values.
TEST(PresetsCommand, DefaultValuesFromSlicerDoNotOverrideThePreset) {
  const auto lines = renderEcho(addSegments(
      {"--preset", writeFullPreset(), "--clip", "auto", "--clip-boundary", "exact",
       "--control-points", "50", "--lights", "soft", "--returnparameterfile", "r.txt"}));
  EXPECT_TRUE(lines.contains("clip: surface"));
  EXPECT_TRUE(lines.contains("clip-boundary: spline"));
  EXPECT_TRUE(lines.contains("lights: soft"));
}

TEST(PresetsCommand, AutoChoosesThePresetBySegmentNames) {
  EXPECT_TRUE(renderEcho(addSegments({"--preset", "auto"})).contains("preset: knee-cartilage"));
  EXPECT_TRUE(renderEcho(addSegments({"--preset", "auto", "--focus", "Femoral cartilage"}))
                  .contains("focus: Femoral cartilage"));
  EXPECT_TRUE(renderEcho({"--preset", "auto"}, "knee/knee.mrb").contains("preset: knee-cartilage"));
}

TEST(PresetsCommand, WithoutSegmentationSetsNeitherFocusNorClip) {
  const auto lines = renderEcho({"--preset", "knee-cartilage"});
  EXPECT_TRUE(lines.contains("transfer: mr-knee"));
  EXPECT_FALSE(hasLine(lines, "focus"));
  EXPECT_FALSE(hasLine(lines, "clip"));
}

/// A preset for another modality still renders, with the default transfer function.
TEST(PresetsCommand, TransferFunctionForAnotherModalityIsReplacedWithAWarning) {
  kneeFolder().write("ct.json", R"({"title": "CT", "modality": "CT", "focus": {"names": ["liver"]},
    "flags": {"transfer": "ct-anatomy"}})");
  const Outcome outcome = renderKnee(addSegments({"--preset", "ct.json", "--focus", "Femur"}));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(outcome.err.starts_with("fenestra: warning: ct-anatomy: ")) << outcome.err;
  EXPECT_EQ(readResult().header.at("look"), "mr-knee");
  EXPECT_EQ(
      renderKnee(addSegments({"--preset", "ct.json", "--focus", "Femur", "--transfer", "mr-knee"}))
          .err,
      "");
}

TEST(PresetsCommand, PresetCanBeAFile) {
  const TemporaryFolder& folder = kneeFolder();
  folder.write("menisci.json", R"({"title": "Menisci", "modality": "MR",
    "focus": {"names": ["menisc*"]}, "flags": {"view": "superior", "transfer":
      {"scalars": "relative", "extinction": [[0, 0], [1, 1]], "albedo": [[0, 1, 0.5, 0.5]]}}})");
  const auto lines = renderEcho(addSegments({"--preset", "menisci.json"}));
  EXPECT_TRUE(lines.contains("preset: menisci"));
  EXPECT_TRUE(hasLine(lines, "focus: "));
  EXPECT_TRUE(hasLine(lines, "transfer: {"));
}

TEST(PresetsCommand, RejectsUnknownAndDamagedPresets) {
  const TemporaryFolder& folder = kneeFolder();
  folder.write("values.nrrd",
               NrrdText{.type = "uint8"}.encode(std::string(32, '\1') + std::string(32, '\2')));
  folder.write("size.json", R"({"title": "", "focus": {"names": ["a"]}, "modality": "MR",
                               "flags": {"size": "9x9"}})");
  folder.write("brackets.json", "{");
  folder.write("modality.json", R"({"title": "", "focus": {"names": ["a"]}, "modality": "PET",
                                    "flags": {}})");
  const auto refusal = [](const std::string& name, Arguments arguments, int status,
                          const std::string& text) {
    arguments.insert(arguments.begin(), "knee/knee.nrrd");
    return ExpectedError{name, arguments, status, text};
  };
  expectErrors(
      {
          refusal("unknown", addSegments({"--preset", "spleen"}), 3,
                  "spleen: | brain-surface, brain-tumor"),
          refusal("no such segment", addSegments({"--preset", "liver"}), 3,
                  "knee.seg.nrrd: | preset liver | Femur, Tibia | --focus"),
          refusal("values without names", {"--segmentation", "values.nrrd", "--preset", "liver"}, 3,
                  "values.nrrd: | --labels | --focus"),
          refusal("auto by values", {"--segmentation", "values.nrrd", "--preset", "auto"}, 3,
                  "values.nrrd: | preset auto | --labels"),
          refusal("auto without segments", {"--preset", "auto"}, 2,
                  "preset auto: | --segmentation"),
          refusal("auto unknown", addSegments({"--preset", "auto", "--focus", "Femur"}), 3,
                  "knee.seg.nrrd: | (Femur)"),
          refusal("other option", addSegments({"--preset", "size.json", "--focus", "1"}), 3,
                  "size.json: flags: | \"size\""),
          refusal("not JSON", addSegments({"--preset", "brackets.json"}), 3, "brackets.json:"),
          refusal("modality", addSegments({"--preset", "modality.json"}), 3,
                  "modality.json: modality:"),
          refusal("twice", addSegments({"--preset", "liver", "--preset", "auto"}), 2, "--preset:"),
      },
      folder.path());
}

/// A preset on the command line overrides only those stored options that it sets itself.
TEST(PresetsCommand, GivenPresetOverridesOptionsStoredInTheScene) {
  const TemporaryFolder& folder = kneeFolder();
  const std::string scene = readBytes(folder / "knee/knee.mrml");
  const auto writeStored = [&](const std::string& attributes) {
    std::string text = scene;
    text.insert(text.find("</MRML>"), "<FenestraRender id=\"f1\" " + attributes + "/>");
    folder.write("knee/stored.mrml", text);
    return std::string("knee/stored.mrml");
  };
  const auto given =
      renderEcho({"--preset", "knee-cartilage"},
                 writeStored(R"(view="left" transfer="ct-bone" focus="Femur" seed="7")"));
  EXPECT_TRUE(given.contains("transfer: mr-knee"));
  EXPECT_TRUE(given.contains("focus: FemoralCartilage"));
  EXPECT_TRUE(given.contains("seed: 7"));
  EXPECT_FALSE(given.contains("view: left"));
  const auto overridden = renderEcho({}, writeStored(R"(preset="knee-cartilage" view="superior")"));
  EXPECT_TRUE(overridden.contains("transfer: mr-knee"));
  EXPECT_TRUE(overridden.contains("view: superior"));
  EXPECT_TRUE(overridden.contains("focus: FemoralCartilage"));
}

TEST(PresetsCommand, ServeSetsAndResetsThePreset) {
  const TemporaryFolder& folder = kneeFolder();
  Process process({"serve", "knee/knee.nrrd", "--size", "16x16", "--samples", "2", "--output",
                   "served.exr", "--view", "superior", "--volume-smoothing", "off"},
                  folder.path());
  const auto waitForImage = [&](const std::string& id) {
    return process.waitForOutput("\"picture\",\"id\":" + id + ",[^\n]*\"done\":true[^\n]*\n");
  };
  ASSERT_TRUE(waitForImage("null")) << process.output();
  const Image plain = readImage(folder / "served.exr");
  process.write(R"({"id": 1, "segmentation": "knee/knee.seg.nrrd", "preset": "auto"})"
                "\n");
  ASSERT_TRUE(waitForImage("1")) << process.output();
  const Image preset = readImage(folder / "served.exr");
  EXPECT_EQ(preset.header.at("preset"), "knee-cartilage");
  ASSERT_EQ(renderKnee(addSegments({"--preset", "knee-cartilage", "--view", "superior"})).status,
            0);
  EXPECT_EQ(readResult().channels, preset.channels);
  process.write(R"({"id": 2, "preset": "spleen"})"
                "\n");
  EXPECT_TRUE(process.waitForOutput("\"error\",\"id\":2")) << process.output();
  process.write(R"({"id": 3, "segmentation": null, "preset": null})"
                "\n");
  ASSERT_TRUE(waitForImage("3")) << process.output();
  EXPECT_EQ(readImage(folder / "served.exr").channels, plain.channels);
  process.closeInput();
  EXPECT_EQ(process.wait().status, 0);
}

// ---- Slicer's presets
// ----------------------------------------------------------------------------

/// Sets SLICER_HOME to a fake Slicer installation during its lifetime.
class SlicerHome {
public:
  explicit SlicerHome(const std::filesystem::path& folder) {
    const auto place = folder / "share" / "Slicer-5.8" / "qt-loadable-modules" / "VolumeRendering";
    std::filesystem::create_directories(place);
    std::ofstream(place / "presets.xml")
        << R"(<MRML><VolumeProperty name="CT-Mine" scalarOpacity="4 0 0 500 0.9"
              gradientOpacity="4 0 1 255 1" colorTransfer="8 0 1 0 0 500 1 1 1" shade="1"/></MRML>)";
    ::setenv("SLICER_HOME", folder.c_str(), 1);
  }
  ~SlicerHome() { ::unsetenv("SLICER_HOME"); }
  SlicerHome(const SlicerHome&) = delete;
  SlicerHome& operator=(const SlicerHome&) = delete;
};

TEST(PresetsCommand, TransferFindsSlicerPresetByName) {
  const TemporaryFolder home;
  {
    const SlicerHome slicer(home.path());
    const Outcome outcome = renderKnee({"--transfer", "CT-Mine"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(readResult().header.at("look"), "CT-Mine");
    const Outcome unknown = renderKnee({"--transfer", "CT-Other"});
    EXPECT_EQ(unknown.status, 3);
    expectErrorLine(unknown.err, "CT-Other: | CT-Mine | ct-soft");
  }
  const Outcome gone = renderKnee({"--transfer", "CT-Mine"});
  EXPECT_EQ(gone.status, 3);
  expectErrorLine(gone.err, "CT-Mine: | SLICER_HOME");
}

TEST(PresetsCommand, TransferFindsVolumePropertyOfTheSceneByName) {
  const Outcome usual = renderKnee({}, "knee/knee.mrb");
  ASSERT_EQ(usual.status, 0) << usual.err;
  const Image before = readResult();
  const Outcome named = renderKnee({"--transfer", "knee property"}, "knee/knee.mrb");
  EXPECT_EQ(named.status, 0) << named.err;
  EXPECT_EQ(readResult().channels, before.channels);
  const Outcome unknown = renderKnee({"--transfer", "other property"}, "knee/knee.mrb");
  EXPECT_EQ(unknown.status, 3);
  expectErrorLine(unknown.err, "other property: | knee property");
}

} // namespace
} // namespace fenestra::core::PresetsCommandTests
