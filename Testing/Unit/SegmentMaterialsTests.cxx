// Materials assigned to segments by names and codes as common programs write them.

#include "base/Color.h"
#include "files/segments/LabelNames.h"
#include "image/ColorVision.h"
#include "scene/SegmentMaterials.h"

#include <gtest/gtest.h>

namespace fenestra::core::SegmentMaterialsTests {
namespace {

SegmentInfo makeSegment(const std::string& name) {
  return {.id = name, .name = name};
}

SegmentInfo makeCodedSegment(const std::string& category, const std::string& type,
                             const std::string& region = "",
                             const std::string& name = "Segment_1") {
  SegmentInfo info = makeSegment(name);
  info.category = category;
  info.type = type;
  info.region = region;
  return info;
}

SegmentMaterial findMaterial(const SegmentInfo& segment,
                             const MaterialTable& table = materialLibrary()) {
  return assignMaterials({segment}, table).at(0);
}

/// Segment names and the materials that they must get.
const std::vector<std::pair<std::string, std::string>> expectedMaterials = {
    // TotalSegmentator
    {"spleen", "spleen"},
    {"kidney_left", "kidney"},
    {"kidney_cyst_left", "cyst"},
    {"urinary_bladder", "bladder"},
    {"gallbladder", "gallbladder"},
    {"pulmonary_artery", "pulmonary-artery"},
    {"pulmonary_vein", "pulmonary-vein"},
    {"portal_vein_and_splenic_vein", "portal-vein"},
    {"iliac_vena_left", "vein"},
    {"superior_vena_cava", "vein"},
    {"brachiocephalic_trunk", "artery"},
    {"common_carotid_artery_left", "artery"},
    {"heart_ventricle_left", "heart"},
    {"atrial_appendage_left", "heart"},
    {"vertebrae_T12", "bone"},
    {"costal_cartilages", "cartilage"},
    {"autochthon_left", "muscle"},
    {"gluteus_medius_right", "muscle"},
    {"spinal_cord", "white-matter"},
    {"thyroid_gland", "thyroid"},
    {"adrenal_gland_left", "gland"},
    {"face", "skin"},
    {"body_trunc", "tissue"},
    {"liver_vessels", "vessel"},
    {"lung_nodules", "lesion"},
    {"hip_implant", "metal"},
    {"intracerebral_hemorrhage", "clot"},
    {"pleural_effusion", "fluid"},
    {"left_ventricular_outflow_tract", "heart"},
    // SPL's atlases of knee, head and abdomen, and Slicer's generic colors
    {"infrapatellar_fat_body", "fat"},
    {"anterior_cruciate_ligament", "connective-tissue"},
    {"iliotibial_tract", "connective-tissue"},
    {"muscular_branches_tibialis_nerve", "nerve"},
    {"medial_head_gastrocnemius_muscle", "muscle"},
    {"lateral_tibial_cartilage", "cartilage"},
    {"medial_meniscus", "meniscus"},
    {"great_saphenous_vein", "vein"},
    {"left_superior_temporal_gyrus_(banks_of_left_superior_temporal_sulcus)", "grey-matter"},
    {"white_matter_of_left_hemisphere_of_cerebellum", "white-matter"},
    {"left_lateral_ventricle", "fluid"},
    {"left_ventricle_of_heart", "heart"},
    {"left_optic_tract", "nerve"},
    {"left_levator_palpebrae_superioris", "muscle"},
    {"L5-L4-IntervertebralDisc", "meniscus"},
    {"Cervical7", "bone"},
    {"left_palatine_bone", "bone"},
    {"gray_matter_of_spinal_cord", "grey-matter"},
    // FreeSurfer, radiotherapy, and names that people type
    {"Left-Inf-Lat-Vent", "fluid"},
    {"Left-VentralDC", "grey-matter"},
    {"ctx-lh-bankssts", "grey-matter"},
    {"wm-rh-insula", "white-matter"},
    {"BODY", "tissue"},
    {"Femoral_Head_Lt", "bone"},
    {"Bladder_Union_PTV", "bladder"},
    {"PTV_70", "lesion"},
    {"Glnd_Submand_L", "gland"},
    {"Enhancing Tumor", "lesion"},
    {"kidney stone", "bone"},
    {"Gall bladder", "gallbladder"},
    {"Bone, left", "bone"},
};

TEST(SegmentMaterials, NamesGetTheMaterialThatAClinicianExpects) {
  for (const auto& [name, material] : expectedMaterials) {
    const SegmentMaterial found = findMaterial(makeSegment(name));
    EXPECT_EQ(found.name, material) << name << ": " << found.reason;
  }
  for (const char* unknown : {"", "Segment_1", "mask", "optic disc", "unknown", "region_7"})
    EXPECT_EQ(findMaterial(makeSegment(unknown)).name, "") << unknown;
}

TEST(SegmentMaterials, EveryLabelOfTheBuiltInTablesHasAMaterial) {
  for (const std::string& table : listBuiltInLabelTables()) {
    const LabelNames labels = *findBuiltInLabelNames(table);
    for (const auto& [value, label] : labels) {
      const SegmentMaterial found = findMaterial(makeSegment(label.name));
      EXPECT_NE(found.name, "") << table << ' ' << label.name << ": " << found.reason;
      EXPECT_EQ(found.reason.rfind("by name '", 0), 0u) << found.reason;
    }
  }
  EXPECT_EQ(findBuiltInLabelNames("totalsegmentator1")->size(), 104u);
  EXPECT_EQ(findBuiltInLabelNames("totalsegmentator2")->size(), 117u);
}

TEST(SegmentMaterials, CodesPrecedeNames) {
  const std::string anatomy = "SCT^123037004", altered = "SCT^49755003";
  const auto expect = [](const SegmentInfo& segment, const char* material, const char* reason) {
    const SegmentMaterial found = findMaterial(segment);
    EXPECT_EQ(found.name, material) << found.reason;
    EXPECT_EQ(found.reason, reason);
  };
  expect(makeCodedSegment(anatomy, "SCT^10200004", "", "spleen"), "liver", "by SCT^10200004");
  expect(makeCodedSegment(anatomy, "SRT^T-62000"), "liver", "by SRT^T-62000");
  expect(makeCodedSegment("", "FMA^7197"), "liver", "by FMA^7197");
  expect(makeCodedSegment(altered, "SCT^4147007", "SCT^10200004"), "lesion", "by SCT^4147007");
  expect(makeCodedSegment(altered, "SCT^367643001", "SCT^64033007"), "cyst", "by SCT^367643001");
  expect(makeCodedSegment(altered, "SCT^1", "SCT^10200004", "liver"), "lesion",
         "by category SCT^49755003");
  expect(makeCodedSegment("SCT^85756007", "SCT^85756007", "SCT^10200004"), "liver",
         "by region SCT^10200004");
  expect(makeCodedSegment("SCT^260787004", "SCT^19227008", "", "overlapping sphere"), "metal",
         "by SCT^19227008");
  expect(makeCodedSegment(anatomy, "SCT^2", "SCT^3", "left lung"), "lung", "by name 'lung*'");
}

MaterialTable parseRules(const std::string& rules) {
  return parseMaterials(R"({"version": 1, "materials": {"a": {"color": "#ff0000"}, "b": {}},
                           "segments": [)" +
                            rules + "]}",
                        "test", materialLibrary());
}

TEST(SegmentMaterials, RulesOfAFilePrecedeTheLibrary) {
  const MaterialTable table = parseRules(
      R"({"match": {"names": ["liver"], "except": ["vessel*"]}, "material": "a", "priority": 1},
         {"match": {"values": [7]}, "material": "b", "clip": false, "density": 3},
         {"match": {"names": ["left liver"]}, "material": "b", "priority": 2},
         {"match": {"codes": ["SCT^4147007~SCT^10200004"]}, "material": "b"})");
  EXPECT_EQ(findMaterial(makeSegment("Liver"), table).name, "a");
  EXPECT_EQ(findMaterial(makeCodedSegment("", "SCT^10200004", "", "Liver"), table).name, "a");
  EXPECT_EQ(findMaterial(makeSegment("liver vessels"), table).name, "vessel") << "an exception";
  EXPECT_EQ(findMaterial(makeSegment("left liver"), table).name, "b") << "has the higher priority";
  EXPECT_EQ(findMaterial(makeSegment("spleen"), table).name, "spleen");
  EXPECT_EQ(findMaterial(makeCodedSegment("", "SCT^4147007", "SCT^10200004"), table).reason,
            "by SCT^4147007~SCT^10200004");
  EXPECT_EQ(findMaterial(makeCodedSegment("", "SCT^4147007", "SCT^12738006"), table).name,
            "lesion");
  SegmentInfo seven = makeSegment("liver");
  seven.labelValue = 7;
  const SegmentMaterial found = findMaterial(seven, table);
  EXPECT_EQ(found.reason, "by value 7");
  EXPECT_FALSE(found.medium.isClipped);
  EXPECT_EQ(found.medium.density, 3.0);
}

/// The exceptions of a rule are names; they also apply if the segment's code matches.
TEST(SegmentMaterials, ExceptionsApplyToCodes) {
  EXPECT_EQ(findMaterial(makeCodedSegment("", "SCT^10200004", "", "hepatic vein")).name, "vein");
  EXPECT_EQ(findMaterial(makeCodedSegment("", "SCT^10200004", "", "liver mass")).name, "lesion");
}

TEST(SegmentMaterials, UnknownSegmentsKeepTheirColorOrGetAPaletteColor) {
  std::vector<SegmentInfo> segments(22, makeSegment("unknown"));
  segments[1].color = Rgb(0.2, 0.4, 0.6);
  const std::vector<SegmentMaterial> found = assignMaterials(segments, materialLibrary());
  EXPECT_EQ(found[0].reason, "by palette");
  EXPECT_EQ(found[1].reason, "by its own color");
  const Rgb expected = encodeSrgb((*found[1].medium.material.color)(0));
  EXPECT_LT((expected - segments[1].color).abs().maxCoeff(), 1e-12);
  std::vector<Lab> palette;
  for (const SegmentMaterial& material : found)
    if (material.reason == "by palette")
      palette.push_back(toLab((*material.medium.material.color)(0)));
  ASSERT_EQ(palette.size(), 21u);
  for (std::size_t i = 0; i < 20; ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT(deltaE76(palette[i], palette[j]), 30.0) << i << ' ' << j;
  EXPECT_EQ(deltaE76(palette[20], palette[0]), 0.0) << "the palette repeats";
}

TEST(SegmentMaterials, PriorityDependsOnTheKindOfTissue) {
  const auto priority = [](const char* name) {
    return findMaterial(makeSegment(name)).medium.priority;
  };
  EXPECT_EQ(priority("liver tumour"), 30);
  EXPECT_EQ(priority("aorta"), 15);
  EXPECT_EQ(priority("liver"), 10);
  EXPECT_EQ(priority("body"), 5);
  EXPECT_EQ(priority("skeletal_muscle"), 5);
  EXPECT_EQ(priority("subcutaneous_fat"), 5);
}

} // namespace
} // namespace fenestra::core::SegmentMaterialsTests
