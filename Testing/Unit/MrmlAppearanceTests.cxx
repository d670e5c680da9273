// Appearance in scenes: volume properties, and slice displays that a rendering follows.

#include "SceneTesting.h"

namespace fenestra::core::MrmlAppearanceTests {
namespace {

const MrmlNode& findNode(const MrmlScene& scene, const std::string& id) {
  return *scene.document.find(id);
}

const std::string inlineProperty = R"(shade="1" diffuse="0.9" ambient="0.1" specular="0.2"
  specularPower="10" scalarOpacity="4 0 0 100 0.5" gradientOpacity="4 0 1 255 1"
  colorTransfer="8 0 0 0 0 100 1 1 1" effectiveRange="0 -1")";

double readExtinction(const std::string& nodes,
                      const std::map<std::string, std::string>& files = {}) {
  const SceneFolder folder;
  for (const auto& [name, content] : files)
    folder.write(name, content);
  MrmlScene scene = folder.makeScene(nodes);
  return readSceneProperty(scene, findNode(scene, "p")).extinction(100)[0];
}

TEST(MrmlAppearance, PropertyFilePrecedesScene) {
  const std::string text =
      "1\n1\n0.9\n0.1\n0.2\n10\n4 0 0 100 0.75\n4 0 1 255 1\n8 0 0 0 0 100 1 1 1\n";
  const std::string json = R"({"volumeProperties": [{"components": [{
      "rgbTransferFunction": {"points": [{"x": 0, "color": [1, 1, 1]}]},
      "scalarOpacity": {"points": [{"x": 100, "y": 0.875}]}}]}]})";
  const std::string stored = R"(<VolumePropertyStorage id="s" fileName="p.vp"/>)";
  const std::string storedJson = R"(<VolumePropertyJsonStorage id="s" fileName="p.vp.json"/>)";
  const auto property = [](const std::string& attributes) {
    return "<VolumeProperty id=\"p\" " + attributes + "/>";
  };
  EXPECT_NEAR(readExtinction(property(inlineProperty)), std::log(2.0), 1e-4);
  EXPECT_NEAR(
      readExtinction(property("storageNodeRef=\"s\" " + inlineProperty) + stored, {{"p.vp", text}}),
      std::log(4.0), 2e-4);
  EXPECT_NEAR(readExtinction(property("storageNodeRef=\"s\"") + storedJson, {{"p.vp.json", json}}),
              std::log(8.0), 3e-4);
}

TEST(MrmlAppearance, RefusesPropertyWithoutPoints) {
  const SceneFolder folder;
  const auto path = folder.writeScene(R"(<VolumeProperty id="p" name="mine"/>
      <VolumeProperty id="q" scalarOpacity="3 0 0 1" colorTransfer="4 0 1 1 1"/>)");
  MrmlScene scene(path);
  expectRefused(path, "missing-transfer-points: VolumeProperty mine (p)",
                [&] { readSceneProperty(scene, findNode(scene, "p")); });
  expectRefused(path, "invalid-field: VolumeProperty (q): scalarOpacity",
                [&] { readSceneProperty(scene, findNode(scene, "q")); });
}

TEST(MrmlAppearance, DisplayWindowBecomesOpacityRamp) {
  const MrmlDocument document(R"(<MRML><GPURayCastVolumeRendering/>
    <GPURayCastVolumeRendering ignoreVolumeDisplayNodeThreshold="1"/>
    <VolumeDisplay window="100" level="150" lowerThreshold="-32768" upperThreshold="32767"/>
    <VolumeDisplay window="100" level="150" colorNodeID="vtkMRMLColorTableNodeRainbow"/>
    <VolumeDisplay window="100" level="150" invertDisplayScalarRange="true"
      lowerThreshold="50" upperThreshold="250" colorNodeID="vtkMRMLColorTableNodeGrey"/></MRML>)",
                              "test");
  const auto& nodes = document.nodes();
  const auto opacity = [](const TransferFunction& f, double s) {
    return 1.0 - std::exp(-f.extinction(s)[0]);
  };
  const auto full = convertSliceDisplay(nodes[0], nodes[2], {0, 400});
  ASSERT_TRUE(full); // a ramp over the full range
  EXPECT_NEAR(opacity(*full, 100), 0.25, 1e-3);
  EXPECT_NEAR(opacity(*full, 300), 0.75, 1e-3);
  EXPECT_NEAR(full->albedo(100)[0], 0.0, 1e-6); // black to white over the window
  EXPECT_NEAR(full->albedo(200)[0], 1.0, 1e-6);
  EXPECT_TRUE(full->shading);

  const auto window = convertSliceDisplay(nodes[1], nodes[2], {0, 400});
  EXPECT_NEAR(opacity(*window, 150), 0.5, 1e-3); // a ramp over the window, opaque beyond
  EXPECT_NEAR(opacity(*window, 99), 0.0, 1e-9);
  EXPECT_GT(opacity(*window, 300), 0.99);

  const auto threshold = convertSliceDisplay(nodes[0], nodes[4], {0, 400});
  EXPECT_NEAR(opacity(*threshold, 150), 0.5, 1e-3); // a ramp over the threshold, empty beyond
  EXPECT_NEAR(opacity(*threshold, 300), 0.0, 1e-9);
  EXPECT_NEAR(threshold->albedo(100)[0], 1.0, 1e-6);

  EXPECT_FALSE(convertSliceDisplay(nodes[0], nodes[3], {0, 400})); // unsupported color table
}

} // namespace
} // namespace fenestra::core::MrmlAppearanceTests
