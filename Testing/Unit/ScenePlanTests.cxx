// Selects the nodes of a scene to render; lists refused and ignored nodes, with reasons.

#include "files/slicer/ScenePlan.h"

#include "Refusals.h"

namespace fenestra::core::ScenePlanTests {
namespace {

MrmlDocument parse(const std::string& nodes) {
  return {"<MRML>" + nodes + "</MRML>", "test"};
}

std::string findVolume(const std::string& nodes, const std::optional<std::string>& choice = {}) {
  const MrmlDocument document = parse(nodes);
  return planRender(document, {.volume = choice}).volume->id;
}

void refuse(const std::string& nodes, const std::string& reason,
            const SceneSelection& choice = {}) {
  const MrmlDocument document = parse(nodes);
  expectRefused("test", reason, [&] { planRender(document, choice); });
}

const std::string threeVolumes = R"(
  <Volume id="v1" name="one" references="display:d1;"/>
  <Volume id="v2" name="two" references="display:s2 d2;"/>
  <Volume id="v3" name="three"/><VolumeDisplay id="s2"/>)";

TEST(ScenePlan, ChoosesTheVolumeRenderedInSlicer) {
  EXPECT_EQ(findVolume(threeVolumes + R"(<GPURayCastVolumeRendering id="d1" visibility="false"/>
                                       <GPURayCastVolumeRendering id="d2" visibility="true"/>)"),
            "v2");
  EXPECT_EQ(findVolume(threeVolumes + R"(<CPURayCastVolumeRendering id="d2" visibility="false"/>)"),
            "v2"); // the only volume with rendering settings
  EXPECT_EQ(findVolume(threeVolumes + R"(<Selection references="ActiveVolume:v3;"/>)"), "v3");
  EXPECT_EQ(findVolume(threeVolumes + R"(<Selection activeVolumeID="v1"/>)"), "v1");
  EXPECT_EQ(findVolume(R"(<Volume id="v"/><LabelMapVolume id="l"/><Volume id="m" labelMap="1"/>
                        <VectorVolume id="x"/>)"),
            "v");
}

TEST(ScenePlan, ChoosesTheVolumeNamedByTheUser) {
  const std::string rendered = threeVolumes + R"(<GPURayCastVolumeRendering id="d1"/>)";
  EXPECT_EQ(findVolume(rendered, "v3"), "v3");
  EXPECT_EQ(findVolume(rendered, "three"), "v3");
  EXPECT_EQ(findVolume(R"(<Volume id="a" name="b"/><Volume id="b" name="a"/>)", "a"),
            "a"); // ids take precedence
  refuse(rendered, "unknown-name | \"four\" | one (v1), two (v2), three (v3)", {.volume = "four"});
  refuse(R"(<Volume id="a" name="x"/><Volume id="b" name="x"/>)", "ambiguous-name | x (a), x (b)",
         {.volume = "x"});
}

TEST(ScenePlan, RefusesAmbiguousVolumes) {
  refuse(threeVolumes, "ambiguous-volume | one (v1), two (v2), three (v3)");
  refuse(threeVolumes +
             R"(<GPURayCastVolumeRendering id="d1"/><GPURayCastVolumeRendering id="d2"/>)",
         "ambiguous-volume | one (v1), two (v2))");
  refuse("<Model/>", "invalid-file");
}

TEST(ScenePlan, FindsVolumePropertyAndRoiOfTheRendering) {
  const MrmlDocument document = parse(R"(
    <Volume id="v" displayNodeRef="s d"/><VolumeDisplay id="s"/>
    <GPURayCastVolumeRendering id="d" croppingEnabled="1"
       references="volumeProperty:p;roi:r;"/>
    <VolumeProperty id="p0"/><VolumeProperty id="p"/><MarkupsROI id="r"/>)");
  const ScenePlan plan = planRender(document, {});
  EXPECT_EQ(plan.rendering->id, "d");
  EXPECT_EQ(plan.property->id, "p");
  EXPECT_EQ(plan.roi->id, "r");
  EXPECT_FALSE(plan.sliceDisplay);
  EXPECT_TRUE(plan.warnings.empty());
}

TEST(ScenePlan, CropsOnlyIfCroppingIsOn) {
  const MrmlDocument document = parse(R"(
    <Volume id="v" displayNodeRef="d"/>
    <GPURayCastVolumeRendering id="d" croppingEnabled="0" ROINodeID="r"/><MarkupsROI id="r"/>)");
  const ScenePlan plan = planRender(document, {});
  EXPECT_FALSE(plan.roi);
  EXPECT_EQ(plan.ignored, std::vector<std::string>{"MarkupsROI (r): cropping is off"});
  const MrmlDocument withoutRoi = parse(R"(<Volume id="v" displayNodeRef="d"/>
    <GPURayCastVolumeRendering id="d" croppingEnabled="1"/>)");
  ASSERT_EQ(planRender(withoutRoi, {}).warnings.size(), 1U);
}

TEST(ScenePlan, UsesTheVolumeDisplayIfTheRenderingFollowsIt) {
  const std::string nodes = R"(<Volume id="v" displayNodeRef="d s"/><VolumeDisplay id="s"/>
    <GPURayCastVolumeRendering id="d" followVolumeDisplayNode=")";
  const MrmlDocument following = parse(nodes + "1\"/>");
  const MrmlDocument own = parse(nodes + "0\"/>");
  EXPECT_EQ(planRender(following, {}).sliceDisplay->id, "s");
  EXPECT_FALSE(planRender(own, {}).sliceDisplay);
}

TEST(ScenePlan, WarnsAboutAnActiveClipNode) {
  const std::string nodes = R"(<Volume id="v" displayNodeRef="d"/><Model id="m" name="knife"/>
    <GPURayCastVolumeRendering id="d" references="ClipNode:m;" clipping=")";
  const MrmlDocument on = parse(nodes + "true\"/>");
  ASSERT_EQ(planRender(on, {}).warnings.size(), 1U);
  expectMessage(planRender(on, {}).warnings[0], "ignored-scene-setting: Model knife (m)");
  const MrmlDocument off = parse(nodes + "false\"/>");
  EXPECT_TRUE(planRender(off, {}).warnings.empty());
}

TEST(ScenePlan, RefusesIntensityProjections) {
  const std::string volume = R"(<Volume id="v" displayNodeRef="d"/>)";
  const std::string rendering = R"(<GPURayCastVolumeRendering id="d")";
  const auto makeScene = [&](const std::string& technique) {
    return volume + rendering + "/><View id=\"w\" raycastTechnique=\"" + technique + "\"/>";
  };
  refuse(makeScene("MaximumIntensityProjection"), "unsupported-file | maximum intensity");
  refuse(makeScene("MinimumIntensityProjection"), "unsupported-file | minimum intensity");
  refuse(volume + rendering + " raycastTechnique=\"2\"/>", "unsupported-file | maximum intensity");
  const MrmlDocument composite = parse(makeScene("Composite"));
  EXPECT_EQ(planRender(composite, {}).view->id, "w");
}

std::string findCamera(const std::string& nodes) {
  const MrmlDocument document = parse("<Volume id=\"v\" displayNodeRef=\"d\"/>" + nodes);
  const ScenePlan plan = planRender(document, {});
  return (plan.view ? plan.view->id : "none") + " " + (plan.camera ? plan.camera->id : "none");
}

TEST(ScenePlan, PairsTheCameraWithItsView) {
  const std::string cameras =
      R"(<Camera id="c2" singletonTag="2"/><Camera id="c1" singletonTag="1"/>)";
  EXPECT_EQ(findCamera(cameras + R"(<View id="w1" layoutName="1"/>)"), "w1 c1");
  EXPECT_EQ(findCamera(cameras + R"(<View id="w1" singletonTag="1"/>)"), "w1 c1");
  EXPECT_EQ(findCamera(R"(<Camera id="c2" activetag="w2"/><Camera id="c1" activetag="w1"/>
                        <View id="w1"/>)"),
            "w1 c1");
  EXPECT_EQ(findCamera(R"(<Camera id="c" singletonTag="x"/><View id="w" layoutName="1"/>)"), "w c");
  EXPECT_EQ(findCamera(cameras + R"(<View id="w" layoutName="3"/>)"), "w none");
  EXPECT_EQ(findCamera(R"(<Camera id="c"/>)"), "none c");
}

TEST(ScenePlan, ChoosesTheViewThatShowsTheRendering) {
  const std::string views = R"(<View id="w1" layoutName="1"/><View id="w2" layoutName="2")";
  EXPECT_EQ(findCamera(views + "/>"), "w1 none");
  EXPECT_EQ(findCamera(views + R"( active="true"/>)"), "w2 none");
  EXPECT_EQ(findCamera(views + R"( attributes="MappedInLayout:1"/>)"), "w2 none");
  EXPECT_EQ(findCamera(views + R"(/><GPURayCastVolumeRendering id="d" viewNodeRef="w2"/>)"),
            "w2 none");
}

std::string findSegmentation(const std::string& nodes, SceneSelection choice) {
  const MrmlDocument document = parse("<Volume id=\"v\"/>" + nodes);
  const ScenePlan plan = planRender(document, choice);
  return plan.segmentation ? plan.segmentation->id : "none";
}

TEST(ScenePlan, ChoosesTheVisibleOrNamedSegmentation) {
  const SceneSelection any{.needsSegmentation = true};
  EXPECT_EQ(findSegmentation(R"(<LabelMapVolume id="l"/><Segmentation id="s"/>)", any), "s");
  EXPECT_EQ(findSegmentation(R"(<LabelMapVolume id="l"/>)", any), "l");
  EXPECT_EQ(findSegmentation(R"(<Volume id="m" labelMap="1"/>)", any), "m");
  EXPECT_EQ(findSegmentation(R"(<Segmentation id="s" displayNodeRef="d"/><Segmentation id="t"/>
                              <SegmentationDisplay id="d" visibility="false"/>)",
                             any),
            "t");
  EXPECT_EQ(findSegmentation(R"(<Segmentation id="s"/><LabelMapVolume id="l" name="brain"/>)",
                             {.segmentation = "brain", .needsSegmentation = true}),
            "l");
  EXPECT_EQ(findSegmentation("", {.segmentation = "file.nrrd", .needsSegmentation = true}), "none");
  refuse("<Volume id=\"v\"/><Segmentation id=\"s\"/><Segmentation id=\"t\"/>",
         "ambiguous-segmentation | (s), (t)", any);
  refuse("<Volume id=\"v\"/>", "segmentation-required", any);
}

TEST(ScenePlan, ListsIgnoredNodes) {
  const MrmlDocument document = parse(R"(<Volume id="v" name="CT" displayNodeRef="d"/>
    <GPURayCastVolumeRendering id="d"/><Volume id="o" name="other"/><Model id="m1"/><Model id="m2"/>
    <Model id="m3"/><Model id="m4"/><Slice id="x"/>)");
  EXPECT_EQ(planRender(document, {}).ignored,
            (std::vector<std::string>{"Volume other (o): another volume is rendered",
                                      "4 nodes Model: surfaces and markups are not rendered"}));
}

} // namespace
} // namespace fenestra::core::ScenePlanTests
