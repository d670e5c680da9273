// MRML as XML: nodes, attributes, references of old and new scenes, and files that are not scenes.

#include "SceneTesting.h"

namespace fenestra::core::MrmlDocumentTests {
namespace {

MrmlDocument parse(const std::string& nodes) {
  return {"<MRML>" + nodes + "</MRML>", "test"};
}

void refuse(const std::string& text, const std::string& reason) {
  expectRefused("test", reason, [&] { MrmlDocument(text, "test"); });
}

TEST(MrmlDocument, ReadsNodesInOrder) {
  const MrmlDocument document = parse(R"(<Volume id="v" name="a &amp; b"></Volume>
    <!-- <Volume id="commented"/> --> <View id="w"/><Volume id="x"/>)");
  ASSERT_EQ(document.nodes().size(), 3U);
  EXPECT_EQ(document.nodes()[0].name, "a & b");
  ASSERT_EQ(document.findByTag("Volume").size(), 2U);
  EXPECT_EQ(document.findByTag("Volume")[1]->id, "x");
  EXPECT_EQ(document.find("w")->tag, "View");
  EXPECT_FALSE(document.find("nothing"));
  EXPECT_FALSE(document.find(""));
}

TEST(MrmlDocument, OmitsCopiesInSceneViews) {
  const MrmlDocument document = parse(R"(
    <SceneView id="sv"><Volume id="v" name="copy"/></SceneView><Volume id="v" name="own"/>
    <SubjectHierarchy id="sh"><SubjectHierarchyItem id="3"/></SubjectHierarchy>)");
  ASSERT_EQ(document.findByTag("Volume").size(), 1U);
  EXPECT_EQ(document.find("v")->name, "own");
  EXPECT_FALSE(document.find("3"));
}

TEST(MrmlDocument, ReadsReferencesOfNewScenes) {
  const MrmlDocument document = parse(
      R"(<Volume id="v" references="display:d1 d2;storage:s {size=3,kind=a%20b};unit/length:u;"/>
         <D id="d1"/><S id="s"/>)");
  const MrmlNode& volume = document.nodes()[0];
  EXPECT_EQ(volume.references.at("display"), (std::vector<std::string>{"d1", "d2"}));
  EXPECT_EQ(volume.references.at("storage"), std::vector<std::string>{"s"});
  EXPECT_EQ(volume.referenceId("unit/length"), "u");
  EXPECT_EQ(document.follow(volume, "display")->tag, "D");
  EXPECT_FALSE(document.follow(volume, "transform"));
  EXPECT_FALSE(document.follow(volume, "unit/length")); // names no node of the scene
}

TEST(MrmlDocument, ReadsReferencesOfOldScenes) {
  const MrmlDocument document = parse(
      R"(<Volume displayNodeRef="d1 d2" storageNodeRef="s" transformNodeRef="t"/>
         <GPURayCastVolumeRendering volumePropertyNodeID="p" ROINodeID="r" viewNodeRef="w"/>
         <Selection activeVolumeID="v"/><VolumeDisplay colorNodeID="c"/>)");
  const MrmlNode& volume = document.nodes()[0];
  EXPECT_EQ(volume.references.at("display"), (std::vector<std::string>{"d1", "d2"}));
  EXPECT_EQ(volume.referenceId("storage"), "s");
  EXPECT_EQ(volume.referenceId("transform"), "t");
  const MrmlNode& rendering = document.nodes()[1];
  EXPECT_EQ(rendering.referenceId("volumeProperty"), "p");
  EXPECT_EQ(rendering.referenceId("roi"), "r");
  EXPECT_EQ(rendering.referenceId("view"), "w");
  EXPECT_EQ(document.nodes()[2].referenceId("ActiveVolume"), "v");
  EXPECT_EQ(document.nodes()[3].referenceId("color"), "c");
}

TEST(MrmlDocument, PrefersNewFormOfReferences) {
  const MrmlDocument document =
      parse(R"(<Volume displayNodeRef="old" storageNodeRef="s" references="display:new;"/>)");
  EXPECT_EQ(document.nodes()[0].references.at("display"), std::vector<std::string>{"new"});
  EXPECT_EQ(document.nodes()[0].referenceId("storage"), "s");
}

TEST(MrmlDocument, SkipsMalformedReferences) {
  const MrmlDocument document =
      parse(R"(<Volume references=";;:x;role;a:;b: ;c:1"/><Volume references=""/>)");
  EXPECT_EQ(document.nodes()[0].references.size(), 1U);
  EXPECT_EQ(document.nodes()[0].referenceId("c"), "1");
}

TEST(MrmlDocument, ConvertsAttributesToBooleansAndNumbers) {
  const MrmlDocument document =
      parse(R"(<N a="true" b="false" c="1" d="0" e="yes" n=" 1  -2e3 2.2250738585072e-308 "
                  m="1 2x" i="1 inf" o=""/>)");
  const MrmlNode& node = document.nodes()[0];
  EXPECT_TRUE(node.boolean("a", false));
  EXPECT_FALSE(node.boolean("b", true));
  EXPECT_TRUE(node.boolean("c", false));
  EXPECT_FALSE(node.boolean("d", true));
  EXPECT_TRUE(node.boolean("e", true));
  EXPECT_FALSE(node.boolean("missing", false));
  EXPECT_EQ(*node.numbers("n"), (std::vector<double>{1, -2000, 2.2250738585072e-308}));
  EXPECT_FALSE(node.numbers("m"));
  EXPECT_FALSE(node.numbers("i"));
  EXPECT_TRUE(node.numbers("o")->empty());
  EXPECT_FALSE(node.numbers("missing"));
}

TEST(MrmlDocument, RefusesTextThatIsNotScene) {
  refuse("", "damaged-file");
  refuse("words", "damaged-file");
  refuse("<MRML><Volume></MRML>", "damaged-file");
  refuse("<MRML><Volume id=\"v\"", "damaged-file");
  refuse("<VTKFile/>", "unsupported-file");
}

TEST(MrmlDocument, RefusesEntities) {
  refuse("<!DOCTYPE MRML [<!ENTITY a \"b\"><!ENTITY c \"&a;&a;\">]><MRML>&c;</MRML>",
         "invalid-file");
}

TEST(MrmlDocument, RefusesTooManyNodesOrAttributes) {
  std::string nodes = "<MRML>";
  for (int i = 0; i < 100'001; ++i)
    nodes += "<N/>";
  refuse(nodes + "</MRML>", "limit-exceeded");
  std::string node = "<N";
  for (int i = 0; i < 1001; ++i)
    node += " a" + std::to_string(i) + "=''";
  std::string attributes = "<MRML>";
  for (int i = 0; i < 1000; ++i)
    attributes += node + "/>";
  refuse(attributes + "</MRML>", "limit-exceeded");
}

TEST(MrmlDocument, DeepNestingIsReadOrRefused) {
  std::string deep = "<MRML>";
  for (int i = 0; i < 200'000; ++i)
    deep += "<a>";
  refuse(deep, "damaged-file");
  for (int i = 0; i < 200'000; ++i)
    deep += "</a>";
  EXPECT_EQ(MrmlDocument(deep + "</MRML>", "test").nodes().size(), 1U);
}

} // namespace
} // namespace fenestra::core::MrmlDocumentTests
