// Materials on the command line: their effect on an image, and errors.

#include "CommandTesting.h"
#include "files/images/ImageReader.h"

#include <nlohmann/json.hpp>

namespace fenestra::core::MaterialsCommandTests {
namespace {

const std::filesystem::path data = FENESTRA_DATA;

Image renderImage(Arguments arguments, const std::filesystem::path& folder,
                  const std::string& name = "p.exr") {
  arguments.insert(arguments.end(), {"--output", name});
  const Outcome outcome = run(arguments, folder);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return readImage(folder / name);
}

bool isColorChannel(const std::string& channel) {
  return channel.size() == 1 ? channel != "A" && channel != "Z"
                             : channel.starts_with("error.") || channel.starts_with("albedo.");
}

/// Expects that materials change the color channels, and leave all other channels bit-identical.
void expectOnlyColors(Arguments arguments, const std::string& materials = "library") {
  const TemporaryFolder folder;
  arguments.insert(arguments.end(), {"--size", "40x40", "--samples", "2"});
  Arguments plain = arguments;
  plain.insert(plain.end(), {"--materials", "none"});
  const Image none = renderImage(plain, folder.path());
  arguments.insert(arguments.end(), {"--materials", materials, "--stats-json", "s.json"});
  const Image tinted = renderImage(arguments, folder.path());
  EXPECT_EQ(none.channels.size(), tinted.channels.size());
  for (const char* name : {"A", "Z", "clip.Z", "normal.X", "samples.N"})
    EXPECT_TRUE(tinted.find(name)) << name;
  for (const auto& [name, plane] : none.channels)
    if (isColorChannel(name))
      EXPECT_NE(tinted.channels.at(name), plane) << name << " is unchanged";
    else
      EXPECT_EQ(tinted.channels.at(name), plane) << name;
  const auto stats = nlohmann::json::parse(readBytes(folder / "s.json"));
  EXPECT_GE(stats.at("/labels/components"_json_pointer), 3);
  EXPECT_GT(stats.at("/labels/pureFraction"_json_pointer), 0.1);
  EXPECT_GT(stats.at("/labels/bytes"_json_pointer), 0);
  EXPECT_GT(stats.at("/seconds/materials"_json_pointer), 0.0);
  ASSERT_TRUE(stats.contains("contrast"));
  if (materials == "library") {
    EXPECT_EQ(stats.at("contrast").at("contextSaturation"), 0.75);
  }
  if (materials == "contrast") {
    for (const char* key : {"deltaE", "deltaEProtan", "deltaEDeutan", "deltaETritan", "deltaL"})
      EXPECT_GE(stats.at("contrast").at(key), 0.0) << key;
    EXPECT_NE(stats.at("contrast").at("segment"), stats.at("contrast").at("neighbour"));
    EXPECT_GE(stats.at("contrast").at("contextSaturation"), 0.4);
    EXPECT_LE(std::abs(stats.at("contrast").at("focusLightness").get<double>()), 48.0);
    EXPECT_LE(stats.at("contrast").at("focusAccent"), 0.6);
    EXPECT_TRUE(stats.at("contrast").at("accent").is_string());
  }
}

TEST(Materials, ChangeOnlyColorsOfTheKnee) {
  const std::string knee = (kneeFolder() / "knee").string();
  expectOnlyColors({knee + "/knee.nrrd", "--segmentation", knee + "/knee.seg.nrrd", "--focus",
                    "FemoralCartilage", "--transfer", knee + "/knee.vp.json"});
}

TEST(Materials, ChangeOnlyColorsOfTheKneeWithContrast) {
  const std::string knee = (kneeFolder() / "knee").string();
  expectOnlyColors({knee + "/knee.nrrd", "--segmentation", knee + "/knee.seg.nrrd", "--focus",
                    "FemoralCartilage", "--transfer", knee + "/knee.vp.json"},
                   "contrast");
}

class RealMaterials : public ::testing::Test {
protected:
  void SetUp() override {
    if (!std::filesystem::exists(data))
      GTEST_SKIP() << data << " does not exist";
  }
};

TEST_F(RealMaterials, ChangeOnlyColorsOfAnAbdomen) {
  const std::string folder = (data / "abdomen_ct_totalseg").string();
  expectOnlyColors({folder + "/ct.nii.gz", "--segmentation", folder + "/seg_multiorgan.nii.gz",
                    "--focus", "liver"});
}

TEST_F(RealMaterials, ChangeOnlyColorsOfAKneeAtlas) {
  const std::string folder = (data / "spl_knee_atlas_labels").string();
  expectOnlyColors({folder + "/SYNTHETIC_mr_256.nii.gz", "--segmentation",
                    folder + "/seg_256.nii.gz", "--labels", folder + "/knee.ctbl", "--focus",
                    "83"});
}

TEST_F(RealMaterials, ChangeOnlyColorsOfOverlappingLayers) {
  const std::string folder = (data / "slicerio_segnrrd").string();
  expectOnlyColors({folder + "/CTChest4.nrrd", "--segmentation",
                    folder + "/SegmentationOverlapping.seg.nrrd", "--focus", "ribs"});
}

/// Renders of the volume with its segments "Bone, left" (one voxel) and "Void" (empty).
class MaterialsCommand : public SmallScene {
protected:
  static Arguments makeArguments(const Arguments& more) {
    Arguments all = {
        "volume.nrrd", "--segmentation", "segments.seg.nrrd", "--size", "8x8", "--samples", "2"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

TEST_F(MaterialsCommand, NeedNoFocusAndAreAFact) {
  const Outcome outcome = run(
      makeArguments({"--materials", "library", "--output", "a.png", "--verbose"}), folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "transfer function: by the volume's range\nvolume: not smoothed\n"
                         "lights: theatre\n"
                         "materials: library, 1 color\n");
}

/// CT numbers: bone, and air in the last voxel.
std::string makeBone() {
  std::string samples;
  for (int i = 0; i < 64; ++i) {
    const auto value = static_cast<std::uint16_t>(i < 63 ? 300 : -1000);
    samples += {static_cast<char>(value & 0xFF), static_cast<char>(value >> 8)};
  }
  return samples;
}

/// The library has a material for "Bone, left", but none for "Void". In MR, one color per segment
/// would hide the signal inside an organ.
TEST_F(MaterialsCommand, DefaultIsTheLibraryInCtIfTheMaterialOfTheFocusIsKnown) {
  const auto renderChannels = [&](const Arguments& more) {
    return renderImage(makeArguments(more), folder.path()).channels;
  };
  const auto renderMaterials = [&](const char* materials) {
    return renderChannels({"--focus", "A", "--materials", materials});
  };
  EXPECT_EQ(renderChannels({"--focus", "A"}), renderMaterials("none")) << "not CT";
  folder.write("volume.nrrd", NrrdText().encode(makeBone()));
  const auto library = renderMaterials("library"), none = renderMaterials("none");
  EXPECT_NE(library, none);
  EXPECT_EQ(renderChannels({"--focus", "A"}), library);
  EXPECT_EQ(renderChannels({"--focus", "A,B"}), library);
  EXPECT_EQ(
      renderChannels({"--focus", "A", "--context-saturation", "1"}),
      renderChannels({"--focus", "A", "--context-saturation", "1", "--materials", "library"}));
  EXPECT_EQ(renderMaterials("auto"), renderMaterials("contrast")) << "the former name";
  const Outcome outcome =
      run(makeArguments({"--focus", "A", "--output", "a.png", "-v"}), folder.path());
  EXPECT_NE(outcome.err.find("\nmaterials: library, "), std::string::npos) << outcome.err;
}

TEST_F(MaterialsCommand, FilesAndChangesOverrideTheLibrary) {
  folder.write("green.json",
               R"({"version": 1, "materials": {"green": {"albedo": [0, 1, 0]}},
                   "segments": [{"match": {"names": ["*bone*"]}, "material": "green"}]})");
  const auto albedo = [&](const Arguments& more) {
    Arguments arguments = makeArguments({"--focus", "A", "--context-saturation", "1"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Image image = renderImage(arguments, folder.path());
    const auto mean = [&](const char* name) {
      const Plane& plane = image.channels.at(name);
      return std::accumulate(plane.begin(), plane.end(), 0.0F);
    };
    return std::array{mean("albedo.R"), mean("albedo.G")};
  };
  const auto library = albedo({"--materials", "library"});
  const auto green = albedo({"--materials", "green.json"});
  EXPECT_LT(green[0], library[0]);
  EXPECT_GT(green[1], library[1]);
  EXPECT_EQ(albedo({"--materials", "library", "--material", "A: color=#ff0000", "--material",
                    "Bone, left: material=bone, color=#00ff00"})[0],
            albedo({"--materials", "library", "--material", "1: color=#00ff00"})[0]);
  EXPECT_LT(albedo({"--materials", "library", "--material", "1: color=#00ff00"})[0], library[0]);
  EXPECT_EQ(albedo({"--material", "1: color=#00ff00"}),
            albedo({"--materials", "library", "--material", "1: color=#00ff00"}));
}

TEST_F(MaterialsCommand, ContextOfAFileAppliesAroundAFocus) {
  const std::string context = R"("context": {"saturation": 0.7, "lightness": 0.2}})";
  folder.write("given.json", R"({"version": 1, )" + context);
  folder.write("contrast.json", R"({"version": 1, "contrast": true, )" + context);
  const auto renderContrast = [&](const std::string& materials) {
    Arguments arguments = makeArguments(
        {"--focus", "A", "--materials", materials, "--stats-json", "s.json", "--output", "a.png"});
    const Outcome outcome = run(arguments, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return nlohmann::json::parse(readBytes(folder / "s.json")).at("contrast");
  };
  for (const char* file : {"given.json", "contrast.json"}) {
    EXPECT_EQ(renderContrast(file).at("contextSaturation"), 0.7) << file;
    EXPECT_EQ(renderContrast(file).at("contextLightness"), 0.2) << file;
    EXPECT_EQ(renderContrast(file).at("segment"), "Bone, left");
    EXPECT_EQ(renderContrast(file).at("neighbour"), "the rest");
  }
  EXPECT_EQ(renderContrast("given.json").at("focusLightness"), 0.0);
  expectErrors({{"no focus", makeArguments({"--materials", "given.json"}), 3,
                 "given.json: context: | --focus"}},
               folder.path());
}

TEST_F(MaterialsCommand, GivenSaturationReplacesThatOfTheMaterials) {
  folder.write("given.json", R"({"version": 1, "context": {"saturation": 0.7}})");
  folder.write("plain.json", R"({"version": 1})");
  for (const char* materials : {"none", "library", "contrast", "given.json", "plain.json"}) {
    Arguments arguments =
        makeArguments({"--focus", "A", "--context-saturation", "0.3", "--materials", materials,
                       "--stats-json", "s.json", "--output", "a.png"});
    const Outcome outcome = run(arguments, folder.path());
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto stats = nlohmann::json::parse(readBytes(folder / "s.json"));
    EXPECT_EQ(stats.at("contrast").at("contextSaturation"), 0.3) << materials;
  }
}

/// The clip removes everything but a segment with clip=no.
TEST_F(MaterialsCommand, DensityAndClippingCanBeSetPerSegment) {
  folder.write("dense.json",
               R"({"version": 1, "segments":
                   [{"match": {"names": ["bone*"]}, "material": "bone", "density": 8}]})");
  const auto sumAlpha = [&](Arguments more) {
    more.insert(more.end(), {"--background", "transparent", "--density-scale", "0.05"});
    const Image image = renderImage(makeArguments(more), folder.path());
    const Plane& alpha = image.channels.at("A");
    return std::accumulate(alpha.begin(), alpha.end(), 0.0F);
  };
  const Arguments library = {"--materials", "library"};
  const auto sumAlphaWithMaterials = [&](Arguments more) {
    more.insert(more.begin(), library.begin(), library.end());
    return sumAlpha(more);
  };
  const float plain = sumAlpha(library);
  EXPECT_GT(sumAlpha({"--materials", "dense.json"}), plain);
  EXPECT_GT(sumAlphaWithMaterials({"--material", "A: density=8"}), plain);
  EXPECT_GT(sumAlphaWithMaterials({"--material", "A: extinction=50"}), plain);
  const auto sumAlphaClipped = [&](Arguments more) {
    more.insert(more.end(), {"--clip", "plane", "--plane", "1000,0,0,-1,0,0"});
    return sumAlphaWithMaterials(more);
  };
  EXPECT_EQ(sumAlphaClipped({}), 0.0F);
  EXPECT_GT(sumAlphaClipped({"--material", "A: clip=no"}), 0.0F);
}

TEST_F(MaterialsCommand, ErrorsAreOneLine) {
  folder.write("broken.json", R"({"version": 1, "materials": {"a": {"colors": "#ffffff"}}})");
  const auto refusal = [](Arguments more, int status, const std::string& text) {
    return ExpectedError{text, makeArguments(more), status, text};
  };
  const Arguments on = {"--materials", "library"};
  const auto change = [&](const std::string& text, const std::string& message) {
    return refusal({on[0], on[1], "--material", text}, 3, message);
  };
  expectErrors(
      {
          {"no labels",
           {"volume.nrrd", "--materials", "library"},
           2,
           "--materials: requires --segmentation FILE"},
          {"smoothing",
           {"volume.nrrd", "--label-smoothing", "1"},
           2,
           "--label-smoothing: requires a focus or materials; add --focus or --materials"},
          refusal({"--materials", "none"}, 2, "--segmentation: used only with"),
          refusal({"--focus", "A", "--materials", "none", "--material", "A: g=0"}, 2,
                  "--material: contradicts --materials none"),
          refusal({"--materials", "liver"}, 3, "liver: | none, library, contrast"),
          refusal({"--materials", "broken.json"}, 3,
                  "broken.json: materials.a: unknown key \"colors\""),
          change("A", "material A:"),
          change("A: colors=#ffffff", "material A: | \"colors\""),
          change("A: color=red", "material A: color:"),
          change("C: color=#ffffff", "segments.seg.nrrd: | \"C\" | A (Bone, left), B (Void)"),
      },
      folder.path());
}

/// Stored materials need no focus, apply to the scene's segmentation, and must not name a file.
TEST_F(MaterialsCommand, StoredMaterialsReproduceTheImage) {
  const auto write = [&](const std::string& name, const std::string& stored) {
    folder.write(name, R"(<MRML version="Slicer 5.6.2 32448">
        <Volume id="v" name="ramp" references="storage:vs;"/>
        <VolumeArchetypeStorage id="vs" fileName="volume.nrrd"/>
        <Segmentation id="s" name="parts" references="storage:ss;"/>
        <SegmentationStorage id="ss" fileName="segments.seg.nrrd"/>)" +
                           stored + "</MRML>");
  };
  const auto writeStored = [&](const std::string& name, const std::string& materials,
                               const std::string& changes = "A: color=#00ff00") {
    write(name, R"(<FenestraRender id="f" references="volume:v;segmentation:s;" size="8x8"
                     samples="2" materials=")" +
                    materials + R"(" material=")" + changes + R"("/>)");
  };
  folder.write("mine.json", R"({"version": 1})");
  write("plain.mrml", "");
  writeStored("library.mrml", "library");
  writeStored("file.mrml", "mine.json");
  writeStored("auto.mrml", "auto", "A: priority=2");
  writeStored(
      "several.mrml", "library",
      R"(A: color=#00ff00\, priority=3,Bone\, left: material=bone\, color=#ff0000,B: priority=2)");
  const auto renderScene = [&](const Arguments& arguments, const std::string& warning = "") {
    Arguments all = arguments;
    all.insert(all.end(), {"--output", "a.exr"});
    const Outcome outcome = run(all, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    expectStated(outcome.err, warning);
    EXPECT_EQ(outcome.err.empty(), warning.empty()) << outcome.err;
    return readImage(folder / "a.exr").channels;
  };
  const Arguments small = {"plain.mrml", "--size", "8x8", "--samples", "2"};
  const auto makeArguments = [&](Arguments more) {
    more.insert(more.begin(), small.begin(), small.end());
    return more;
  };
  const auto none = renderScene(small);
  const auto green =
      renderScene(makeArguments({"--materials", "library", "--material", "A: color=#00ff00"}));
  EXPECT_NE(green, none);
  EXPECT_EQ(renderScene({"library.mrml"}), green);
  EXPECT_EQ(
      renderScene({"several.mrml"}),
      renderScene(makeArguments(
          {"--materials", "library", "--material", "A: color=#00ff00, priority=3", "--material",
           "Bone, left: material=bone, color=#ff0000", "--material", "B: priority=2"})));
  EXPECT_EQ(renderScene({"library.mrml", "--materials", "library"}),
            renderScene(makeArguments({"--materials", "library"})))
      << "--materials also replaces the stored changes of segments";
  EXPECT_EQ(renderScene({"library.mrml", "--materials", "none"}), none);
  EXPECT_EQ(renderScene({"auto.mrml"}),
            renderScene(makeArguments({"--materials", "contrast", "--material", "A: priority=2"})))
      << "the former name";
  EXPECT_EQ(renderScene({"file.mrml"}, " | materials | mine.json"), none);
}

TEST_F(MaterialsCommand, ServeAcceptsAListOfChanges) {
  Process process({"serve", "volume.nrrd", "--segmentation", "segments.seg.nrrd", "--materials",
                   "library", "--size", "8x8", "--samples", "2", "--output", "a.exr"},
                  folder.path());
  process.write(R"({"id": 1, "material": ["A: color=#00ff00, priority=3", "B: color=#ff0000"]})"
                "\n");
  ASSERT_TRUE(process.waitForOutput("\"picture\",\"id\":1,[^\n]*\"done\":true[^\n]*\n"))
      << process.output();
  EXPECT_EQ(
      readImage(folder / "a.exr").channels,
      renderImage(makeArguments({"--materials", "library", "--material",
                                 "A: color=#00ff00, priority=3", "--material", "B: color=#ff0000"}),
                  folder.path())
          .channels);
  process.write("{\"id\": 2, \"materials\": \"nothing\"}\n");
  EXPECT_TRUE(process.waitForOutput("\"error\",\"id\":2,\"message\":\"nothing: "))
      << process.output();
}

} // namespace
} // namespace fenestra::core::MaterialsCommandTests
