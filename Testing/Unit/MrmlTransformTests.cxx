// Transforms of scenes: limits of matrices and of their products, and files that several nodes use.

#include "Approx.h"
#include "SceneTesting.h"

namespace fenestra::core::MrmlTransformTests {
namespace {

const MrmlNode& findNode(const MrmlScene& scene, const std::string& id) {
  return *scene.document.find(id);
}

/// Transform node of three rows of four numbers, below the node `parent`.
std::string makeTransform(const std::string& rows, const std::string& id = "t",
                          const std::string& parent = "") {
  return "<LinearTransform id=\"" + id + "\" transformNodeRef=\"" + parent +
         "\" matrixTransformToParent=\"" + rows + " 0 0 0 1\"/>";
}

/// Transform nodes t, t1, t2, ..., each below the next.
std::string makeChain(const std::string& rows, int count) {
  const auto name = [](int i) { return std::string("t").append(std::to_string(i)); };
  std::string nodes = makeTransform(rows, "t", "t1");
  for (int i = 1; i < count; ++i)
    nodes += makeTransform(rows, name(i), name(i + 1));
  return nodes;
}

/// With these transforms points lose voxel precision, or paths do not end.
TEST(MrmlTransform, RefusesNonInvertibleTransforms) {
  const SceneFolder folder;
  const auto refuse = [&](const std::string& transforms, const std::string& reason) {
    const auto path = folder.writeScene("<N id=\"n\" transformNodeRef=\"t\"/>" + transforms);
    MrmlScene scene(path);
    expectRefused(path, reason, [&] { toWorld(scene, findNode(scene, "n")); });
  };
  for (const char* rows : {"1e60 0 0 0  0 1e60 0 0  0 0 1e60 0", "1.1 1e308 0 0  0 1 0 0  0 0 1 0",
                           "1 0 0 1e300  0 1 0 0  0 0 1 0", "1e8 0 0 0  0 1e-10 0 0  0 0 1 0",
                           "1 1e15 0 0  0 1 0 0  0 0 1 0", "1e-60 0 0 0  0 1e-60 0 0  0 0 1e-60 0"})
    refuse(makeTransform(rows), "invalid-field: matrixTransformToParent");
  const std::string product = "invalid-field: (n) | product";
  refuse(makeChain("100 0 0 0  0 100 0 0  0 0 100 0", 5), product);
  refuse(makeChain("1e8 0 0 0  0 1e8 0 0  0 0 1e8 0", 900), product);
  refuse(makeChain("1 0 0 5e8  0 1 0 0  0 0 1 0", 3), product);
}

TEST(MrmlTransform, AcceptsSmallScale) {
  const SceneFolder folder;
  MrmlScene scene = folder.makeScene("<N id=\"n\" transformNodeRef=\"t\"/>" +
                                     makeTransform("1e-5 0 0 0  0 1e-5 0 0  0 0 1e-5 0"));
  EXPECT_EQ(toWorld(scene, findNode(scene, "n")).linear()(0, 0), 1e-5);
}

TEST(MrmlTransform, ListsAtMost1000ParentTransforms) {
  const SceneFolder folder;
  const std::string rows = "1 0 0 0  0 1 0 0  0 0 1 0",
                    child = "<N id=\"n\" transformNodeRef=\"t\"/>";
  const auto countAbove = [&](const std::string& transforms) {
    const MrmlScene scene = folder.makeScene(child + transforms);
    return listParentTransforms(scene.document, findNode(scene, "n")).size();
  };
  EXPECT_EQ(countAbove(makeChain(rows, 3)), 3u);
  EXPECT_EQ(countAbove(makeTransform(rows, "t", "u") + makeTransform(rows, "u", "t")),
            2u); // a loop
  EXPECT_EQ(countAbove(makeChain(rows, 2000)), 1000u);
}

/// A scene may refer to a slow file many times.
TEST(MrmlTransform, ReadsEachFileOnce) {
  const SceneFolder folder;
  const std::string nodes = R"(<N id="n" transformNodeRef="a"/>
      <LinearTransform id="a" storageNodeRef="s" transformNodeRef="b"/>
      <Transform id="b" storageNodeRef="s"/>
      <TransformStorage id="s" fileName="t.tfm"/>)";
  const std::string text = "#Insight Transform File V1.0\n#Transform 0\n"
                           "Transform: TranslationTransform_double_3_3\nParameters: ";
  folder.write("t.tfm", text + "1 2 3\nFixedParameters: \n");
  MrmlScene scene = folder.makeScene(nodes);
  const Affine read = toWorld(scene, findNode(scene, "n"));
  EXPECT_TRUE(isApprox(read.translation(), Vec3(2, 4, -6))); // applied twice; inverse, in LPS
  folder.write("t.tfm", "damaged");
  EXPECT_TRUE(isApprox(toWorld(scene, findNode(scene, "n")), read));

  MrmlScene damaged = folder.makeScene(nodes);
  const auto refuse = [&] {
    expectRefused(folder / "t.tfm", "damaged-file",
                  [&] { toWorld(damaged, findNode(damaged, "n")); });
  };
  refuse();
  folder.write("t.tfm", text + "1 2 3\nFixedParameters: \n");
  refuse();
}

TEST(MrmlTransform, RefusesPositionsBeyondInvertibleRange) {
  const SceneFolder folder;
  writeFile(folder / "v.nrrd", std::vector<std::uint8_t>(24, 1), {.spacing = {1e5, 1e5, 1e5}});
  const auto path = folder.writeScene(makeTransform("1e5 0 0 0  0 1e5 0 0  0 0 1e5 0") +
                                      R"(<Volume id="v" storageNodeRef="s" transformNodeRef="t"/>
      <LabelMapVolume id="l" storageNodeRef="s" transformNodeRef="t"/>
      <VolumeArchetypeStorage id="s" fileName="v.nrrd"/>
      <ROI id="r" xyz="1 2 3" radiusXYZ="1e5 1e5 1e5" transformNodeRef="t"/>
      <Camera id="c" position="0 0 0" focalPoint="0 1e9 0" viewUp="0 0 1" transformNodeRef="t"/>)");
  MrmlScene scene(path);
  expectRefused(path, "invalid-field | world transform",
                [&] { readSceneVolume(scene, findNode(scene, "v")); });
  expectRefused(path, "invalid-field | world transform",
                [&] { readSceneSegmentation(scene, findNode(scene, "l")); });
  expectRefused(path, "invalid-field | world transform",
                [&] { readSceneRoi(scene, findNode(scene, "r")); });
  expectRefused(path, "invalid-scene-camera: Camera (c)",
                [&] { readSceneCamera(scene, findNode(scene, "c")); });
}

} // namespace
} // namespace fenestra::core::MrmlTransformTests
