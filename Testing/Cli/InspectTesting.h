#pragma once
// Small scenes for `fenestra inspect`, and helpers that parse its output.

#include "CommandTesting.h"

#include <nlohmann/json.hpp>

namespace fenestra::core {

using Json = nlohmann::json;

inline const std::string volumeNode = R"(
<VolumeArchetypeStorage id="store1" name="s" fileName="volume.nrrd"/>
<Volume id="vol1" name="CT" references="storage:store1;display:vr1;transform:t1;"/>)";

inline const std::string segmentationNode = R"(
<SegmentationStorage id="store2" name="s" fileName="segments.seg.nrrd"/>
<SegmentationDisplay id="show2" SegmentationDisplayProperties="A Visible:true|B Visible3D:false|"/>
<Segmentation id="seg1" name="Parts" references="storage:store2;display:show2;"/>)";

inline const std::string settingNodes = R"(
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

  /// JSON of an inspection that must succeed. Stores the plain output in `text`.
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

  Json inspectScene(const std::string& nodes, const Arguments& options = {}) const {
    writeScene(nodes);
    Arguments arguments = {"scene.mrml"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return inspect(arguments);
  }

  /// Expects that a render fails with the error that the inspection predicts, or succeeds if it
  /// predicts none.
  void expectSameAsRender(const Json& report, const std::string& input) const {
    const Outcome rendered =
        run({input, "--size", "4x4", "--samples", "1", "--output", "a.png"}, folder.path());
    if (report["refused"].is_null())
      EXPECT_EQ(rendered.status, 0) << rendered.err;
    else
      EXPECT_EQ(rendered.err, "fenestra: error: " + report["refused"].get<std::string>() + "\n");
  }

  mutable std::string text; ///< plain output of the last inspection
};

} // namespace fenestra::core
