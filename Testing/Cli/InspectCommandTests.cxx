// `fenestra inspect`: its output for small inputs, word by word in JSON, and its agreement with a
// render.

#include "CommandTesting.h"

#include <nlohmann/json.hpp>

#include <sstream>

namespace fenestra::InspectCommandTests {
namespace {

using Json = nlohmann::json;

const std::string volumeNode = R"(
<VolumeArchetypeStorage id="store1" name="s" fileName="volume.nrrd"/>
<Volume id="vol1" name="CT" references="storage:store1;display:vr1;transform:t1;"/>)";

const std::string segmentationNode = R"(
<SegmentationStorage id="store2" name="s" fileName="segments.seg.nrrd"/>
<SegmentationDisplay id="show2" SegmentationDisplayProperties="A Visible:true|B Visible3D:false|"/>
<Segmentation id="seg1" name="Parts" references="storage:store2;display:show2;"/>)";

const std::string settings = R"(
<GPURayCastVolumeRendering id="vr1" name="VR" croppingEnabled="true" visibility="true"
  references="volumeProperty:prop1;roi:roi1;view:view1;"/>
<VolumeProperty id="prop1" name="Warm" scalarOpacity="4 0 0 60 1"
  colorTransfer="8 0 0 0 0 60 1 1 1" gradientOpacity="4 0 1 60 1" shade="0"/>
<ROI id="roi1" name="Box" xyz="1 2 3" radiusXYZ="4 5 6"/>
<View id="view1" name="View" layoutName="1" backgroundColor="1 0 0" backgroundColor2="0 0 1"/>
<Camera id="cam1" name="Eye" layoutName="1" position="0 100 0" focalPoint="0 0 0" viewUp="0 0 1"
  parallelProjection="true" parallelScale="20"/>
<LinearTransform id="t1" name="Shift"
  matrixTransformToParent="1 0 0 10 0 1 0 20 0 0 1 30 0 0 0 1"/>)";

class InspectCommand : public SmallScene {
protected:
  void writeScene(const std::string& nodes) const {
    folder.write("scene.mrml", "<MRML version=\"Slicer 5.6.2 32448\">" + nodes + "</MRML>");
  }

  /// JSON of an inspection that must succeed, with a text that is not empty.
  Json inspect(Arguments arguments) const {
    arguments.insert(arguments.begin(), "inspect");
    text = run(arguments, folder.path()).out;
    EXPECT_FALSE(text.empty());
    arguments.emplace_back("--json");
    const Outcome outcome = run(arguments, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    return Json::parse(outcome.out, nullptr, false);
  }

  Json inspectScene(const std::string& nodes, const Arguments& flags = {}) const {
    writeScene(nodes);
    Arguments arguments = {"scene.mrml"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    return inspect(arguments);
  }

  /// Expects a render to be refused in the words of the inspection, or to succeed if it reports no
  /// refusal.
  void expectAsRendered(const Json& said, const std::string& input) const {
    const Outcome rendered =
        run({input, "--size", "4x4", "--samples", "1", "--output", "a.png"}, folder.path());
    if (said["refused"].is_null())
      EXPECT_EQ(rendered.status, 0) << rendered.err;
    else
      EXPECT_EQ(rendered.err, "fenestra: " + said["refused"].get<std::string>() + "\n");
  }

  mutable std::string text; ///< output of the last inspection
};

std::vector<std::string> lines(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> all;
  for (std::string line; std::getline(in, line);)
    all.push_back(line);
  return all;
}

TEST_F(InspectCommand, DescribesVolume) {
  const Json said = inspect({"volume.nrrd"});
  EXPECT_EQ(said["kind"], "volume");
  const Json& volume = said["render"]["volume"];
  EXPECT_EQ(volume["size"], Json({4, 4, 4}));
  EXPECT_EQ(volume["spacing"], Json({1.0, 1.0, 1.0}));
  EXPECT_EQ(volume["center"], Json({-1.5, -1.5, 1.5}));
  EXPECT_EQ(volume["voxelType"], "uint8") << "the least that holds its values";
  EXPECT_EQ(volume["range"], Json({0.0, 63.0}));
  EXPECT_EQ(said["render"]["look"]["source"], "range");
  EXPECT_EQ(said["render"]["camera"]["projection"], "orthographic");
  EXPECT_EQ(said["segmentations"], Json::array());
  EXPECT_TRUE(said["refused"].is_null());
  EXPECT_NE(text.find("4 x 4 x 4 voxels of 1 x 1 x 1 mm, uint8 from 0 to 63"), std::string::npos)
      << text;
  expectAsRendered(said, "volume.nrrd");
}

TEST_F(InspectCommand, DescribesSegments) {
  const Json said = inspect({"segments.seg.nrrd"});
  ASSERT_EQ(said["kind"], "segmentation");
  const Json& segments = said["segmentations"][0]["segments"];
  ASSERT_EQ(segments.size(), 2u);
  EXPECT_EQ(segments[0]["id"], "A");
  EXPECT_EQ(segments[0]["name"], "Bone, left");
  EXPECT_EQ(segments[0]["labelValue"], 1);
  EXPECT_EQ(segments[0]["layer"], 0);
  EXPECT_EQ(segments[0]["voxels"], 1);
  EXPECT_DOUBLE_EQ(segments[0]["milliliters"].get<double>(), 0.001);
  EXPECT_EQ(segments[0]["bounds"]["lower"], Json({-1.5, -1.5, 0.5})) << "voxel 1,1,1 in RAS";
  EXPECT_EQ(segments[0]["bounds"]["upper"], Json({-0.5, -0.5, 1.5}));
  EXPECT_EQ(segments[1]["voxels"], 0);
  EXPECT_TRUE(segments[1]["bounds"].is_null());
}

TEST_F(InspectCommand, TellsWhatEachSegmentIsMadeOf) {
  const Json said = inspect({"segments.seg.nrrd"});
  const Json& bone = said["segmentations"][0]["segments"][0]["material"];
  EXPECT_EQ(bone["name"], "bone");
  EXPECT_EQ(bone["kind"], "tint");
  EXPECT_NEAR(bone["color"][2].get<double>(), 0xdc / 255.0, 1e-9);
  EXPECT_EQ(bone["priority"], 10);
  EXPECT_EQ(bone["clip"], true);
  EXPECT_EQ(bone["density"], 1.0);
  EXPECT_EQ(bone["why"], "by name 'bone*'");
  const Json& other = said["segmentations"][0]["segments"][1]["material"];
  EXPECT_TRUE(other["name"].is_null()) << other;
  EXPECT_NE(text.find("bone      #f6eedc  tint  by name 'bone*'"), std::string::npos) << text;
}

TEST_F(InspectCommand, ReportsLabelMapAsSegmentation) {
  std::string labels(64, '\0');
  std::fill(labels.begin() + 8, labels.begin() + 24, '\3');
  std::fill(labels.begin() + 32, labels.begin() + 48, '\7');
  folder.write("labels.nrrd", NrrdText{"4 4 4", "uint8"}.with(labels));
  const Json said = inspect({"labels.nrrd"});
  ASSERT_EQ(said["kind"], "segmentation");
  ASSERT_EQ(said["segmentations"][0]["segments"].size(), 2u);
  EXPECT_EQ(said["segmentations"][0]["segments"][1]["name"], "Segment_7");
  EXPECT_EQ(said["segmentations"][0]["segments"][1]["voxels"], 16);
  EXPECT_EQ(said["render"]["volume"]["range"], Json({0.0, 7.0})) << "it renders as a volume, too";
}

TEST_F(InspectCommand, ListsSegmentationGivenBesideVolume) {
  const Json said = inspect({"volume.nrrd", "--segmentation", "segments.seg.nrrd"});
  EXPECT_EQ(said["kind"], "volume");
  EXPECT_EQ(said["render"]["segmentation"], "segments.seg.nrrd");
  EXPECT_EQ(said["segmentations"][0]["kind"], "file");
  EXPECT_EQ(said["segmentations"][0]["used"], true);
  EXPECT_EQ(said["segmentations"][0]["segments"].size(), 2u);
  const Json missing = inspect({"volume.nrrd", "--segmentation", "none.nrrd"});
  EXPECT_NE(missing["segmentations"][0]["problem"].get<std::string>().find("there is no such file"),
            std::string::npos);
}

TEST_F(InspectCommand, ListsSceneNodesAndThoseRendered) {
  const Json said = inspectScene(volumeNode + segmentationNode + settings);
  EXPECT_EQ(said["kind"], "scene");
  EXPECT_EQ(said["version"], "Slicer 5.6.2 32448");
  EXPECT_EQ(said["volumes"][0]["files"],
            Json::parse(R"([{"name": "volume.nrrd", "there": true}])"));
  EXPECT_EQ(said["volumes"][0]["transform"], "t1");
  EXPECT_EQ(said["segmentations"][0]["kind"], "segmentation");
  EXPECT_EQ(said["segmentations"][0]["segments"][0]["shown"], true);
  EXPECT_EQ(said["segmentations"][0]["segments"][1]["shown"], false);
  const Json& rendering = said["volumeRenderings"][0];
  EXPECT_EQ(rendering["volume"], "vol1");
  EXPECT_EQ(rendering["property"], "prop1");
  EXPECT_EQ(rendering["roi"], "roi1");
  EXPECT_EQ(rendering["cropping"], true);
  EXPECT_EQ(rendering["followsDisplay"], false);
  EXPECT_EQ(said["views"][0]["layout"], "1");
  EXPECT_EQ(said["views"][0]["background"]["top"], Json({0.0, 0.0, 1.0}));
  EXPECT_EQ(said["transforms"][0]["linear"], true);
  EXPECT_EQ(said["transforms"][0]["toWorld"][1], Json({0.0, 1.0, 0.0, 20.0}));
  for (const char* list : {"volumes", "segmentations", "volumeRenderings", "volumeProperties",
                           "rois", "views", "cameras", "transforms"})
    EXPECT_EQ(said[list][0]["used"], true) << list;
  EXPECT_EQ(said["others"]["SegmentationDisplay"], 1);

  const Json& render = said["render"];
  EXPECT_EQ(render["volume"]["id"], "vol1");
  EXPECT_EQ(render["volume"]["center"], Json({8.5, 18.5, 31.5})) << "moved by the transform";
  EXPECT_EQ(render["volume"]["transforms"], Json({"t1"}));
  EXPECT_EQ(render["look"],
            Json::parse(R"({"source": "volumeProperty", "id": "prop1", "name": "Warm"})"));
  EXPECT_EQ(render["crop"]["edges"], Json({8.0, 10.0, 12.0}));
  EXPECT_EQ(render["crop"]["center"], Json({1.0, 2.0, 3.0}));
  EXPECT_EQ(render["camera"]["id"], "cam1");
  EXPECT_EQ(render["camera"]["position"], Json({0.0, 100.0, 0.0}));
  EXPECT_EQ(render["camera"]["scale"], 20.0);
  EXPECT_EQ(render["background"]["bottom"], Json({1.0, 0.0, 0.0}));
  EXPECT_EQ(render["segmentation"], "seg1");
  EXPECT_NE(text.find("#ff0000 below to #0000ff above"), std::string::npos) << text;
  ASSERT_EQ(said["warnings"].size(), 1u);
  EXPECT_EQ(said["warnings"][0], "the cropping box lies outside the volume: nothing is left of it");
  expectAsRendered(said, "scene.mrml");
}

TEST_F(InspectCommand, VolumeFlagChoosesAmongSeveral) {
  const std::string second = R"(<Volume id="vol2" name="MR" references="storage:store1;"/>)";
  const std::string volumes = R"(
    <VolumeArchetypeStorage id="store1" name="s" fileName="volume.nrrd"/>
    <Volume id="vol1" name="CT" references="storage:store1;"/>)" +
                              second;
  const Json open = inspectScene(volumes);
  EXPECT_TRUE(open["render"].is_null());
  EXPECT_EQ(open["volumes"].size(), 2u);
  EXPECT_NE(open["refused"].get<std::string>().find("choose one with --volume"), std::string::npos);
  EXPECT_NE(text.find("A render would be refused: scene.mrml: has several volumes"),
            std::string::npos)
      << text;
  expectAsRendered(open, "scene.mrml");

  const Json chosen = inspectScene(volumes, {"--volume", "MR"});
  EXPECT_TRUE(chosen["refused"].is_null());
  EXPECT_EQ(chosen["render"]["volume"]["id"], "vol2");
  EXPECT_EQ(chosen["volumes"][0]["used"], false);
  EXPECT_EQ(chosen["volumes"][1]["used"], true);
  EXPECT_EQ(chosen["ignored"][0], "Volume CT (vol1): another volume is rendered");
}

TEST_F(InspectCommand, ReportsAmbiguousSegmentation) {
  const std::string second =
      R"(<Segmentation id="seg2" name="Rest" references="storage:store2;"/>)";
  const Json open = inspectScene(volumeNode + segmentationNode + settings + second);
  EXPECT_TRUE(open["refused"].is_null()) << "without a focus there is nothing to choose";
  EXPECT_TRUE(open["render"]["segmentation"].is_null());
  EXPECT_NE(open["render"]["segmentationProblem"].get<std::string>().find("--segmentation"),
            std::string::npos);
  const Json chosen =
      inspectScene(volumeNode + segmentationNode + settings + second, {"--segmentation", "Rest"});
  EXPECT_EQ(chosen["render"]["segmentation"], "seg2");
  EXPECT_TRUE(chosen["render"]["segmentationProblem"].is_null());
  const Json none =
      inspectScene(volumeNode + segmentationNode + settings, {"--segmentation", "nowhere"});
  EXPECT_EQ(none["render"]["segmentationProblem"],
            "--segmentation nowhere: is neither in the scene nor a file");
}

TEST_F(InspectCommand, ReportsWhyRenderWouldRefuse) {
  struct Case {
    std::string name, nodes, line;
  };
  const std::string plainVolume = R"(
    <VolumeArchetypeStorage id="store1" name="s" fileName="volume.nrrd"/>
    <Volume id="vol1" name="CT" references="storage:store1;transform:t1;"/>)";
  for (const Case& c : std::vector<Case>{
           {"no volume", segmentationNode, "holds no scalar volume"},
           {"technique",
            volumeNode + settings + R"(<View id="view1" name="V" layoutName="1" active="true"
              raycastTechnique="MaximumIntensityProjection"/>)",
            "a maximum intensity projection"},
           {"missing file",
            R"(<VolumeArchetypeStorage id="s" fileName="gone.nrrd"/>
               <Volume id="vol1" name="CT" references="storage:s;"/>)",
            "gone.nrrd, which is not there"},
           {"warp", plainVolume + R"(<BSplineTransform id="t1" name="Warp"/>)", "is not linear"},
           {"camera", plainVolume + R"(<Camera id="c" name="Eye" position="1 2" focalPoint="0 0 0"
              viewUp="0 0 1"/>)",
            "position: must be three numbers"},
       }) {
    SCOPED_TRACE(c.name);
    const Json said = inspectScene(c.nodes);
    ASSERT_TRUE(said["refused"].is_string());
    EXPECT_NE(said["refused"].get<std::string>().find(c.line), std::string::npos)
        << said["refused"];
    EXPECT_EQ(said["volumes"].size() + said["segmentations"].size(), 1u);
    expectAsRendered(said, "scene.mrml");
  }
}

TEST_F(InspectCommand, NamesTheDamagedPart) {
  folder.write("cut.seg.nrrd", segments().substr(0, segments().size() - 9));
  const std::string cut = R"(<SegmentationStorage id="store3" fileName="cut.seg.nrrd"/>
    <Segmentation id="seg2" name="Cut" references="storage:store3;"/>
    <BSplineTransform id="t2" name="Warp"/>)";
  const Json said = inspectScene(volumeNode + cut + segmentationNode + settings);
  EXPECT_TRUE(said["refused"].is_null());
  EXPECT_NE(said["segmentations"][0]["problem"].get<std::string>().find("cut.seg.nrrd: "),
            std::string::npos);
  EXPECT_TRUE(said["segmentations"][0]["size"].is_null());
  EXPECT_TRUE(said["segmentations"][1]["problem"].is_null());
  EXPECT_EQ(said["segmentations"][1]["segments"].size(), 2u);
  EXPECT_EQ(said["transforms"][0]["linear"], false);
  EXPECT_NE(said["transforms"][0]["problem"].get<std::string>().find("is not linear"),
            std::string::npos);

  const Json missing = inspectScene(
      R"(<VolumeArchetypeStorage id="s" fileName="gone%20away.nrrd"/>
         <Volume id="vol1" name="CT" references="storage:s;"/>)");
  EXPECT_EQ(missing["volumes"][0]["files"],
            Json::parse(R"([{"name": "gone away.nrrd", "there": false}])"));
  EXPECT_NE(text.find("gone away.nrrd (missing)"), std::string::npos) << text;
}

/// HDF5 file of symbols in a tree of five levels; the `children` entries of each node all point to
/// one node below: a walk meets children^5 leaves.
std::string fanningTree(std::size_t children) {
  using namespace std::string_literals;
  const auto number = [](std::uint64_t value, std::size_t size) { // little-endian, as here
    return std::string(reinterpret_cast<const char*>(&value), size);
  };
  constexpr std::size_t root = 72, firstNode = 200;
  const std::size_t nodeSize = 32 + 16 * children;
  const std::size_t leaf = firstNode + 5 * nodeSize, heap = leaf + 8 + 4 * 40;
  std::string file = "\x89HDF\r\n\x1a\n"s + std::string(5, '\0') + "\x08\x08" +
                     std::string(49, '\0') + number(root, 8);
  file += "\1"s + std::string(7, '\0') + number(24, 4) + number(0, 4); // header of the root
  file += number(0x11, 2) + number(16, 2) + number(0, 4) + number(firstNode, 8) + number(heap, 8);
  for (std::size_t level = 0; level < 5; ++level) {
    const std::size_t begin = firstNode + level * nodeSize;
    file.resize(begin);
    file += "TREE\0"s + (level < 4 ? '\1' : '\0') + number(children, 2) + std::string(16, '\0');
    for (std::size_t i = 0; i < children; ++i)
      file += number(0, 8) + number(level < 4 ? begin + nodeSize : leaf, 8);
  }
  file.resize(leaf);
  file += "SNOD\0\0"s + number(4, 2);
  for (int i = 0; i < 4; ++i)
    file += number(0, 8) + number(root, 8) + std::string(24, '\0');
  return file + "HEAP\0\0\0\0"s + number(16, 8) + number(0, 8) + number(heap + 32, 8) +
         number('a', 8) + number(0, 8);
}

TEST_F(InspectCommand, RefusesHdf5TreeThatFansOut) {
  const std::string line = "t.h5: is damaged, truncated or no transform of ITK's; save it again";
  writeScene(volumeNode + R"(<LinearTransformStorage id="ts" fileName="t.h5"/>
    <LinearTransform id="t1" references="storage:ts;"/>)");
  folder.write("t.h5", fanningTree(40));
  const Outcome inspected = run({"inspect", "scene.mrml"}, folder.path());
  EXPECT_NE(inspected.out.find("problem: " + line), std::string::npos) << inspected.out;
  folder.write("t.h5", fanningTree(2000));
  const Outcome rendered = run({"scene.mrml", "--size", "8x8"}, folder.path());
  EXPECT_EQ(rendered.status, 3);
  EXPECT_EQ(rendered.err, "fenestra: " + line + "\n");
}

TEST_F(InspectCommand, PrintsUntrustedNamesOnOneLine) {
  const std::string evil = "&#27;[31mred&#10;" + std::string(300, 'x') + "\xc3\xa4";
  std::string models;
  for (int i = 0; i < 300; ++i)
    models += "<Model id=\"m" + std::to_string(i) + "\" name=\"Model\"/>";
  const Json said =
      inspectScene(volumeNode + settings + "<VolumeProperty id=\"p2\" name=\"" + evil +
                   "\"/><Camera id=\"c2\" layoutName=\"" + evil + "\"/>" + models);
  EXPECT_EQ(said["volumeProperties"][1]["name"],
            "\033[31mred\n" + std::string(300, 'x') + "\xc3\xa4");
  for (const std::string& line : lines(text)) {
    EXPECT_LE(line.size(), 100u) << line;
    EXPECT_EQ(std::count_if(line.begin(), line.end(), [](char c) { return c >= 0 && c < ' '; }), 0);
    EXPECT_FALSE(line.ends_with(' ')) << line;
  }
  EXPECT_LT(lines(text).size(), 60u) << "300 models are a number";
  EXPECT_NE(text.find("Model (300)"), std::string::npos) << text;
  EXPECT_EQ(said["others"]["Model"], 300);
}

TEST_F(InspectCommand, RefusesInputThatIsNoVolumeOrScene) {
  folder.write("text.nrrd", "These are\nonly words.\n");
  folder.write("text.mrml", "<html/>");
  folder.write("text.mrb", "words");
  const auto of = [](const std::string& file) { return Arguments{"inspect", file}; };
  expectRefused(
      {
          {"nothing", {"inspect"}, 2, "INPUT: is missing"},
          {"missing", of("missing.nrrd"), 3, "missing.nrrd: there is no such file"},
          {"missing scene", of("missing.mrml"), 3, "missing.mrml: there is no such file"},
          {"words", of("text.nrrd"), 3, "text.nrrd: is not a NRRD file"},
          {"web page", of("text.mrml"), 3, "text.mrml: has no MRML element"},
          {"no archive", of("text.mrb"), 3, "text.mrb: "},
          {"no images", of("."), 3, ".: "},
          {"switch with a value", {"inspect", "volume.nrrd", "--json=1"}, 2, "--json: is a switch"},
          {"volume of one", {"inspect", "volume.nrrd", "--volume", "CT"}, 2, "--volume: only a"},
          {"flag of another", {"inspect", "volume.nrrd", "--seed", "1"}, 2, "no such flag"},
          {"misspelt", {"inspct", "volume.nrrd"}, 2, "did you mean fenestra inspect?"},
      },
      folder.path());
}

// ---- real files
// ----------------------------------------------------------------------------------

struct RealScene {
  std::string file;
  std::size_t volumes, segmentations, properties;
  std::string refused; ///< part of the line; empty: renders
};

TEST_F(InspectCommand, DescribesRealScenes) {
  const std::filesystem::path root(FENESTRA_DATA);
  if (!std::filesystem::exists(root))
    GTEST_SKIP() << "no real data at " << FENESTRA_DATA;
  const std::string slicer = "slicer_scenes/";
  for (const RealScene& real : std::vector<RealScene>{
           {slicer + "slicer_5_2_written/chest.mrb", 1, 1, 1, ""},
           {slicer + "slicer_5_2_written/chest_transformed_cropped.mrb", 1, 1, 1, ""},
           {slicer + "slicerrt_scenes/Scenes/EclipseProstate_Dvh_Scene.mrml", 1, 1, 0, ""},
           {slicer + "slicerrt_scenes/Scenes/TinyPatient_ExternalBeamPlanning_Scene.mrml", 2, 1, 0,
            "has several volumes"},
           {"spl_knee_atlas_labels/KneeAtlas-2015Sept-Slicer4-4Version.mrml", 1, 1, 0,
            "which is not there"},
           {slicer + "slicer_core/volRender.mrml", 0, 0, 1, "holds no scalar volume"},
           {slicer + "slicer_core/vol_and_cube.mrml", 1, 0, 0, "which is not there"},
           {slicer + "slicer_core/restoreSceneSnapshotCompareView.mrml", 0, 0, 0,
            "holds no scalar volume"},
           {slicer + "vr_properties/US-VrPresets.mrml", 0, 0, 8, "holds no scalar volume"},
           {slicer + "vr_properties/SM_presets.mrml", 0, 0, 2, "holds no scalar volume"},
       }) {
    SCOPED_TRACE(real.file);
    const std::string file = (root / real.file).string();
    const Json said = inspect({file});
    EXPECT_EQ(said["volumes"].size(), real.volumes);
    EXPECT_EQ(said["segmentations"].size(), real.segmentations);
    EXPECT_EQ(said["volumeProperties"].size(), real.properties);
    if (real.refused.empty())
      EXPECT_TRUE(said["refused"].is_null()) << said["refused"];
    else
      EXPECT_NE(said["refused"].dump().find(real.refused), std::string::npos) << said["refused"];
    expectAsRendered(said, file);
  }
}

TEST_F(InspectCommand, ListsDicomSeries) {
  const auto series = std::filesystem::path(FENESTRA_DATA) / "head_ct_slicer_dicom" / "dicom";
  if (!std::filesystem::exists(series))
    GTEST_SKIP() << "no real data at " << FENESTRA_DATA;
  const Json said = inspect({series.string()});
  EXPECT_EQ(said["kind"], "dicom");
  ASSERT_EQ(said["series"].size(), 1u);
  EXPECT_EQ(said["series"][0]["files"], 93);
  EXPECT_EQ(said["series"][0]["modality"], "CT");
  EXPECT_EQ(said["render"]["volume"]["size"], Json({64, 64, 93}));
  EXPECT_EQ(said["render"]["look"]["name"], "ct-soft") << "its air is at 0";
  EXPECT_EQ(said["segmentations"], Json::array());
  const Json other = inspect({series.string(), "--volume", "none"});
  EXPECT_TRUE(other["render"].is_null());
  EXPECT_NE(other["refused"].dump().find("--volume"), std::string::npos) << other["refused"];
}

TEST_F(InspectCommand, DescribesSceneWrittenBySlicer) {
  const auto file = std::filesystem::path(FENESTRA_DATA) / "slicer_scenes" / "slicer_5_2_written" /
                    "chest_transformed_cropped.mrb";
  if (!std::filesystem::exists(file))
    GTEST_SKIP() << "no real data at " << FENESTRA_DATA;
  const Json said = inspect({file.string()});
  EXPECT_EQ(said["version"], "Slicer 5.2.2 31383");
  const Json& render = said["render"];
  EXPECT_EQ(render["volume"]["size"], Json({128, 128, 34}));
  EXPECT_EQ(render["volume"]["transforms"], Json({"vtkMRMLLinearTransformNode4"}));
  EXPECT_EQ(render["look"]["name"], "CT-Chest-Contrast-Enhanced");
  EXPECT_NEAR(render["crop"]["edges"][0].get<double>(), 300.0, 1e-9);
  EXPECT_NEAR(render["crop"]["center"][2].get<double>(), -170.0, 1e-9);
  EXPECT_EQ(render["camera"]["projection"], "perspective");
  EXPECT_EQ(said["segmentations"][0]["segments"].size(), 7u);
  EXPECT_EQ(said["segmentations"][0]["segments"][4]["name"], "right lung");
  EXPECT_EQ(said["segmentations"][0]["segments"][4]["voxels"], 34450);
  EXPECT_EQ(said["segmentations"][0]["segments"][4]["material"]["why"], "by SCT^39607008");
  EXPECT_NEAR(said["transforms"][0]["toWorld"][0][1].get<double>(), -0.34202, 1e-5);
  EXPECT_EQ(said["warnings"], Json::array());
}

} // namespace
} // namespace fenestra::InspectCommandTests
