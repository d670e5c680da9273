// Organ presets: content of their files, errors, and name patterns.

#include "base/Text.h"
#include "files/appearance/PresetReader.h"
#include "files/appearance/TransferReader.h"
#include "io/EmbeddedResources.h"

#include "Refusals.h"

namespace fenestra::core::PresetReaderTests {
namespace {

using Strings = std::vector<std::string>;

TEST(PresetReader, ReadsEveryField) {
  const OrganPreset preset = parsePreset(
      R"({"title": "A spleen", "modality": "CT", "before": ["liver"], "tested": "no",
          "focus": {"names": ["spleen"], "except": ["accessory"], "codes": ["SCT^78961009"]},
          "flags": {"view": "left", "density": 2.5, "background": [0.5, 1, 0],
                    "transfer": {"extinction": [[0, 1]], "albedo": [[0, 1, 1, 1]]}}})",
      "some/spleen.json");
  EXPECT_EQ(preset.name, "spleen");
  EXPECT_EQ(preset.title, "A spleen");
  EXPECT_EQ(preset.modality, Modality::ct);
  EXPECT_EQ(preset.focus.names, std::vector<NamePattern>{"spleen"});
  EXPECT_EQ(preset.focus.except, std::vector<NamePattern>{"accessory"});
  EXPECT_EQ(preset.focus.codes, Strings{"SCT^78961009"});
  EXPECT_EQ(preset.before, Strings{"liver"});
  EXPECT_EQ(preset.tested, "no");
  const std::vector<std::pair<std::string, std::string>> options = {
      {"background", "0.5,1,0"},
      {"density", "2.5"},
      {"transfer", R"({"albedo":[[0,1,1,1]],"extinction":[[0,1]]})"},
      {"view", "left"}};
  EXPECT_EQ(preset.options, options);
}

TEST(PresetReader, ErrorNamesField) {
  const auto refuse = [](const std::string& json, const std::string& text) {
    expectRefused("test", text, [&] { parsePreset(json, "test"); });
  };
  const std::string t = R"("title": "T", )", m = R"("modality": "MR", )";
  const std::string f = R"("focus": {"names": ["a"]}, )", g = R"("flags": {})";
  EXPECT_NO_THROW(parsePreset("{" + t + m + f + g + "}", "test"));
  refuse("{" + m + f + g + "}", "invalid-file | title");
  refuse("{" + t + f + g + "}", "invalid-file | modality");
  refuse("{" + t + m + g + "}", "invalid-file | focus");
  refuse("{" + t + R"("modality": "MR", "focus": {"names": ["a"]}})", "invalid-file | flags");
  refuse("{" + t + m + f + g + R"(, "colors": 1})", "invalid-file | colors");
  refuse("{" + t + R"("modality": "PET", )" + f + g + "}", "invalid-field: modality");
  refuse("{" + t + m + R"("focus": {"except": ["a"]}, )" + g + "}", "invalid-field: focus");
  refuse("{" + t + m + R"("focus": {"names": "a"}, )" + g + "}", "invalid-field: focus.names");
  refuse("{" + t + m + R"("focus": {"names": ["a", ""]}, )" + g + "}",
         "invalid-field: focus.names[1]");
  refuse("{" + t + m + R"("focus": {"names": [7]}, )" + g + "}", "invalid-field: focus.names[0]");
  for (const char* code : {"39607008", "SCT^", "^39607008", "SCT^3~", "SCT^3~4", "SCT^3^Lung"})
    refuse("{" + t + m + R"("focus": {"codes": ["SCT^1", ")" + std::string(code) + R"("]}, )" + g +
               "}",
           "invalid-field: focus.codes[1]");
  refuse("{" + t + m + f + R"("flags": {"view": true}})", "invalid-field: flags.view");
  refuse("{" + t + m + f + R"("flags": {"view": [1, "a"]}})", "invalid-field: flags.view[1]");
  refuse("{" + t + m + f + R"("flags": {"new\nline": null}})", "invalid-field: flags.new line");
  refuse("[]", "invalid-file");
  refuse("{", "damaged-file");
}

bool matchesName(const std::string& pattern, const std::string& name) {
  return NamePattern(pattern).matches(splitName(name));
}

TEST(PresetReader, MatchesWordsInAnyCaseAndSeparation) {
  for (const char* name : {"lung", "Left Lung", "lung_upper_lobe_left", "LungRight", "LUNG-R",
                           "right.lung", "  lung  ", "LeftLungMask"})
    EXPECT_TRUE(matchesName("lung", name)) << name;
  for (const char* name : {"", "lungs", "plunge", "lunge", "Segment_1", "lu ng"})
    EXPECT_FALSE(matchesName("lung", name)) << name;
  EXPECT_TRUE(matchesName("lung*", "lungs"));
  EXPECT_TRUE(matchesName("*vertebra*", "CervicalVertebrae"));
  EXPECT_TRUE(matchesName("gr?y matter", "Cerebral Grey_Matter (left)"));
  EXPECT_TRUE(matchesName("gr?y matter", "gray-matter"));
  EXPECT_FALSE(matchesName("gr?y matter", "matter, grey"));
  EXPECT_FALSE(matchesName("gr?y matter", "grey dark matter"));
  EXPECT_TRUE(matchesName("a*b*c", "axxbyyc"));
  EXPECT_FALSE(matchesName("a*b*c", "axxbyyd"));
  EXPECT_TRUE(matchesName("Leber*", "leberlappen"));
  EXPECT_TRUE(matchesName("h\xc3\xa4nde", "linke h\xc3\xa4nde")); // bytes beyond ASCII are letters
  EXPECT_FALSE(matchesName("", "lung"));
  EXPECT_FALSE(matchesName("-", "lung"));
}

/// Naive backtracking would take time exponential in the number of stars.
TEST(PresetReader, PatternWithManyStarsIsFast) {
  std::string stars;
  for (int i = 0; i < 60; ++i)
    stars += "a*";
  EXPECT_FALSE(matchesName(stars + "b", std::string(1000, 'a')));
  EXPECT_TRUE(matchesName(stars, std::string(1000, 'a')));
}

TEST(PresetReader, ReadsEveryBuiltInPreset) {
  const auto files = listResources("presets/");
  EXPECT_GE(files.size(), 9u);
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    const OrganPreset preset = parsePreset(findResource(file), file);
    EXPECT_FALSE(preset.title.empty());
    EXPECT_FALSE(preset.tested.empty());
    for (const std::string& other : preset.before)
      EXPECT_FALSE(findResource("presets/" + other + ".json").empty()) << other;
    for (const auto& [option, value] : preset.options)
      if (option == "transfer") {
        // Scalars of MR and ultrasound have no absolute scale.
        const TransferFile transfer =
            parseTransferJson(findResource("transfer/" + value + ".json"), value);
        EXPECT_EQ(transfer.scalars == TransferFile::Scalars::absolute,
                  preset.modality == Modality::ct);
      }
  }
}

} // namespace
} // namespace fenestra::core::PresetReaderTests
