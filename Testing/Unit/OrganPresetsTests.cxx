// Segments that a preset selects as its focus, and presets selected for segments.

#include "io/EmbeddedResources.h"
#include "scene/Defaults.h"
#include "scene/NamedPresets.h"
#include "scene/OrganPresets.h"

#include "Refusals.h"
#include "Support.h"

namespace fenestra::core::OrganPresetsTests {
namespace {

using Strings = std::vector<std::string>;

SegmentInfo makeSegment(const std::string& name, const std::string& type = "",
                        const std::string& region = "") {
  SegmentInfo info;
  info.id = info.name = name;
  info.type = type;
  info.region = region;
  return info;
}

std::vector<SegmentInfo> makeSegments(const Strings& names) {
  std::vector<SegmentInfo> infos;
  for (const std::string& name : names)
    infos.push_back(makeSegment(name));
  return infos;
}

Strings listNames(const std::vector<SegmentInfo>& infos) {
  Strings names;
  for (const SegmentInfo& info : infos)
    names.push_back(info.name);
  return names;
}

OrganPreset makePreset(const std::string& name, Modality modality, const SegmentPatterns& focus,
                       const Strings& before = {}) {
  return {.name = name, .title = name, .modality = modality, .focus = focus, .before = before};
}

TEST(OrganPresets, FocusMatchesSegmentsByNameOrCode) {
  const SegmentPatterns patterns{
      {"lung*"}, {"nodule"}, {"SCT^39607008", "SCT^4147007~SCT^39607008"}};
  const std::vector<SegmentInfo> all = {makeSegment("heart", "SCT^80891009"),
                                        makeSegment("left lung"),
                                        makeSegment("Segment_6", "SCT^39607008"),
                                        makeSegment("lung nodule"),
                                        makeSegment("A", "SCT^4147007", "SCT^39607008"),
                                        makeSegment("B", "SCT^4147007", "SCT^12738006"),
                                        makeSegment("C", "SCT^396070081"),
                                        makeSegment("D", "SCT^4147007")};
  EXPECT_EQ(listNames(findFocusSegments(patterns, all)), (Strings{"left lung", "Segment_6", "A"}));
}

TEST(OrganPresets, PresetMatchesSegmentsAndModality) {
  const std::vector<OrganPreset> presets = {
      makePreset("liver", Modality::ct, {{"liver"}}),
      makePreset("brain", Modality::mr, {{"brain"}}),
      makePreset("tumor", Modality::mr, {{"tumo*r"}}, {"brain"}),
      makePreset("head-ct", Modality::ct, {{"brain"}}),
  };
  const auto match = [&](const Strings& names, Modality known) {
    return findMatchingPreset(
               presets, makeSegments(names), "s.seg.nrrd", [&] { return makeSegments(names); },
               [known](Modality modality) { return modality == known; })
        .name;
  };
  EXPECT_EQ(match({"Liver", "Spleen"}, Modality::ct), "liver");
  EXPECT_EQ(match({"brain"}, Modality::mr), "brain");
  EXPECT_EQ(match({"brain"}, Modality::ct), "head-ct");
  EXPECT_EQ(match({"brain", "Tumor"}, Modality::mr), "tumor");
  const auto refuse = [&](const Strings& names, const std::string& text) {
    expectRefused("s.seg.nrrd", text, [&] { match(names, Modality::mr); });
  };
  refuse({"Spleen", "Kidney"}, "no-matching-preset | Spleen, Kidney");
  EXPECT_EQ(match({"brain", "tumour", "liver"}, Modality::mr), "tumor");
}

TEST(OrganPresets, SeveralMatchingPresetsAreListed) {
  const std::vector<OrganPreset> presets = {makePreset("liver", Modality::ct, {{"liver"}}),
                                            makePreset("heart", Modality::ct, {{"heart"}})};
  expectRefused("s", "ambiguous-preset | liver (liver), heart (heart)", [&] {
    const auto segments = makeSegments({"liver", "heart"});
    findMatchingPreset(
        presets, segments, "s", [&] { return segments; },
        [](Modality) -> bool { throw std::logic_error("the modality must not matter"); });
  });
}

TEST(OrganPresets, EmptySegmentsMatchNoPreset) {
  const std::vector<OrganPreset> presets = {
      makePreset("liver", Modality::ct, {{"liver"}}),
      makePreset("heart", Modality::ct, {{"heart"}}),
      makePreset("tumor", Modality::ct, {{"tumor"}}, {"liver", "heart"})};
  const auto match = [&](const Strings& names, const Strings& nonEmpty) {
    return findMatchingPreset(
               presets, makeSegments(names), "s", [&] { return makeSegments(nonEmpty); },
               [](Modality) { return true; })
        .name;
  };
  EXPECT_EQ(match({"liver", "heart", "spleen"}, {"liver", "spleen"}), "liver");
  EXPECT_EQ(match({"liver", "tumor"}, {"liver"}), "liver") << "an empty one excludes no other";
  EXPECT_EQ(match({"heart"}, {}), "heart") << "labels are read only to decide";
  expectRefused("s", "no-matching-preset", [&] { match({"liver", "heart"}, {"spleen"}); });
}

/// Built-in presets that select the segment as their focus.
Strings listPresets(const SegmentInfo& segment) {
  Strings names;
  for (const std::string& name : listBuiltinPresets("presets"))
    if (!findFocusSegments(findOrganPreset(name).focus, {segment}).empty())
      names.push_back(name);
  return names;
}

/// Names used by TotalSegmentator, by Slicer's terminology and in common label lists.
TEST(OrganPresets, BuiltInPresetsMatchCommonNames) {
  const std::vector<std::pair<std::string, Strings>> expected = {
      {"liver", {"liver", "Liver", "Liver_1"}},
      {"heart", {"heart", "heart_myocardium", "heart_atrium_left", "Left Ventricle"}},
      {"spine", {"vertebrae_L5", "vertebrae_C1", "lumbar vertebral column", "sacrum"}},
      {"lungs",
       {"lung_upper_lobe_left", "right lung", "Lungs", "trachea", "lung_trachea_bronchia"}},
      {"foot-bones", {"Calcaneus", "Metatarsal 1", "metatarsals_feet", "phalanges_feet", "Talus"}},
      {"knee-cartilage", {"Femoral cartilage", "FemoralCartilage", "tibial cartilage"}},
      {"brain-surface", {"Brain", "brain_left_hemisphere", "Cerebral Grey Matter"}},
      {"brain-tumor", {"tumor", "Tumour core", "enhancing_tumor", "Glioblastoma"}},
      {"fetal-face", {"Fetal face", "face", "fetus"}},
  };
  for (const auto& [name, organs] : expected)
    for (const std::string& organ : organs)
      EXPECT_EQ(listPresets(makeSegment(organ)), Strings{name}) << organ;
  for (const char* none :
       {"spinal_cord", "brainstem", "liver_vessels", "lung_nodule", "rib_left_7", "skin",
        "costal_cartilages", "phalanges_hand", "portal_vein_and_splenic_vein", "iliac_vena_left",
        "hip_left", "lateral ventricle", "carotid_artery"})
    EXPECT_EQ(listPresets(makeSegment(none)), Strings{}) << none;
}

/// A segment's code is sufficient without a name.
TEST(OrganPresets, BuiltInPresetsMatchSlicerCodes) {
  EXPECT_EQ(listPresets(makeSegment("S", "SCT^10200004")), Strings{"liver"});
  EXPECT_EQ(listPresets(makeSegment("S", "SCT^39607008", "SCT^1")), Strings{"lungs"});
  EXPECT_EQ(listPresets(makeSegment("S", "SCT^122496007")), Strings{"spine"});
  EXPECT_EQ(listPresets(makeSegment("S", "SCT^4147007", "SCT^12738006")), Strings{"brain-tumor"});
  EXPECT_EQ(listPresets(makeSegment("S", "SCT^4147007", "SCT^10200004")), Strings{});
}

TEST(OrganPresets, ScalarRangeDistinguishesCt) {
  const Grid grid = testing::makeCenteredGrid({10, 10, 10}, Vec3::Ones());
  const auto volume = [&](double low, double high) {
    return testing::makeVolume<std::int16_t>(
        grid, [&](const Vec3& i) { return low + (high - low) * i.x() / 9.0; });
  };
  EXPECT_TRUE(isPlausibleModality(Modality::ct, volume(-1000, 1500)));
  EXPECT_FALSE(isPlausibleModality(Modality::ct, volume(0, 255)));
  EXPECT_FALSE(isPlausibleModality(Modality::mr, volume(-1000, 1500)));
  EXPECT_TRUE(isPlausibleModality(Modality::mr, volume(0, 255)));
  EXPECT_TRUE(isPlausibleModality(Modality::us, volume(0, 255)));
}

/// Each value from 0 to 99 999 occurs once, so that the percentiles are known.
TEST(OrganPresets, RobustRangeLiesBetweenPercentiles) {
  const Volume volume =
      testing::makeVolume(testing::makeCenteredGrid({100, 100, 10}, Vec3::Ones()),
                          [](const Vec3& i) { return i.x() + 100.0 * i.y() + 10000.0 * i.z(); });
  const auto [low, high] = findRobustRange(volume);
  EXPECT_NEAR(low, 500.0, 1.0);
  EXPECT_NEAR(high, 99500.0, 1.0);
}

} // namespace
} // namespace fenestra::core::OrganPresetsTests
