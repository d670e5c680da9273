// Default transfer functions: their choice, and that tissues of one kind have one color.

#include "scene/DefaultTransfer.h"

#include "Approx.h"
#include "Support.h"
#include "image/ColorVision.h"
#include "io/EmbeddedResources.h"
#include "model/medium/Reflectance.h"
#include "scene/Defaults.h"

#include <gtest/gtest.h>

#include <numeric>

namespace fenestra::core::testing::DefaultTransferTests {
namespace {

Volume makeRamp(double low, double high) {
  return makeVolume<float>(makeCenteredGrid({40, 30, 20}, {2.0, 2.0, 2.0}),
                           [=](const Vec3& p) { return low + (high - low) * p.x() / 39.0; });
}

TEST(DefaultTransfer, FollowsModalityContrastAgentAndSegments) {
  struct Case {
    std::optional<Modality> modality;
    bool isHounsfield, hasAgent;
    ScanContent content;
    std::optional<std::string> preset;
  };
  const Case cases[] = {
      {{}, true, false, {}, "ct-skin"},
      {{}, true, true, {}, "ct-skin"},
      {{}, true, false, {.hasSegments = true}, "ct-anatomy"},
      {{}, true, true, {.hasSegments = true}, "ct-contrast"},
      {{}, true, true, {.hasSegments = true, .blood = 45.0}, "ct-anatomy"},
      {{}, true, false, {.hasSegments = true, .blood = 110.0}, "ct-anatomy"},
      {{}, true, false, {.hasSegments = true, .blood = 240.0}, "ct-contrast"},
      {{}, true, true, {.hasSegments = true, .isLungFocus = true, .blood = 240.0}, "ct-lung"},
      {Modality::ct, true, false, {.hasSegments = true}, "ct-anatomy"},
      {Modality::mr, true, false, {.hasSegments = true}, "mr-anatomy"},
      {Modality::mr, false, false, {}, "mr-anatomy"},
      {Modality::us, false, false, {}, "us-fetal"},
      {Modality::pt, false, false, {}, "pet"},
      {{}, false, false, {.hasSegments = true, .brain = {1.0}}, "mr-anatomy"},
      {Modality::mr, false, false, {.hasSegments = true, .isKnee = true}, "mr-knee"},
      {{}, false, true, {.hasSegments = true}, std::nullopt},
      {{}, false, false, {}, std::nullopt},
  };
  for (const Case& c : cases) {
    Volume volume = c.isHounsfield ? makeRamp(-1000, 1500) : makeRamp(0, 255);
    volume.modality = c.modality;
    volume.hasContrastAgent = c.hasAgent;
    EXPECT_EQ(chooseTransferPreset(volume, c.content), c.preset) << &c - cases;
  }
  EXPECT_EQ(chooseTransferPreset(makeRamp(-8192, 3071), {}), "ct-skin") << "padded";
  EXPECT_FALSE(chooseTransferPreset(makeRamp(0, 4000), {}));
  Volume counts = makeRamp(0, 30000);
  counts.modality = Modality::pt;
  EXPECT_FALSE(chooseTransferPreset(counts, {})) << "Bq/ml";
  const auto makeBody = [](double air) {
    return makeVolume<float>(makeCenteredGrid({40, 30, 20}, {2.0, 2.0, 2.0}), [=](const Vec3& p) {
      return p.y() < air * 30.0 ? 3.0 : 200.0 + 20.0 * p.x();
    });
  };
  EXPECT_EQ(chooseTransferPreset(makeBody(0.2), {}), "mr-anatomy") << "as NIfTI files of MR";
  EXPECT_FALSE(chooseTransferPreset(makeBody(0.05), {})) << "no air";
}

/// A volume of blood, 45 HU, in segment 1 ("aorta_false_lumen"), and with contrast agent, 300 HU,
/// in segment 2 ("aorta").
TEST(DefaultTransfer, BloodIsTheGreatestMedianOfAortaAndHeart) {
  const Grid grid = makeCenteredGrid({20, 10, 10}, {2.0, 2.0, 2.0});
  const Volume volume = makeVolume<std::int16_t>(grid, [](const Vec3& p) {
    return p.x() < 5 ? 45 : p.x() < 10 ? 300 : p.x() < 15 ? -1000 : 900;
  });
  LargeArray<std::uint8_t> labels;
  for (std::int64_t i = 0; i < grid.voxelCount(); ++i)
    labels.push_back(static_cast<std::uint8_t>(1 + (i % 20) / 5));
  const auto makeSegments = [&](const std::vector<std::string>& names) {
    std::vector<SegmentInfo> segments;
    for (const std::string& name : names)
      segments.push_back({name, name, static_cast<std::int32_t>(segments.size()) + 1});
    return Segmentation("test", grid, 1, Segmentation::Labels(labels), segments);
  };
  const std::vector<bool> all(4, true);
  const ScanContent content =
      describeScan(volume, makeSegments({"aorta_false_lumen", "aorta", "lung_left", "bone"}), all,
                   {"lung_left"});
  EXPECT_TRUE(content.hasSegments);
  EXPECT_TRUE(content.isLungFocus);
  EXPECT_EQ(content.blood, 300.0);
  const Segmentation others = makeSegments({"liver", "spleen", "lung_left", "bone"});
  EXPECT_FALSE(describeScan(volume, others, all, {"lung_left", "bone"}).isLungFocus);
  EXPECT_FALSE(describeScan(volume, others, all, {}).blood);
  const Volume mr = makeVolume<std::int16_t>(grid, [](const Vec3& p) { return 10.0 * p.x(); });
  for (const char* part : {"patella", "patellar_cartilage", "meniscus_medial", "cruciate_anterior"})
    EXPECT_TRUE(describeScan(mr, makeSegments({"a", part, "b", "c"}), all, {}).isKnee) << part;
  for (const char* code : {"SCT^64234005", "SCT^244564004"}) {
    std::vector<SegmentInfo> coded = {{"a", "a", 1}, {"b", "b", 2}};
    coded[1].type = code;
    EXPECT_TRUE(describeScan(mr, Segmentation("test", grid, 1, Segmentation::Labels(labels), coded),
                             {true, true}, {})
                    .isKnee)
        << code;
  }
  EXPECT_FALSE(
      describeScan(mr, makeSegments({"patella", "a", "b", "c"}), {false, true, true, true}, {})
          .isKnee)
      << "empty";
  EXPECT_FALSE(describeScan(mr, others, all, {}).isKnee);
  const Segmentation empty = makeSegments({"liver", "aorta", "lung_left", "bone"});
  EXPECT_FALSE(describeScan(volume, empty, {true, false, true, true}, {}).blood);
}

/// Three tissues with overlapping values, and air: the scale is at their means within 5 %.
TEST(DefaultTransfer, TissuesAreTheCentersOfThreeClasses) {
  const Volume volume =
      makeVolume<float>(makeCenteredGrid({48, 40, 40}, {1, 1, 1}), [](const Vec3& p) {
        const double tissue = p.x() < 12 ? 0.0 : p.x() < 20 ? 60.0 : p.x() < 34 ? 120.0 : 170.0;
        return tissue == 0.0 ? 0.0 : tissue + 15.0 * std::sin(p.y() + 3.0 * p.z());
      });
  const TissueScale scale = findTissues(volume, {});
  EXPECT_EQ(scale[0], 0.0);
  EXPECT_NEAR(scale[1], 60.0, 4.0);
  EXPECT_NEAR(scale[2], 120.0, 6.0);
  EXPECT_NEAR(scale[3], 170.0, 6.0);
  std::vector<double> brain(300);
  std::iota(brain.begin(), brain.end(), 30.0); // the values 30 to 329, clamped to the range
  EXPECT_GT(findTissues(volume, brain)[3], 170.0);
  for (const double constant : {0.0, 7.0}) {
    const TissueScale flat = findTissues(makeRamp(constant, constant), {});
    EXPECT_TRUE(std::ranges::is_sorted(flat));
    EXPECT_LT(flat[0], flat[1]);
  }
}

TEST(DefaultTransfer, RangeRunsFromTransparentToOpaqueAndAConstantIsVisible) {
  const TransferFunction transfer = makeRelativeTransfer(makeRamp(0, 1000));
  EXPECT_EQ(transfer.extinction(0.0).value(), 0.0);
  EXPECT_GT(transfer.extinction(1000.0).value(), 1.0);
  EXPECT_TRUE(transfer.shading);
  const TransferFunction flat = makeRelativeTransfer(makeRamp(7, 7));
  EXPECT_GT(flat.extinction(7.0).value(), 0.0);
  EXPECT_FALSE(flat.shading);
}

Lab findColor(const TransferFunction& transfer, double value) {
  return toLab(toReflectance(transfer.albedo(value), transfer.g));
}

/// Mean +- 2 sd of tissues in CT, after noise reduction (sd 10 HU): no color ramp there.
TEST(DefaultTransfer, NoColorRampInsideATissue) {
  const std::pair<double, double> tissues[] = {{-104, 10}, {51, 10}, {60, 10}, {41, 10}};
  for (const char* name : {"ct-anatomy", "ct-contrast", "ct-lung"}) {
    const TransferFunction transfer =
        parseTransferJson(findResource(concat("transfer/", name, ".json")), name).function;
    for (const auto& [mean, deviation] : tissues) {
      EXPECT_LT(deltaE76(findColor(transfer, mean - 2.0 * deviation),
                         findColor(transfer, mean + 2.0 * deviation)),
                6.0)
          << name << " " << mean;
    }
  }
}

} // namespace
} // namespace fenestra::core::testing::DefaultTransferTests
