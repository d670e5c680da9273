// Material tables and changes to them: content, errors, and the built-in library.

#include "files/appearance/MaterialReader.h"
#include "io/EmbeddedResources.h"
#include "model/medium/Reflectance.h"

#include "Refusals.h"

#include <set>

namespace fenestra::core::MaterialReaderTests {
namespace {

constexpr const char* organs = R"({"version": 1,
  "materials": {
    "liver": {"color": [[-20, "#b48a66"], [50, "#963e2e"]], "extinction": "base", "g": 0.5,
              "specular": 0.25, "roughness": 0.35, "border": 0.1},
    "lesion": {"albedo": [0.9, 0.8, 0.1], "extinction": 6, "g": -0.5, "diffuse": 0.8},
    "bone": {"color": "#ffffff", "extinction": [[100, 0], [300, 8]]},
    "stone": {"albedo": [[0, 0.1, 0.2, 0.3], [1, 1, 1, 1]], "kind": "matter"},
    "tissue": {}},
  "segments": [
    {"match": {"codes": ["SCT^10200004"], "names": ["liver"], "except": ["vessel*"], "values": [5]},
     "material": "liver", "priority": 12, "clip": false, "density": 2},
    {"match": {"category": "SCT^49755003"}, "material": "lesion"}],
  "rest": {"material": "tissue"},
  "context": {"saturation": 0.6, "lightness": 0.15}})";

double evalExtinction(const Material& material, double scalar) {
  return (*material.extinction)(scalar).value();
}

TEST(MaterialReader, ReadsEveryFieldOfMaterial) {
  const auto materials = parseMaterials(organs, "test").materials;
  ASSERT_EQ(materials.size(), 5u);
  const Material& liver = materials.at("liver");
  EXPECT_EQ(liver.kind, MaterialKind::tint);
  ASSERT_TRUE(liver.color);
  EXPECT_FALSE(liver.colorIsAlbedo);
  EXPECT_EQ(liver.color->knots().size(), 2u);
  EXPECT_NEAR((*liver.color)(50)[0], std::pow((0x96 / 255.0 + 0.055) / 1.055, 2.4), 1e-12);
  EXPECT_FALSE(liver.extinction) << "the volume's";
  EXPECT_EQ(liver.g, 0.5);
  EXPECT_EQ(liver.diffuse, 1.0) << "the default";
  EXPECT_EQ(liver.specular, 0.25);
  EXPECT_EQ(liver.roughness, 0.35);
  EXPECT_EQ(liver.interfaceWeight, 0.1);
  const Material& lesion = materials.at("lesion");
  EXPECT_EQ(lesion.kind, MaterialKind::medium) << "it has its own extinction";
  EXPECT_TRUE(lesion.colorIsAlbedo);
  EXPECT_EQ((*lesion.color)(-1000)[2], 0.1);
  EXPECT_EQ(evalExtinction(lesion, 1e6), 6.0);
  EXPECT_EQ(lesion.g, -0.5);
  EXPECT_EQ(lesion.diffuse, 0.8);
  EXPECT_EQ(evalExtinction(materials.at("bone"), 200), 4.0);
  EXPECT_EQ(materials.at("stone").kind, MaterialKind::medium);
  EXPECT_EQ((*materials.at("stone").color)(0)[1], 0.2);
  EXPECT_FALSE(materials.at("tissue").color) << "the volume's";
}

TEST(MaterialReader, ReadsEveryFieldOfRule) {
  const MaterialTable table = parseMaterials(organs, "test");
  ASSERT_EQ(table.rules.size(), 2u);
  const MaterialRule& rule = table.rules[0];
  EXPECT_EQ(rule.patterns.codes, std::vector<std::string>{"SCT^10200004"});
  EXPECT_EQ(rule.patterns.names, std::vector<NamePattern>{"liver"});
  EXPECT_EQ(rule.patterns.except, std::vector<NamePattern>{"vessel*"});
  EXPECT_EQ(rule.values, std::vector<std::int32_t>{5});
  EXPECT_EQ(rule.material, "liver");
  EXPECT_EQ(rule.priority, 12);
  EXPECT_FALSE(rule.isClipped);
  EXPECT_EQ(rule.density, 2.0);
  EXPECT_EQ(table.rules[1].category, "SCT^49755003");
  EXPECT_EQ(table.rules[1].priority, 10);
  EXPECT_TRUE(table.rules[1].isClipped);
  EXPECT_EQ(table.rest, "tissue");
  EXPECT_EQ(table.context.saturation, 0.6);
  EXPECT_EQ(table.context.lightness, 0.15);
  EXPECT_FALSE(table.hasContrast);
  const MaterialTable bare = parseMaterials(
      R"({"version": 1, "contrast": true, "context": {"lightness": 0}})", "bare.json");
  EXPECT_TRUE(bare.hasContrast);
  EXPECT_FALSE(bare.context.saturation);
  EXPECT_EQ(bare.context.lightness, 0.0);
}

TEST(MaterialReader, FileOverridesBaseTable) {
  const MaterialTable base = parseMaterials(organs, "test");
  const MaterialTable table = parseMaterials(
      R"({"version": 1, "materials": {"lesion": {"color": "#00ff00"}},
          "segments": [{"match": {"names": ["spleen"]}, "material": "liver"}]})",
      "mine", base);
  EXPECT_EQ(table.materials.size(), 5u);
  EXPECT_FALSE(table.materials.at("lesion").extinction) << "replaced completely";
  ASSERT_EQ(table.rules.size(), 3u);
  EXPECT_EQ(table.rules[0].patterns.names, std::vector<NamePattern>{"spleen"});
  EXPECT_TRUE(table.rules[0].isFromFile);
  EXPECT_FALSE(table.rules[1].isFromFile);
  EXPECT_EQ(table.rest, "tissue");
}

TEST(MaterialReader, AlbedoConvertsToReflectanceColor) {
  const auto materials = parseMaterials(organs, "test").materials;
  const Material& lesion = materials.at("lesion");
  EXPECT_NEAR((*toReflectanceColor(lesion))(0)[0], toReflectance(0.9, -0.5), 1e-12);
  const Material& bone = materials.at("bone");
  EXPECT_EQ((*toReflectanceColor(bone))(0)[0], 1.0);
  EXPECT_FALSE(toReflectanceColor(materials.at("tissue")));
}

void refuse(const std::string& json, const std::string& text) {
  expectRefused("test", text, [&] { parseMaterials(json, "test"); });
}

void refuseMaterial(const std::string& fields, const std::string& text) {
  refuse(R"({"version": 1, "materials": {"m": {)" + fields + "}}}", text);
}

void refuseRule(const std::string& fields, const std::string& text) {
  refuse(R"({"version": 1, "materials": {"m": {}}, "segments": [{)" + fields + "}]}", text);
}

TEST(MaterialReader, ErrorNamesFieldOfTable) {
  refuse("[]", "invalid-file");
  refuse("{", "damaged-file");
  refuse("{}", "invalid-file | version");
  refuse(R"({"version": 2})", "invalid-field: version");
  refuse(R"({"version": "1"})", "invalid-field: version");
  refuse(R"({"version": 1, "labels": "x"})", "invalid-file | labels");
  refuse(R"({"version": 1, "materials": []})", "invalid-field: materials");
  refuse(R"({"version": 1, "segments": {}})", "invalid-field: segments");
  refuse(R"({"version": 1, "rest": {"material": "air"}})", "invalid-field: rest.material");
  refuse(R"({"version": 1, "rest": {}})", "invalid-field: rest | material");
  refuse(R"({"version": 1, "context": {"saturation": 2}})", "invalid-field: context.saturation");
  refuse(R"({"version": 1, "contrast": "much"})", "invalid-field: contrast");
  refuse(R"({"version": 1, "context": {"hue": 2}})", "invalid-field: context | hue");
}

TEST(MaterialReader, ErrorNamesFieldOfMaterial) {
  refuseMaterial(R"("colors": "#ffffff")", "invalid-field: materials.m | colors");
  refuseMaterial(R"("emission": [0, 0, 1])", "invalid-field | emission");
  refuseMaterial(R"("color": "red")", "invalid-field: materials.m.color");
  refuseMaterial(R"("color": [[0, "#ffffff", 1]])", "invalid-field: materials.m.color[0]");
  refuseMaterial(R"("color": [])", "invalid-field: materials.m.color");
  refuseMaterial(R"("color": "#ffffff", "albedo": [1, 1, 1])", "invalid-field: color");
  refuseMaterial(R"("albedo": [1, 1])", "invalid-field: materials.m.albedo");
  refuseMaterial(R"("albedo": [1, 1, 2])", "invalid-field: materials.m.albedo[2]");
  refuseMaterial(R"("albedo": [[0, 1, 1]])", "invalid-field: materials.m.albedo[0]");
  refuseMaterial(R"("albedo": "#ffffff")", "invalid-field: materials.m.albedo");
  refuseMaterial(R"("albedo": [])", "invalid-field: materials.m.albedo");
  refuseMaterial(R"("extinction": "basis")", "invalid-field: extinction");
  refuseMaterial(R"("extinction": -1)", "invalid-field: extinction");
  refuseMaterial(R"("extinction": [[0, -1]])", "invalid-field: extinction[0]");
  refuseMaterial(R"("g": 1)", "invalid-field: materials.m.g");
  refuseMaterial(R"("color": "#ffffff", "g": -0.5)", "invalid-field: materials.m.g");
  refuseMaterial(R"("kind": "ghost")", "invalid-field: materials.m.kind");
  refuseMaterial(R"("kind": "tint", "extinction": 2)", "invalid-field: materials.m.kind");
  refuseMaterial(R"("roughness": 0)", "invalid-field: materials.m.roughness");
  refuseMaterial(R"("specular": 1.5)", "invalid-field: materials.m.specular");
  refuseMaterial(R"("diffuse": "1")", "invalid-field: materials.m.diffuse");
  refuseMaterial(R"("border": -0.1)", "invalid-field: materials.m.border");
}

TEST(MaterialReader, ErrorNamesFieldOfRule) {
  const std::string match = R"("match": {"names": ["a"]}, )";
  refuseRule(R"("material": "m")", "invalid-field: segments[0] | match");
  refuseRule(R"("match": {}, "material": "m")", "invalid-field: segments[0].match");
  refuseRule(R"("match": {"except": ["a"]}, "material": "m")", "invalid-field: segments[0].match");
  refuseRule(R"("match": {"name": ["a"]}, "material": "m")", "invalid-field: match | \"name\"");
  refuseRule(R"("match": {"names": ["", "a"]}, "material": "m")", "invalid-field: match.names[0]");
  refuseRule(R"("match": {"codes": ["10200004"]}, "material": "m")", "invalid-field: codes[0]");
  refuseRule(R"("match": {"category": "altered"}, "material": "m")", "invalid-field: category");
  refuseRule(R"("match": {"values": [0]}, "material": "m")", "invalid-field: values[0]");
  refuseRule(R"("match": {"values": [1.5]}, "material": "m")", "invalid-field: values[0]");
  refuseRule(R"("match": {"values": [3e9]}, "material": "m")", "invalid-field: values[0]");
  refuseRule(match + R"("material": "liver")", "invalid-field: segments[0].material");
  refuseRule(match + R"("materials": "m")", "invalid-field: segments[0] | materials");
  refuseRule(match + R"("priority": 1)", "invalid-field: segments[0] | \"material\"");
  refuseRule(match + R"("material": "m", "priority": 1.5)", "invalid-field: priority");
  refuseRule(match + R"("material": "m", "priority": -1)", "invalid-field: priority");
  refuseRule(match + R"("material": "m", "clip": "no")", "invalid-field: segments[0].clip");
  refuseRule(match + R"("material": "m", "density": 1001)", "invalid-field: density");
  refuseRule(match + R"("material": "m", "importance": 1)",
             "invalid-field: segments[0] | importance");
}

TEST(MaterialReader, ChangesSingleSegment) {
  const MaterialTable table = parseMaterials(organs, "test");
  const MaterialChange change =
      parseMaterialChange("Liver: left : color=#00ff00, density=2.5 ,clip=no,priority=7", table);
  EXPECT_EQ(change.selector, "Liver: left") << "up to the last colon";
  SegmentMedium medium{table.materials.at("liver"), 10, true, 1.0};
  medium = applyChange(medium, change, table);
  EXPECT_EQ((*medium.material.color)(0)[1], 1.0);
  EXPECT_EQ((*medium.material.color)(0)[0], 0.0);
  EXPECT_EQ(medium.material.specular, 0.25) << "the liver's, unchanged";
  EXPECT_EQ(medium.density, 2.5);
  EXPECT_FALSE(medium.isClipped);
  EXPECT_EQ(medium.priority, 7);
  medium =
      applyChange(medium, parseMaterialChange("x: material=lesion, extinction=3", table), table);
  EXPECT_EQ(evalExtinction(medium.material, 0), 3.0);
  EXPECT_EQ(medium.material.diffuse, 0.8) << "the lesion's";
  EXPECT_EQ(medium.density, 2.5) << "the segment's";
  medium = applyChange(medium, parseMaterialChange("x: extinction=base, kind=tint", table), table);
  EXPECT_FALSE(medium.material.extinction);
  EXPECT_EQ(medium.material.kind, MaterialKind::tint);
}

TEST(MaterialReader, ErrorNamesFieldOfChange) {
  const MaterialTable table = parseMaterials(organs, "test");
  const auto refuseChange = [&](const std::string& text, const std::string& source,
                                const std::string& line) {
    expectRefused("material " + source, line, [&] { parseMaterialChange(text, table); });
  };
  refuseChange("liver", "liver", "invalid-field");
  refuseChange(": density=2", ": density=2", "invalid-field");
  refuseChange("liver:", "liver", "invalid-file");
  refuseChange("liver: density", "liver", "invalid-file | \" density\"");
  refuseChange("liver: density=2, density=3", "liver", "invalid-file: density");
  refuseChange("liver: colors=#ffffff", "liver", "invalid-file | colors");
  refuseChange("liver: color=red", "liver", "invalid-field: color");
  refuseChange("liver: den\x97sity=2", "liver", "invalid-file | den?sity");
  refuseChange("liver: clip=maybe", "liver", "invalid-field: clip");
  refuseChange("liver: density=-1", "liver", "invalid-field: density");
  refuseChange("liver: material=stomach", "liver", "invalid-field: material | stomach");
  const MaterialChange color = parseMaterialChange("a: color=#ffffff", table);
  const SegmentMedium backward{table.materials.at("lesion")};
  expectRefused("material a", "invalid-file | \"g\"", [&] { applyChange(backward, color, table); });
}

/// Each file must parse alone, and define each name and code once. Colors are constant, since MR
/// scalars have no unit.
TEST(MaterialReader, ReadsLibrary) {
  const auto files = listResources("materials/");
  EXPECT_GE(files.size(), 8u);
  std::set<std::string> names, codes;
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    const MaterialTable table = parseMaterials(findResource(file), file);
    for (const auto& [name, material] : table.materials) {
      EXPECT_TRUE(names.insert(name).second) << name;
      EXPECT_EQ(material.kind, MaterialKind::tint) << name;
      EXPECT_EQ(material.color.has_value(), name != "tissue") << name;
      // Only the lung, from air to vessels, has colors by value.
      EXPECT_EQ(material.color && material.color->knots().size() > 1, name == "lung") << name;
    }
    for (const MaterialRule& rule : table.rules)
      for (const std::string& code : rule.patterns.codes)
        EXPECT_TRUE(codes.insert(code).second) << code;
  }
  EXPECT_GE(names.size(), 24u);
}

} // namespace
} // namespace fenestra::core::MaterialReaderTests
