// Nodes of scenes: geometry, transforms, crop boxes, cameras, visibility.

#include "Approx.h"
#include "SceneTesting.h"

namespace fenestra::core::MrmlSceneTests {
namespace {

const MrmlNode& findNode(const MrmlScene& scene, const std::string& id) {
  return *scene.document.find(id);
}

void expectSame(const Affine& a, const Affine& b, double tolerance = 1e-12) {
  for (int i = 0; i < 3; ++i)
    EXPECT_LT((a.linear().col(i) - b.linear().col(i)).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_LT((a.translation() - b.translation()).cwiseAbs().maxCoeff(), tolerance);
}

Affine makeAffine(std::initializer_list<double> rows) {
  Affine map;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      (column < 3 ? map.linear()(row, column) : map.translation()[row]) =
          std::data(rows)[4 * row + column];
  return map;
}

// Volumes.

TEST(MrmlScene, GeometryComesFromFileNotFromScene) {
  const SceneFolder folder;
  MrmlScene scene = folder.makeScene(volumeNode);
  const Volume volume = readSceneVolume(scene, findNode(scene, "vol1"));
  EXPECT_EQ(volume.grid.size, Size3(3, 4, 2));
  expectSame(volume.grid.indexToWorld, makeAffine({-1, 0, 0, -10, 0, -2, 0, -20, 0, 0, 3, 30}));
  EXPECT_EQ(volume.maximum, 230);
  EXPECT_EQ(volume.name, "CT");
}

Grid readGrid(const SceneFolder& folder, const std::string& attributes) {
  MrmlScene scene = folder.makeScene(R"(<Volume id="v" storageNodeRef="s"/>
    <VolumeArchetypeStorage id="s" fileName="ct.nrrd" )" +
                                     attributes + "/>");
  return readSceneVolume(scene, findNode(scene, "v")).grid;
}

TEST(MrmlScene, StorageAttributesCenterOrReorientVolume) {
  const SceneFolder folder;
  const Affine fromFile = makeAffine({-1, 0, 0, -10, 0, -2, 0, -20, 0, 0, 3, 30});
  expectSame(readGrid(folder, R"(centerImage="0" UseOrientationFromFile="1")").indexToWorld,
             fromFile);
  const Grid centered = readGrid(folder, R"(centerImage="1")");
  expectSame(Affine(centered.indexToWorld.linear()), Affine(fromFile.linear()));
  EXPECT_TRUE(centered.worldCenter().isZero(1e-12));
  expectSame(readGrid(folder, R"(UseOrientationFromFile="0" centerImage="1")").indexToWorld,
             makeAffine({1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 3, 0}));
}

TEST(MrmlScene, ErrorNamesNodeOfMissingFile) {
  const SceneFolder folder;
  const auto path = folder.writeScene(R"(<Volume id="v" name="CT" storageNodeRef="s"/>
    <VolumeArchetypeStorage id="s" fileName="gone.nrrd"/><Volume id="w" name="MR"/>)");
  MrmlScene scene(path);
  expectRefused(path, "missing-file: gone.nrrd",
                [&] { readSceneVolume(scene, findNode(scene, "v")); });
  expectRefused(path, "invalid-field: Volume MR (w)",
                [&] { readSceneVolume(scene, findNode(scene, "w")); });
}

TEST(MrmlScene, WarningNamesVolumeByPathInArchive) {
  const SceneFolder folder;
  std::vector<float> samples(24, 0.0F);
  samples[5] = std::nanf("");
  writeFile(folder / "odd.nrrd", samples);
  const auto archive = folder / "a.mrb";
  writeArchive(archive, {{"a/a.mrml", R"(<MRML><Volume id="v" storageNodeRef="s"/>
    <VolumeArchetypeStorage id="s" fileName="odd.nrrd"/></MRML>)"},
                         {"a/odd.nrrd", readBytes(folder / "odd.nrrd")}});
  MrmlScene scene(archive);
  const Volume volume = readSceneVolume(scene, findNode(scene, "v"));
  EXPECT_EQ(volume.name, archive.string() + "/a/odd.nrrd");
  ASSERT_EQ(volume.warnings.size(), 1U);
  EXPECT_EQ(volume.warnings[0].subject, archive.string() + "/a/odd.nrrd");
  expectMessage(volume.warnings[0], "non-finite-voxels | 1");
}

TEST(MrmlScene, SegmentationAndLabelMapAreInWorldSpace) {
  const SceneFolder folder;
  std::vector<std::uint8_t> labels(24, 0);
  labels[1] = 5;
  FileGeometry geometry;
  geometry.origin = {10, 20, 30};
  geometry.spacing = {1, 2, 3};
  writeFile(folder / "labels.nrrd", labels, geometry);
  MrmlScene scene = folder.makeScene(R"(
    <LinearTransform id="t" matrixTransformToParent="1 0 0 100 0 1 0 0 0 0 1 0 0 0 0 1"/>
    <Segmentation id="s" storageNodeRef="ss" transformNodeRef="t"/>
    <SegmentationStorage id="ss" fileName="labels.nrrd"/>
    <LabelMapVolume id="l" storageNodeRef="ls"/>
    <VolumeArchetypeStorage id="ls" fileName="labels.nrrd" UseOrientationFromFile="0"/>)");
  EXPECT_TRUE(
      isApprox(readSceneSegmentation(scene, findNode(scene, "s")).grid().indexToWorld.translation(),
               Vec3(90, -20, 30)));
  const Segmentation labelMap = readSceneSegmentation(scene, findNode(scene, "l"));
  EXPECT_TRUE(labelMap.grid().indexToWorld.translation().isZero());
  EXPECT_EQ(labelMap.segments().at(0).labelValue, 5);
}

TEST(MrmlScene, UserLabelTablePrecedesTableInArchive) {
  const SceneFolder folder;
  std::vector<std::uint8_t> labels(24, 0);
  labels[1] = 5;
  writeFile(folder / "labels.nrrd", labels);
  const auto table = folder.write("names.json", R"({"5": "liver"})");
  const auto archive = folder / "a.mrb";
  const auto readWith = [&](const std::string& tableInside) {
    writeArchive(archive, {{"a/a.mrml", R"(<MRML><LabelMapVolume id="l" storageNodeRef="s"/>
      <VolumeArchetypeStorage id="s" fileName="labels.nrrd"/></MRML>)"},
                           {"a/labels.nrrd", readBytes(folder / "labels.nrrd")},
                           {"a/labels.ctbl", tableInside}});
    MrmlScene scene(archive);
    return readSceneSegmentation(scene, findNode(scene, "l"), nullptr, table);
  };
  EXPECT_EQ(readWith("5 kidney 0 0 0 255").segments().at(0).name, "liver");
}

TEST(MrmlScene, ReadsVisibilityOfSegments) {
  const SceneFolder folder;
  MrmlScene scene = folder.makeScene(R"(<Segmentation id="s" displayNodeRef="d"/>
    <SegmentationDisplay id="d" SegmentationDisplayProperties="A%20b OverrideColorR:-1 Visible:true Visible3D:true Opacity3D:1|c Visible:false Visible3D:true|d Visible:true Visible3D:false|"/>)");
  EXPECT_EQ(readSegmentVisibility(scene, findNode(scene, "s")),
            (std::map<std::string, bool>{{"A b", true}, {"c", false}, {"d", false}}));
}

// Transforms.

const std::string rotation = "0 -1 0 5  1 0 0 6  0 0 1 7  0 0 0 1";
const Affine rotationMap = makeAffine({0, -1, 0, 5, 1, 0, 0, 6, 0, 0, 1, 7});

TEST(MrmlScene, AppliesChainOfTransforms) {
  const SceneFolder folder;
  MrmlScene scene = folder.makeScene(
      R"(
    <LinearTransform id="outer" matrixTransformToParent=")" +
      rotation + R"("/>
    <LinearTransform id="inner" references="transform:outer;"
      matrixTransformToParent="2 0 0 10  0 1 0 0  0 0 1 0  0 0 0 1"/>)" +
      R"(<Volume id="v" references="storage:store1;transform:inner;"/>)" + volumeNode);
  const Affine expected = rotationMap * makeAffine({2, 0, 0, 10, 0, 1, 0, 0, 0, 0, 1, 0});
  expectSame(toWorld(scene, findNode(scene, "v")), expected);
  const Grid grid = readSceneVolume(scene, findNode(scene, "v")).grid;
  expectSame(grid.indexToWorld, expected * makeAffine({-1, 0, 0, -10, 0, -2, 0, -20, 0, 0, 3, 30}));
}

TEST(MrmlScene, ReadsMatrixTransformFromParent) {
  const SceneFolder folder;
  MrmlScene scene = folder.makeScene(R"(<N id="n" transformNodeRef="t"/>
    <LinearTransform id="t" matrixTransformFromParent=")" +
                                     rotation + "\"/>");
  expectSame(toWorld(scene, findNode(scene, "n")), rotationMap.inverse());
}

/// ITK text transform: a translation by (1, 2, 3) in LPS.
const std::string shiftFile = "#Insight Transform File V1.0\n#Transform 0\n"
                              "Transform: TranslationTransform_double_3_3\n"
                              "Parameters: 1 2 3.0000000001\nFixedParameters:\n";

Affine readShift(const std::string& tag, const std::string& attributes) {
  const SceneFolder folder;
  folder.write("shift.tfm", shiftFile);
  MrmlScene scene = folder.makeScene("<N id=\"n\" transformNodeRef=\"t\"/><" + tag +
                                     " id=\"t\" storageNodeRef=\"s\" " + attributes +
                                     "/><TransformStorage id=\"s\" fileName=\"shift.tfm\"/>");
  return toWorld(scene, findNode(scene, "n"));
}

TEST(MrmlScene, TransformFilePrecedesMatrixInScene) {
  const Vec3 toParent(1, 2, -3.0000000001); // the file maps from the parent, in LPS
  EXPECT_EQ(readShift("Transform", "").translation(), toParent);
  EXPECT_EQ(
      readShift("LinearTransform", R"(matrixTransformToParent="1 0 0 1 0 1 0 2 0 0 1 -3 0 0 0 1")")
          .translation(),
      toParent);
}

TEST(MrmlScene, AttributeOfOldScenesSetsDirectionOfTransformFile) {
  const Vec3 toParent(1, 2, -3.0000000001);
  EXPECT_EQ(readShift("Transform", R"(readWriteAsTransformToParent="false")").translation(),
            toParent);
  EXPECT_EQ(readShift("Transform", R"(readWriteAsTransformToParent="true")").translation(),
            -toParent);
  EXPECT_EQ(readShift("LinearTransform", R"(readWriteAsTransformToParent="true")").translation(),
            toParent); // Slicer writes the inverse
  EXPECT_EQ(readShift("LinearTransform", R"(readWriteAsTransformToParent="false")").translation(),
            -toParent);
}

TEST(MrmlScene, RefusesNonlinearAndCyclicTransforms) {
  const SceneFolder folder;
  const auto refuse = [&](const std::string& transforms, const std::string& reason) {
    const auto path = folder.writeScene("<N id=\"n\" transformNodeRef=\"t\"/>" + transforms);
    MrmlScene scene(path);
    expectRefused(path, reason, [&] { toWorld(scene, findNode(scene, "n")); });
  };
  refuse(R"(<BSplineTransform id="t" name="warp"/>)", "invalid-field: BSplineTransform warp (t)");
  refuse(R"(<GridTransform id="t"/>)", "invalid-field: GridTransform (t)");
  refuse(R"(<Transform id="t"/>)", "invalid-field: Transform (t)");
  refuse(R"(<LinearTransform id="t" transformNodeRef="u" matrixTransformToParent=")" + rotation +
             R"("/><LinearTransform id="u" transformNodeRef="t" matrixTransformToParent=")" +
             rotation + "\"/>",
         "invalid-field: (n)");
  refuse(R"(<LinearTransform id="t" matrixTransformToParent="1 0 0 0 0 1 0 0 0 0 0 0 0 0 0 1"/>)",
         "invalid-field: matrixTransformToParent");
  refuse(R"(<LinearTransform id="t" matrixTransformToParent="1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1"/>)",
         "invalid-field: matrixTransformToParent");
  refuse(R"(<LinearTransform id="t" matrixTransformToParent="1 0 0"/>)",
         "invalid-field: matrixTransformToParent");
}

// Crop boxes.

Affine readBox(const std::string& nodes, const std::map<std::string, std::string>& files = {}) {
  const SceneFolder folder;
  for (const auto& [name, content] : files)
    folder.write(name, content);
  MrmlScene scene = folder.makeScene(nodes);
  return readSceneRoi(scene, findNode(scene, "r")).boxToWorld;
}

const std::string roiNode = R"(<MarkupsROI id="r" storageNodeRef="s"/>
  <MarkupsROIJsonStorage id="s" fileName="my%20roi.mrk.json" coordinateSystem="LPS"/>)";

std::string makeRoiJson(const std::string& system, const std::string& more = "") {
  return R"({"markups": [{"type": "ROI", )" + system + R"("center": [10, 20, 30],
    "orientation": [0, -1, 0, 1, 0, 0, 0, 0, 1], "size": [2, 4, 6])" +
         more + "}]}";
}

TEST(MrmlScene, ReadsRegionInLpsAndRas) {
  // The columns of the orientation are the object's axes; LPS negates the first two rows.
  const Affine ras = makeAffine({0, -2, 0, 10, 1, 0, 0, 20, 0, 0, 3, 30});
  const Affine lps = makeAffine({0, 2, 0, -10, -1, 0, 0, -20, 0, 0, 3, 30});
  const auto read = [](const std::string& system) {
    return readBox(roiNode, {{"my roi.mrk.json", makeRoiJson(system)}});
  };
  expectSame(read(R"("coordinateSystem": "RAS", )"), ras);
  expectSame(read(R"("coordinateSystem": "LPS", )"), lps);
  expectSame(read(""), lps);
  expectSame(read(R"("coordinateSystem": 0, )"), ras);
  expectSame(read(R"("coordinateSystem": 1, )"), lps);
}

TEST(MrmlScene, AppliesTransformToRegion) {
  const Affine box = readBox(R"(<MarkupsROI id="r" references="storage:s;transform:t;"/>
      <MarkupsROIJsonStorage id="s" fileName="roi.mrk.json"/>
      <LinearTransform id="t" matrixTransformToParent=")" +
                                 rotation + "\"/>",
                             {{"roi.mrk.json", makeRoiJson(R"("coordinateSystem": "RAS", )")}});
  expectSame(box, rotationMap * makeAffine({0, -2, 0, 10, 1, 0, 0, 20, 0, 0, 3, 30}));
}

TEST(MrmlScene, ReadsAnnotationAndLegacyRegions) {
  const Affine expected = makeAffine({4, 0, 0, 1, 0, 5, 0, 2, 0, 0, 6, 3}); // radii, RAS
  expectSame(readBox(R"(<AnnotationROI id="r" storageNodeRef="s"/>
                      <AnnotationStorage id="s" fileName="roi.acsv"/>)",
                     {{"roi.acsv", "# comment\npoint|1|2|3|1|1\npoint|4|5|6|1|1\nline|0|1|1|1\n"}}),
             expected);
  expectSame(readBox(R"(<AnnotationROI id="r" ctrlPtsCoord="1 2 3|4 5 6"/>)"), expected);
  expectSame(readBox(R"(<ROI id="r" xyz="1 2 3" radiusXYZ="4 5 6"/>)"), expected);
  expectSame(readBox(R"(<ROI id="r" XYZ="1 2 3" RadiusXYZ="4 5 6"/>)"), expected);
}

TEST(MrmlScene, RefusesMalformedRegions) {
  const SceneFolder folder;
  const auto refuseJson = [&](const std::string& json, const std::string& reason) {
    const auto file = folder.write("my roi.mrk.json", json);
    MrmlScene scene = folder.makeScene(roiNode);
    expectRefused(file, reason, [&] { readSceneRoi(scene, findNode(scene, "r")); });
  };
  refuseJson(makeRoiJson("", R"(, "insideOut": true)"), "invalid-field: markups[0]");
  refuseJson(R"({"markups": [{"type": "Fiducial"}]})", "invalid-field: markups[0].type");
  refuseJson(R"({"markups": []})", "invalid-field: markups");
  refuseJson(R"({"markups": [{"type": "ROI", "center": [0, 0, 0], "size": [1, 0, 1]}]})",
             "invalid-field: markups[0]");
  refuseJson(R"({"markups": [{"type": "ROI", "center": [0, 0, 0]}]})",
             "invalid-field: markups[0] | size");
  refuseJson(makeRoiJson(R"("coordinateSystem": "XYZ", )"), "invalid-field: coordinateSystem");
  const auto path = folder.writeScene(R"(<AnnotationROI id="r" ctrlPtsCoord="1 2 3"/>)");
  MrmlScene scene(path);
  expectRefused(path, "invalid-field: AnnotationROI (r)",
                [&] { readSceneRoi(scene, findNode(scene, "r")); });
}

// Cameras and views.

CameraPose readPose(const std::string& attributes, const std::string& more = "") {
  const SceneFolder folder;
  MrmlScene scene = folder.makeScene(
      "<Camera id=\"c\" position=\"1 2 3\" focalPoint=\"1 102 3\" viewUp=\"0 0 1\" " + attributes +
      "/>" + more);
  return readSceneCamera(scene, findNode(scene, "c"));
}

TEST(MrmlScene, ReadsParallelAndPerspectiveCameras) {
  const CameraPose parallel =
      readPose(R"(parallelProjection="true" parallelScale="80" viewAngle="20")");
  EXPECT_EQ(parallel.projection, Projection::orthographic);
  EXPECT_EQ(parallel.scale, 80.0); // half the height, as in Fenestra
  EXPECT_EQ(parallel.position, Vec3(1, 2, 3));
  EXPECT_EQ(parallel.target, Vec3(1, 102, 3));
  EXPECT_EQ(parallel.up, Vec3(0, 0, 1));
  const CameraPose perspective = readPose(R"(parallelProjection="false" viewAngle="20")");
  EXPECT_EQ(perspective.projection, Projection::perspective);
  EXPECT_EQ(perspective.angle, 20.0);
  EXPECT_EQ(readPose("").angle, 30.0); // VTK's default
}

TEST(MrmlScene, AppliedTransformDoesNotMoveCameraAgain) {
  const std::string transform =
      "<LinearTransform id=\"t\" matrixTransformToParent=\"" + rotation + "\"/>";
  const CameraPose applied =
      readPose("transformNodeRef=\"t\" appliedTransform=\"" + rotation + "\"", transform);
  EXPECT_TRUE(isApprox(applied.position, Vec3(1, 2, 3)));
  const CameraPose unapplied = readPose("transformNodeRef=\"t\"", transform);
  EXPECT_TRUE(isApprox(unapplied.position, rotationMap * Vec3(1, 2, 3)));
  EXPECT_TRUE(isApprox(unapplied.up, Vec3(0, 0, 1)));
}

TEST(MrmlScene, RefusesDegenerateCameras) {
  const SceneFolder folder;
  const auto refuse = [&](const std::string& attributes, const std::string& reason) {
    const auto path = folder.writeScene("<Camera id=\"c\" " + attributes + "/>");
    MrmlScene scene(path);
    expectRefused(path, reason, [&] { readSceneCamera(scene, findNode(scene, "c")); });
  };
  refuse(R"(position="1 2 3" focalPoint="1 2 3" viewUp="0 0 1")",
         "invalid-scene-camera: Camera (c)");
  refuse(R"(position="1 2 3" focalPoint="1 2 9" viewUp="0 0 1")",
         "invalid-scene-camera: Camera (c)");
  refuse(R"(position="1 2 3" focalPoint="1 9 3")", "invalid-scene-camera: viewUp");
  refuse(R"(position="1 2 3" focalPoint="1 9 3" viewUp="0 0 1" viewAngle="0")",
         "invalid-scene-camera: viewAngle");
}

TEST(MrmlScene, ReadsBackgroundOfView) {
  const MrmlDocument document(
      R"(<MRML><View backgroundColor="0.1 0.2 0.3" backgroundColor2="0.4 0.5 0.6"/>
         <View backgroundColor="0.1 0.2 0.3"/><View/></MRML>)",
      "test");
  EXPECT_TRUE(isApprox(readViewBackground(document.nodes()[0]).top, Rgb(0.4, 0.5, 0.6)));
  EXPECT_TRUE(isApprox(readViewBackground(document.nodes()[0]).bottom, Rgb(0.1, 0.2, 0.3)));
  EXPECT_TRUE(isApprox(readViewBackground(document.nodes()[1]).top, Rgb(0.1, 0.2, 0.3)));
  EXPECT_TRUE(readViewBackground(document.nodes()[2]).bottom == Rgb::Zero());
}

// Real files.

const std::filesystem::path slicerScenes = std::filesystem::path(FENESTRA_DATA) / "slicer_scenes";

TEST(RealScenes, ReadsEveryPreset) {
  if (!std::filesystem::exists(slicerScenes))
    GTEST_SKIP() << slicerScenes << " is absent";
  std::size_t presets = 0;
  for (const char* file : {"slicer_core/presets.xml", "slicer_core/volRender.mrml",
                           "vr_properties/SM_presets.mrml", "vr_properties/US-VrPresets.mrml"}) {
    MrmlScene scene(slicerScenes / file);
    for (const MrmlNode* property : scene.document.findByTag("VolumeProperty")) {
      SCOPED_TRACE(describeNode(*property));
      const TransferFunction f = readSceneProperty(scene, *property);
      const auto& knots = f.extinction.knots();
      EXPECT_TRUE(std::any_of(knots.begin(), knots.end(),
                              [](const auto& knot) { return knot.value[0] > 0.0; }));
      ++presets;
    }
  }
  EXPECT_GE(presets, 40U);
}

TEST(RealScenes, ReadsAnnotationRegion) {
  const auto file = slicerScenes / "slicer_core/AnnotationROI.acsv";
  if (!std::filesystem::exists(file))
    GTEST_SKIP() << file << " is absent";
  expectSame(readBox("<AnnotationROI id=\"r\" storageNodeRef=\"s\"/><AnnotationStorage id=\"s\" "
                     "fileName=\"" +
                     file.string() + "\"/>"),
             makeAffine({56.6131, 0, 0, -26.5869, 0, 121.875, 0, 0, 0, 0, 121.875, 0}));
}

TEST(RealScenes, TransformFileMatchesMatrixToSixDigits) {
  const auto file = slicerScenes / "slicer_5_2_written/chest_transformed_cropped.mrb";
  if (!std::filesystem::exists(file))
    GTEST_SKIP() << file << " is absent";
  MrmlScene scene(file);
  const MrmlNode& volume = *scene.document.findByTag("Volume").at(0);
  const MrmlNode& transform = *scene.document.follow(volume, "transform");
  const auto n = *transform.numbers("matrixTransformToParent");
  const Affine sixDigits =
      makeAffine({n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8], n[9], n[10], n[11]});
  expectSame(toWorld(scene, volume), sixDigits, 1e-6);
  EXPECT_GT(frobeniusNorm(toWorld(scene, volume).linear() - sixDigits.linear()),
            1e-8); // more digits
  const Affine roi = readSceneRoi(scene, *scene.document.findByTag("MarkupsROI").at(0)).boxToWorld;
  expectSame(roi, makeAffine({150, 0, 0, 0, 0, 130, 0, -20, 0, 0, 110, -170}), 1e-9);
}

} // namespace
} // namespace fenestra::core::MrmlSceneTests
