// Tables that name the values of label maps.

#include "TemporaryFolder.h"

#include "ErrorChecks.h"
#include "files/segments/LabelNames.h"

#include <gtest/gtest.h>

using namespace fenestra::core;

namespace {

LabelNames read(const std::string& name, const std::string& text) {
  const TemporaryFolder folder;
  return readLabelNames(folder.write(name, text));
}

void expectRefusal(const std::string& name, const std::string& text, const std::string& expected) {
  SCOPED_TRACE(name);
  catchError(ErrorKind::input, expected, [&] { read(name, text); });
}

TEST(LabelNames, EveryFormatGivesTheSameNames) {
  const std::pair<const char*, const char*> tables[] = {
      {"a.ctbl", "# Color table file\n\n0 Background 0 0 0 0\n5 liver 221 130 101 255\r\n"
                 "51 spleen 157 108 162 255\n"},
      {"a.txt", "#No. Label\n 5   liver   221 130 101 0\n\n 51  spleen  157 108 162 0\n"},
      {"a.label", "    0     0    0    0        0  0  0    \"Clear Label\"\n"
                  "    5   221  130  101        1  1  1    \"liver\"\n"
                  "   51   157  108  162        1  1  1    \"spleen\"\n"},
      {"a.json", R"({"5": "liver", "51": "spleen", "0": "background"})"},
      {"b.json",
       R"([{"label": 5, "name": "liver", "voxels": 3}, {"label": 51, "name": "spleen"}])"},
      {"snap.txt", "# ITK-SnAP Label Description File\n"
                   "    0     0    0    0        0  0  0    \"Clear Label\"\n"
                   "    5   221  130  101        1  1  1    \"liver\"\n"
                   "   51   157  108  162        1  1  1    \"spleen\"\n"},
      {"a.tsv", "index\tname\tabbreviation\tcolor\r\n5\tliver\tL\t#dd8265\r\n"
                "51\tspleen\tS\t#9d6ca2\r\n"},
      {"nnunet.json", R"({"channel_names": {"0": "CT"}, "labels": {"background": 0, "liver": 5,
          "spleen": 51, "both": [5, 51]}, "numTraining": 1})"},
      {"msd.json", R"({"name": "Liver", "modality": {"0": "CT"},
          "labels": {"0": "background", "5": "liver", "51": "spleen"}})"},
      {"colors.csv", "LabelValue,Name,Color_R,Color_G,Color_B,Color_A\n5,liver,221,130,101,255\n"
                     "51,spleen,157,108,162,255\n"},
      {"a.csv", "5,liver\n51,spleen\n"},
      {"b.csv", "name;voxels;label\r\n\"liver\";7;5\r\n\"spleen\";8;51\r\n"}};
  for (const auto& [name, text] : tables) {
    const LabelNames names = read(name, text);
    EXPECT_EQ(names.size(), 2u) << name;
    EXPECT_EQ(names.at(5).name, "liver") << name;
    EXPECT_EQ(names.at(51).name, "spleen") << name;
    const std::string content = text;
    if (content.find("221") != content.npos || content.find("#dd8265") != content.npos) {
      ASSERT_TRUE(names.at(5).color) << name;
      EXPECT_NEAR(names.at(5).color->x(), 221.0 / 255.0, 1e-12) << name;
    }
  }
}

TEST(LabelNames, NamesCanContainBlanksWhereTheFormatAllowsIt) {
  EXPECT_EQ(read("a.label", "7 0 0 0 1 1 1 \"Left \"great\" toe\"").at(7).name,
            "Left \"great\" toe");
  EXPECT_EQ(read("a.json", R"({"-7": "left foot"})").at(-7).name, "left foot");
}

TEST(LabelNames, ErrorsGiveTheLine) {
  expectRefusal("a.ctbl", "x liver 1 2 3 4", "invalid-field: a.ctbl: line 1");
  expectRefusal("a.ctbl", "1 a 0 0 0 0\n1 b 0 0 0 0", "invalid-field: a.ctbl: line 2 | 1 | \"a\"");
  expectRefusal("a.label", "3 0 0 0 1 1 1 liver", "invalid-field: a.label: line 1");
  expectRefusal("a.csv", "organ,size\n1,2\n",
                "invalid-field: a.csv: line 1 | \"label\" | \"name\"");
  expectRefusal("a.json", R"({"99999999999": "x"})", "invalid-field: a.json: \"99999999999\"");
  expectRefusal("a.json", "{}", "invalid-file: a.json");
  expectRefusal("a.json", R"({"1": 2})", "invalid-field: a.json: 1");
  expectRefusal("a.json", R"({"labels": {"1": 2}})", "invalid-field: a.json: labels.1");
  expectRefusal("a.tsv", "1\tliver\n1\tspleen\n", "invalid-field: a.tsv: line 2");
  expectRefusal("a.xlsx", "", "unsupported-file: a.xlsx");
}

TEST(LabelNames, BuiltInTablesHaveTheirClasses) {
  EXPECT_EQ(findBuiltInLabelNames("totalsegmentator1")->size(), 104u);
  EXPECT_EQ(findBuiltInLabelNames("totalsegmentator2")->size(), 117u);
  // The versions assign one value to different organs.
  EXPECT_EQ(findBuiltInLabelNames("totalsegmentator1")->at(7).name, "aorta");
  EXPECT_EQ(findBuiltInLabelNames("totalsegmentator2")->at(7).name, "pancreas");
  EXPECT_EQ(findBuiltInLabelNames("freesurfer")->at(17).name, "Left-Hippocampus");
  EXPECT_EQ(findBuiltInLabelNames("freesurfer")->at(2035).name, "ctx-rh-insula");
  EXPECT_FALSE(findBuiltInLabelNames("totalsegmentator"));
  EXPECT_FALSE(findBuiltInLabelNames("../presets/liver"));
  EXPECT_EQ(listBuiltInLabelTables().size(), 3u);
}

TEST(LabelNames, XmlOfAHeaderExtensionHasNamesAndColors) {
  const std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?> <CaretExtension><VolumeInformation Index=\"0\">"
      "<LabelTable><Label Key=\"1\" Red=\"0\" Green=\"1.0\" Blue=\"0.5\" "
      "Alpha=\"1\"><![CDATA[spleen]]>"
      "</Label>\n<Label Key=\"0\"><![CDATA[???]]></Label></LabelTable></VolumeInformation>"
      "</CaretExtension>\n   ";
  const auto names = parseLabelNamesXml(xml + std::string(5, '\0'), "a.nii");
  ASSERT_TRUE(names);
  EXPECT_EQ(names->size(), 1u);
  EXPECT_EQ(names->at(1).name, "spleen");
  EXPECT_EQ(*names->at(1).color, Rgb(0.0, 1.0, 0.5));
  EXPECT_FALSE(parseLabelNamesXml("<Other/>", "a.nii"));
  EXPECT_FALSE(parseLabelNamesXml("", "a.nii"));
  EXPECT_THROW(parseLabelNamesXml("<a><LabelTable><Label", "a.nii"), Error);
  EXPECT_THROW(parseLabelNamesXml("<a><LabelTable></LabelTable></a>", "a.nii"), Error);
}

} // namespace
