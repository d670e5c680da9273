// `fenestra inspect` of inputs that cannot be rendered: damaged, ambiguous and hostile ones.

#include "InspectTesting.h"

#include <sstream>

namespace fenestra::core::InspectErrorsTests {
namespace {

std::vector<std::string> splitLines(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> all;
  for (std::string line; std::getline(in, line);)
    all.push_back(line);
  return all;
}

TEST_F(InspectCommand, ReportsTheErrorOfARender) {
  struct Case {
    std::string name, nodes, line;
  };
  const std::string plainVolume = R"(
    <VolumeArchetypeStorage id="store1" name="s" fileName="volume.nrrd"/>
    <Volume id="vol1" name="CT" references="storage:store1;transform:t1;"/>)";
  for (const Case& c : std::vector<Case>{
           {"no volume", segmentationNode, "scene.mrml:"},
           {"technique",
            volumeNode + settingNodes +
                R"(<View id="view1" name="V" layoutName="1" active="true"
              raycastTechnique="MaximumIntensityProjection"/>)",
            "View V (view1): | maximum intensity"},
           {"missing file",
            R"(<VolumeArchetypeStorage id="s" fileName="gone.nrrd"/>
               <Volume id="vol1" name="CT" references="storage:s;"/>)",
            "gone.nrrd:"},
           {"warp", plainVolume + R"(<BSplineTransform id="t1" name="Warp"/>)",
            "BSplineTransform Warp (t1):"},
           {"camera", plainVolume + R"(<Camera id="c" name="Eye" position="1 2" focalPoint="0 0 0"
              viewUp="0 0 1"/>)",
            "position:"},
       }) {
    SCOPED_TRACE(c.name);
    const Json report = inspectScene(c.nodes);
    ASSERT_TRUE(report["refused"].is_string());
    expectStated(report["refused"], c.line);
    EXPECT_EQ(report["volumes"].size() + report["segmentations"].size(), 1u);
    expectSameAsRender(report, "scene.mrml");
  }
}

TEST_F(InspectCommand, NamesTheDamagedNode) {
  folder.write("cut.seg.nrrd", makeSegments().substr(0, makeSegments().size() - 9));
  const std::string cut = R"(<SegmentationStorage id="store3" fileName="cut.seg.nrrd"/>
    <Segmentation id="seg2" name="Cut" references="storage:store3;"/>
    <BSplineTransform id="t2" name="Warp"/>)";
  const Json report = inspectScene(volumeNode + cut + segmentationNode + settingNodes);
  EXPECT_TRUE(report["refused"].is_null());
  EXPECT_NE(report["segmentations"][0]["problem"].get<std::string>().find("cut.seg.nrrd: "),
            std::string::npos);
  EXPECT_TRUE(report["segmentations"][0]["size"].is_null());
  EXPECT_TRUE(report["segmentations"][1]["problem"].is_null());
  EXPECT_EQ(report["segmentations"][1]["segments"].size(), 2u);
  EXPECT_EQ(report["transforms"][0]["linear"], false);
  EXPECT_NE(
      report["transforms"][0]["problem"].get<std::string>().find("BSplineTransform Warp (t2): "),
      std::string::npos);

  const Json missing = inspectScene(
      R"(<VolumeArchetypeStorage id="s" fileName="gone%20away.nrrd"/>
         <Volume id="vol1" name="CT" references="storage:s;"/>)");
  EXPECT_EQ(missing["volumes"][0]["files"],
            Json::parse(R"([{"name": "gone away.nrrd", "there": false}])"));
  EXPECT_NE(text.find("gone away.nrrd (missing)"), std::string::npos) << text;
}

/// HDF5 file with a symbol table tree of five levels. All `children` entries of a node point to the
/// same node, so a naive traversal visits children^5 leaves.
std::string makeExponentialTree(std::size_t children) {
  using namespace std::string_literals;
  const auto number = [](std::uint64_t value, std::size_t size) { // little-endian
    return std::string(reinterpret_cast<const char*>(&value), size);
  };
  constexpr std::size_t root = 72, firstNode = 200;
  const std::size_t nodeSize = 32 + 16 * children;
  const std::size_t leaf = firstNode + 5 * nodeSize, heap = leaf + 8 + 4 * 40;
  std::string file = "\x89HDF\r\n\x1a\n"s + std::string(5, '\0') + "\x08\x08" +
                     std::string(49, '\0') + number(root, 8);
  file += "\1"s + std::string(7, '\0') + number(24, 4) + number(0, 4); // root group
  file += number(0x11, 2) + number(16, 2) + number(0, 4) + number(firstNode, 8) + number(heap, 8);
  for (std::size_t level = 0; level < 5; ++level) {
    const std::size_t begin = firstNode + level * nodeSize;
    file.resize(begin);
    file += "TREE\0"s + (level < 4 ? '\1' : '\0') + number(children, 2) + std::string(16, '\0');
    for (std::size_t i = 0; i < children; ++i) {
      file += number(0, 8);
      file += number(level < 4 ? begin + nodeSize : leaf, 8);
    }
  }
  file.resize(leaf);
  file += "SNOD\0\0"s + number(4, 2);
  for (int i = 0; i < 4; ++i)
    file += number(0, 8) + number(root, 8) + std::string(24, '\0');
  return file + "HEAP\0\0\0\0"s + number(16, 8) + number(0, 8) + number(heap + 32, 8) +
         number('a', 8) + number(0, 8);
}

TEST_F(InspectCommand, RejectsAnHdf5TreeOfExponentialSize) {
  writeScene(volumeNode + R"(<LinearTransformStorage id="ts" fileName="t.h5"/>
    <LinearTransform id="t1" references="storage:ts;"/>)");
  folder.write("t.h5", makeExponentialTree(40));
  const Outcome inspected = run({"inspect", "scene.mrml"}, folder.path());
  expectStated(inspected.out, "t.h5:");
  folder.write("t.h5", makeExponentialTree(2000));
  const Outcome rendered = run({"scene.mrml", "--size", "8x8"}, folder.path());
  EXPECT_EQ(rendered.status, 3);
  expectErrorLine(rendered.err, "t.h5:");
}

TEST_F(InspectCommand, PrintsUntrustedNamesOnOneLine) {
  const std::string evil = "&#27;[31mred&#10;" + std::string(300, 'x') + "\xc3\xa4";
  std::string models;
  for (int i = 0; i < 300; ++i)
    models += "<Model id=\"m" + std::to_string(i) + "\" name=\"Model\"/>";
  const Json report =
      inspectScene(volumeNode + settingNodes + "<VolumeProperty id=\"p2\" name=\"" + evil +
                   "\"/><Camera id=\"c2\" layoutName=\"" + evil + "\"/>" + models);
  EXPECT_EQ(report["volumeProperties"][1]["name"],
            "\033[31mred\n" + std::string(300, 'x') + "\xc3\xa4");
  for (const std::string& line : splitLines(text)) {
    EXPECT_LE(line.size(), 100u) << line;
    EXPECT_EQ(std::count_if(line.begin(), line.end(), [](char c) { return c >= 0 && c < ' '; }), 0);
    EXPECT_FALSE(line.ends_with(' ')) << line;
  }
  EXPECT_LT(splitLines(text).size(), 60u) << "300 models are summarized in one line";
  EXPECT_NE(text.find("Model (300)"), std::string::npos) << text;
  EXPECT_EQ(report["others"]["Model"], 300);
}

TEST_F(InspectCommand, RejectsInputThatIsNotAVolumeOrScene) {
  folder.write("text.nrrd", "These are\nonly words.\n");
  folder.write("text.mrml", "<html/>");
  folder.write("text.mrb", "words");
  const auto inspectArguments = [](const std::string& file) { return Arguments{"inspect", file}; };
  expectErrors(
      {
          {"nothing", {"inspect"}, 2, "INPUT:"},
          {"missing", inspectArguments("missing.nrrd"), 3, "missing.nrrd:"},
          {"missing scene", inspectArguments("missing.mrml"), 3, "missing.mrml:"},
          {"words", inspectArguments("text.nrrd"), 3, "text.nrrd:"},
          {"web page", inspectArguments("text.mrml"), 3, "text.mrml:"},
          {"not an archive", inspectArguments("text.mrb"), 3, "text.mrb: "},
          {"no images", inspectArguments("."), 3, ".: "},
          {"switch with a value", {"inspect", "volume.nrrd", "--json=1"}, 2, "--json:"},
          {"volume of one", {"inspect", "volume.nrrd", "--volume", "CT"}, 2, "--volume:"},
          {"other option", {"inspect", "volume.nrrd", "--seed", "1"}, 2, "--seed:"},
          {"misspelled", {"inspct", "volume.nrrd"}, 2, "'inspct': | fenestra inspect?"},
      },
      folder.path());
}

} // namespace
} // namespace fenestra::core::InspectErrorsTests
