// `fenestra inspect`: its JSON output for small inputs, and its agreement with a render.

#include "InspectTesting.h"

namespace fenestra::core::InspectCommandTests {
namespace {

TEST_F(InspectCommand, DescribesVolume) {
  const Json report = inspect({"volume.nrrd"});
  EXPECT_EQ(report["kind"], "volume");
  const Json& volume = report["render"]["volume"];
  EXPECT_EQ(volume["size"], Json({4, 4, 4}));
  EXPECT_EQ(volume["spacing"], Json({1.0, 1.0, 1.0}));
  EXPECT_EQ(volume["center"], Json({-1.5, -1.5, 1.5}));
  EXPECT_EQ(volume["voxelType"], "uint8") << "the smallest type for these values";
  EXPECT_EQ(volume["range"], Json({0.0, 63.0}));
  EXPECT_EQ(report["render"]["look"]["source"], "range");
  EXPECT_EQ(report["render"]["camera"]["projection"], "orthographic");
  EXPECT_EQ(report["segmentations"], Json::array());
  EXPECT_TRUE(report["refused"].is_null());
  expectStated(text, " | 4 x 4 x 4 | uint8 | 63");
  expectSameAsRender(report, "volume.nrrd");
}

TEST_F(InspectCommand, DescribesSegments) {
  const Json report = inspect({"segments.seg.nrrd"});
  ASSERT_EQ(report["kind"], "segmentation");
  const Json& segments = report["segmentations"][0]["segments"];
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

TEST_F(InspectCommand, ReportsTheMaterialOfEachSegment) {
  const Json report = inspect({"segments.seg.nrrd"});
  const Json& bone = report["segmentations"][0]["segments"][0]["material"];
  EXPECT_EQ(bone["name"], "bone");
  EXPECT_EQ(bone["kind"], "tint");
  EXPECT_NEAR(bone["color"][2].get<double>(), 0xb4 / 255.0, 1e-9);
  EXPECT_EQ(bone["priority"], 10);
  EXPECT_EQ(bone["clip"], true);
  EXPECT_EQ(bone["density"], 1.0);
  EXPECT_EQ(bone["why"], "by name 'bone*'");
  const Json& other = report["segmentations"][0]["segments"][1]["material"];
  EXPECT_TRUE(other["name"].is_null()) << other;
  expectStated(text, " | #e3d3b4 | 'bone*'");
}

TEST_F(InspectCommand, ReportsLabelMapAsSegmentation) {
  std::string labels(64, '\0');
  std::fill(labels.begin() + 8, labels.begin() + 24, '\3');
  std::fill(labels.begin() + 32, labels.begin() + 48, '\7');
  folder.write("labels.nrrd", NrrdText{"4 4 4", "uint8"}.encode(labels));
  const Json report = inspect({"labels.nrrd"});
  ASSERT_EQ(report["kind"], "segmentation");
  ASSERT_EQ(report["segmentations"][0]["segments"].size(), 2u);
  EXPECT_EQ(report["segmentations"][0]["segments"][1]["name"], "Segment_7");
  EXPECT_EQ(report["segmentations"][0]["segments"][1]["voxels"], 16);
  EXPECT_EQ(report["render"]["volume"]["range"], Json({0.0, 7.0})) << "usable as a volume";
}

TEST_F(InspectCommand, ListsSegmentationGivenBesideVolume) {
  const Json report = inspect({"volume.nrrd", "--segmentation", "segments.seg.nrrd"});
  EXPECT_EQ(report["kind"], "volume");
  EXPECT_EQ(report["render"]["segmentation"], "segments.seg.nrrd");
  EXPECT_EQ(report["segmentations"][0]["kind"], "file");
  EXPECT_EQ(report["segmentations"][0]["used"], true);
  EXPECT_EQ(report["segmentations"][0]["segments"].size(), 2u);
  const Json missing = inspect({"volume.nrrd", "--segmentation", "none.nrrd"});
  expectStated(missing["segmentations"][0]["problem"], "none.nrrd:");
}

TEST_F(InspectCommand, ExampleForAFolderOfMasksRuns) {
  std::filesystem::create_directory(folder / "two masks");
  for (const auto& [name, voxels] : {std::pair("heart", 0U), {"left lung", 8U}})
    folder.write(std::string("two masks/") + name + ".nrrd",
                 NrrdText{"4 4 4", "uint8"}.encode(std::string(64 - voxels, '\0') +
                                                   std::string(voxels, '\1')));
  std::filesystem::remove(folder / "segments.seg.nrrd"); // else the volume is not the only one
  const Json report = inspect({"two masks"});
  EXPECT_EQ(report["kind"], "segmentation");
  EXPECT_EQ(report["segmentations"][0]["segments"].size(), 2u);
  EXPECT_EQ(report["segmentations"][0]["segments"][0]["voxels"], 0);
  ASSERT_EQ(report["examples"].size(), 1u);
  EXPECT_EQ(report["examples"][0], (Json{{"volume", "volume.nrrd"},
                                         {"choice", nullptr},
                                         {"segmentation", "two masks"},
                                         {"focus", "left lung"},
                                         {"spacing", nullptr}}));
  EXPECT_NE(run({"inspect", "two masks"}, folder.path())
                .out.find("fenestra volume.nrrd --segmentation 'two masks' --focus 'left lung' "
                          "--output image.png\n"),
            std::string::npos);
  const Outcome both = renderVolume({"--segmentation", "two masks", "--focus", "left lung,heart"});
  EXPECT_EQ(both.status, 0) << both.messages;
  expectStated(both.messages, " | warning | two masks | heart");
  EXPECT_EQ(renderVolume({"--segmentation", "two masks", "--focus", "heart"}).status, 3);
}

TEST_F(InspectCommand, ListsSceneNodesAndThoseRendered) {
  const Json report = inspectScene(volumeNode + segmentationNode + settingNodes);
  EXPECT_EQ(report["kind"], "scene");
  EXPECT_EQ(report["version"], "Slicer 5.6.2 32448");
  EXPECT_EQ(report["volumes"][0]["files"],
            Json::parse(R"([{"name": "volume.nrrd", "there": true}])"));
  EXPECT_EQ(report["volumes"][0]["transform"], "t1");
  EXPECT_EQ(report["segmentations"][0]["kind"], "segmentation");
  EXPECT_EQ(report["segmentations"][0]["segments"][0]["shown"], true);
  EXPECT_EQ(report["segmentations"][0]["segments"][1]["shown"], false);
  const Json& rendering = report["volumeRenderings"][0];
  EXPECT_EQ(rendering["volume"], "vol1");
  EXPECT_EQ(rendering["property"], "prop1");
  EXPECT_EQ(rendering["roi"], "roi1");
  EXPECT_EQ(rendering["cropping"], true);
  EXPECT_EQ(rendering["followsDisplay"], false);
  EXPECT_EQ(report["views"][0]["layout"], "1");
  EXPECT_EQ(report["views"][0]["background"]["top"], Json({0.0, 0.0, 1.0}));
  EXPECT_EQ(report["transforms"][0]["linear"], true);
  EXPECT_EQ(report["transforms"][0]["toWorld"][1], Json({0.0, 1.0, 0.0, 20.0}));
  for (const char* list : {"volumes", "segmentations", "volumeRenderings", "volumeProperties",
                           "rois", "views", "cameras", "transforms"})
    EXPECT_EQ(report[list][0]["used"], true) << list;
  EXPECT_EQ(report["others"]["SegmentationDisplay"], 1);
  const Json& library = report["materials"];
  const auto liver =
      std::ranges::find(library, "liver", [](const Json& one) { return one["name"]; });
  ASSERT_NE(liver, library.end());
  EXPECT_EQ((*liver)["kind"], "tint");
  EXPECT_EQ((*liver)["color"][0], 0x6a / 255.0);

  const Json& render = report["render"];
  EXPECT_EQ(render["volume"]["id"], "vol1");
  EXPECT_EQ(render["volume"]["center"], Json({8.5, 18.5, 31.5})) << "after the transform";
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
  EXPECT_NE(text.find("#ff0000 (bottom) to #0000ff (top)"), std::string::npos) << text;
  ASSERT_EQ(report["warnings"].size(), 1u);
  EXPECT_EQ(report["warnings"][0], "crop box: lies outside the volume, so the image is empty");
  expectSameAsRender(report, "scene.mrml");
}

TEST_F(InspectCommand, VolumeOptionChoosesOneOfSeveral) {
  const std::string second = R"(<Volume id="vol2" name="MR" references="storage:store1;"/>)";
  const std::string volumes = R"(
    <VolumeArchetypeStorage id="store1" name="s" fileName="volume.nrrd"/>
    <Volume id="vol1" name="CT" references="storage:store1;"/>)" +
                              second;
  const Json open = inspectScene(volumes);
  EXPECT_TRUE(open["render"].is_null());
  EXPECT_EQ(open["volumes"].size(), 2u);
  EXPECT_NE(open["refused"].get<std::string>().find("--volume"), std::string::npos);
  expectStated(text, "scene.mrml: | --volume");
  expectSameAsRender(open, "scene.mrml");

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
  const Json open = inspectScene(volumeNode + segmentationNode + settingNodes + second);
  EXPECT_TRUE(open["refused"].is_null()) << "no segmentation is needed without a focus";
  EXPECT_TRUE(open["render"]["segmentation"].is_null());
  EXPECT_NE(open["render"]["segmentationProblem"].get<std::string>().find("--segmentation"),
            std::string::npos);
  const Json chosen = inspectScene(volumeNode + segmentationNode + settingNodes + second,
                                   {"--segmentation", "Rest"});
  EXPECT_EQ(chosen["render"]["segmentation"], "seg2");
  EXPECT_TRUE(chosen["render"]["segmentationProblem"].is_null());
  const Json none =
      inspectScene(volumeNode + segmentationNode + settingNodes, {"--segmentation", "nowhere"});
  EXPECT_EQ(none["render"]["segmentationProblem"],
            "nowhere: neither a node of the scene nor a file");
}

// ---- real data
// -----------------------------------------------------------------------------------

struct RealScene {
  std::string file;
  std::size_t volumes, segmentations, properties;
  std::string refused; ///< part of the error; empty: can be rendered
};

TEST_F(InspectCommand, DescribesRealScenes) {
  const std::filesystem::path root(FENESTRA_DATA);
  if (!std::filesystem::exists(root))
    GTEST_SKIP() << "real data not found: " << FENESTRA_DATA;
  const std::string slicer = "slicer_scenes/";
  for (const RealScene& scene : std::vector<RealScene>{
           {slicer + "slicer_5_2_written/chest.mrb", 1, 1, 1, ""},
           {slicer + "slicer_5_2_written/chest_transformed_cropped.mrb", 1, 1, 1, ""},
           {slicer + "slicerrt_scenes/Scenes/EclipseProstate_Dvh_Scene.mrml", 1, 1, 0, ""},
           {slicer + "slicerrt_scenes/Scenes/TinyPatient_ExternalBeamPlanning_Scene.mrml", 2, 1, 0,
            "TinyPatient_ExternalBeamPlanning_Scene.mrml:"},
           {"spl_knee_atlas_labels/KneeAtlas-2015Sept-Slicer4-4Version.mrml", 1, 1, 0,
            "Slicer4-4Version.mrml:"},
           {slicer + "slicer_core/volRender.mrml", 0, 0, 1, "volRender.mrml:"},
           {slicer + "slicer_core/vol_and_cube.mrml", 1, 0, 0, "vol_and_cube.mrml:"},
           {slicer + "slicer_core/restoreSceneSnapshotCompareView.mrml", 0, 0, 0,
            "restoreSceneSnapshotCompareView.mrml:"},
           {slicer + "vr_properties/US-VrPresets.mrml", 0, 0, 8, "US-VrPresets.mrml:"},
           {slicer + "vr_properties/SM_presets.mrml", 0, 0, 2, "SM_presets.mrml:"},
       }) {
    SCOPED_TRACE(scene.file);
    const std::string file = (root / scene.file).string();
    const Json report = inspect({file});
    EXPECT_EQ(report["volumes"].size(), scene.volumes);
    EXPECT_EQ(report["segmentations"].size(), scene.segmentations);
    EXPECT_EQ(report["volumeProperties"].size(), scene.properties);
    if (scene.refused.empty())
      EXPECT_TRUE(report["refused"].is_null()) << report["refused"];
    else
      EXPECT_NE(report["refused"].dump().find(scene.refused), std::string::npos)
          << report["refused"];
    expectSameAsRender(report, file);
  }
}

TEST_F(InspectCommand, ListsDicomSeries) {
  const auto series = std::filesystem::path(FENESTRA_DATA) / "head_ct_slicer_dicom" / "dicom";
  if (!std::filesystem::exists(series))
    GTEST_SKIP() << "real data not found: " << FENESTRA_DATA;
  const Json report = inspect({series.string()});
  EXPECT_EQ(report["kind"], "dicom");
  ASSERT_EQ(report["series"].size(), 1u);
  EXPECT_EQ(report["series"][0]["files"], 93);
  EXPECT_EQ(report["series"][0]["modality"], "CT");
  EXPECT_EQ(report["render"]["volume"]["size"], Json({64, 64, 93}));
  EXPECT_EQ(report["render"]["look"]["name"], "ct-skin") << "a CT with air at 0";
  EXPECT_EQ(report["segmentations"], Json::array());
  const Json other = inspect({series.string(), "--volume", "none"});
  EXPECT_TRUE(other["render"].is_null());
  EXPECT_NE(other["refused"].dump().find("none"), std::string::npos) << other["refused"];
}

TEST_F(InspectCommand, DescribesSceneWrittenBySlicer) {
  const auto file = std::filesystem::path(FENESTRA_DATA) / "slicer_scenes" / "slicer_5_2_written" /
                    "chest_transformed_cropped.mrb";
  if (!std::filesystem::exists(file))
    GTEST_SKIP() << "real data not found: " << FENESTRA_DATA;
  const Json report = inspect({file.string()});
  EXPECT_EQ(report["version"], "Slicer 5.2.2 31383");
  const Json& render = report["render"];
  EXPECT_EQ(render["volume"]["size"], Json({128, 128, 34}));
  EXPECT_EQ(render["volume"]["transforms"], Json({"vtkMRMLLinearTransformNode4"}));
  EXPECT_EQ(render["look"]["name"], "CT-Chest-Contrast-Enhanced");
  EXPECT_NEAR(render["crop"]["edges"][0].get<double>(), 300.0, 1e-9);
  EXPECT_NEAR(render["crop"]["center"][2].get<double>(), -170.0, 1e-9);
  EXPECT_EQ(render["camera"]["projection"], "perspective");
  EXPECT_EQ(report["segmentations"][0]["segments"].size(), 7u);
  EXPECT_EQ(report["segmentations"][0]["segments"][4]["name"], "right lung");
  EXPECT_EQ(report["segmentations"][0]["segments"][4]["voxels"], 34450);
  EXPECT_EQ(report["segmentations"][0]["segments"][4]["material"]["why"], "by SCT^39607008");
  EXPECT_NEAR(report["transforms"][0]["toWorld"][0][1].get<double>(), -0.34202, 1e-5);
  ASSERT_EQ(report["warnings"].size(), 1u);
  expectStated(report["warnings"][0].get<std::string>(), "CTChest4: | --table keep");
}

} // namespace
} // namespace fenestra::core::InspectCommandTests
