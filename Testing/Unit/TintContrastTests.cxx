// Contrast of a tinted focus: its interfaces, and the adjustment of colors until they differ.

#include "scene/TintContrast.h"

#include "Support.h"
#include "base/Color.h"
#include "model/medium/Reflectance.h"
#include "scene/SegmentMaterials.h"

#include <gtest/gtest.h>

#include <utility>

namespace fenestra::core::testing::TintContrastTests {
namespace {

Rgb hexToLinear(std::uint32_t rgb) {
  return decodeSrgb(fenestra::core::hexToRgb(rgb));
}

const Rgb liver = hexToLinear(0x6a3932), muscle = hexToLinear(0x79443d),
          bone = hexToLinear(0xe3d3b4), spleen = hexToLinear(0x5e333a),
          skin = hexToLinear(0xc09883), teal = hexToLinear(0x207068), vivid = hexToLinear(0xd62824);

ColorAdjustment choose(const std::vector<InterfaceColors>& colors,
                       const ContextColors& context = {}) {
  return chooseAdjustment(colors, context, Adjustable::both);
}
/// Initial adjustment of a tinted focus: that of the library.
constexpr ColorAdjustment muted{.contextSaturation = defaultContextSaturation};

double computeScore(const ColorAdjustment& adjustment, const InterfaceColors& colors) {
  return contrastScore(measureAdjustedContrast(adjustment, colors));
}

// ---- colors

TEST(TintContrast, LinearColorIsTheInverseOfLab) {
  for (const Rgb& color : {liver, bone, teal, Rgb(Rgb::Zero()), Rgb(1e-3, 2e-3, 5e-4)})
    EXPECT_LT((toLinear(toLab(color)) - color).abs().maxCoeff(), 1e-9);
}

TEST(TintContrast, AdjustmentsChangeColorsAsDocumented) {
  EXPECT_LT((adjustContext(liver, {}) - liver).abs().maxCoeff(), 1e-9);
  EXPECT_LT((adjustFocus(liver, {}) - liver).abs().maxCoeff(), 1e-9);
  const Lab before = toLab(liver);
  const Lab context =
      toLab(adjustContext(liver, {.contextSaturation = 0.5, .contextLightness = 0.25}));
  EXPECT_NEAR(context.L, before.L + 0.25 * (100.0 - before.L), 1e-6);
  EXPECT_NEAR(context.a, 0.5 * before.a, 1e-6);
  EXPECT_NEAR(context.b, 0.5 * before.b, 1e-6);
  const Lab focus = toLab(adjustFocus(liver, {.focusLightness = -5.0}));
  EXPECT_NEAR(focus.L, before.L - 5.0, 1e-6);
  EXPECT_NEAR(focus.a, before.a, 1e-6);
  const Lab lesion = toLab(decodeSrgb(fenestra::core::hexToRgb(accentColors[0].color)));
  const Lab half =
      toLab(adjustFocus(liver, {.focusLightness = 2.0, .focusAccent = 0.5, .accent = 0}));
  EXPECT_NEAR(half.L, 0.5 * (before.L + 2.0 + lesion.L), 1e-6);
  EXPECT_NEAR(half.a, 0.5 * (before.a + lesion.a), 1e-6);
  EXPECT_NEAR(half.b, 0.5 * (before.b + lesion.b), 1e-6);
  const Rgb white = adjustFocus(Rgb::Constant(0.94), {.focusLightness = 12.0});
  EXPECT_EQ(white.maxCoeff(), maxReflectance) << "at most as white as a medium can be";
}

/// A vivid red becomes so light that it is out of gamut: chroma is reduced instead of lightness or
/// hue.
TEST(TintContrast, OutOfGamutColorsKeepLightnessAndHue) {
  const Lab before = toLab(vivid);
  const Rgb color = adjustFocus(vivid, {.focusLightness = 20.0});
  const Lab after = toLab(color);
  EXPECT_LE(color.maxCoeff(), maxReflectance);
  EXPECT_NEAR(after.L, before.L + 20.0, 1e-3);
  EXPECT_NEAR(after.b / after.a, before.b / before.a, 1e-3);
  EXPECT_LT(std::hypot(after.a, after.b), std::hypot(before.a, before.b));
  EXPECT_GT(color.maxCoeff(), maxReflectance - 1e-3) << "chroma is reduced no more than necessary";
}

/// Images of an adjusted focus have a CIELAB chroma of at most 45, unless its own color is vivid.
TEST(TintContrast, ChromaIsLimited) {
  for (const auto& [name, material] : materialLibrary().materials) {
    if (!material.color)
      continue;
    const Rgb own = Rgb(material.color->knots().front().value);
    ColorAdjustment adjustment{.focusAccent = 0.6};
    for (adjustment.accent = 0; adjustment.accent < accentColors.size(); ++adjustment.accent)
      for (adjustment.focusLightness = -36.0; adjustment.focusLightness <= 36.0;
           adjustment.focusLightness += 36.0) {
        const Lab lab = toLab(adjustFocus(own, adjustment));
        const double saturation = 1.33 - 0.0074 * lab.L; // of images
        EXPECT_LT(saturation * std::hypot(lab.a, lab.b), 45.01) << name;
      }
  }
}

// ---- adjustments

TEST(TintContrast, DistinguishableColorsAreUnchanged) {
  EXPECT_EQ(choose({{spleen, bone, 1.0}}), muted);
  EXPECT_EQ(computeScore({}, {spleen, bone, 1.0}), 1.0);
}

TEST(TintContrast, FocusWithoutNeighborsIsUnchanged) {
  EXPECT_EQ(choose({}), ColorAdjustment());
}

/// Expects that only `member` is adjusted after `before`, to the middle of its range, and that a
/// twentieth of the range less is insufficient.
void expectLastAdjustment(double ColorAdjustment::*member, double limit,
                          const ColorAdjustment& before, const InterfaceColors& colors) {
  const ColorAdjustment adjustment = choose({colors});
  const double step = (limit - before.*member) / 20.0,
               adjusted = (adjustment.*member - before.*member) / step;
  EXPECT_GT(adjusted, 0.5);
  EXPECT_LT(adjusted, 19.5);
  EXPECT_GE(computeScore(adjustment, colors), sufficientScore);
  ColorAdjustment reduced = adjustment;
  reduced.*member -= step;
  EXPECT_LT(computeScore(reduced, colors), sufficientScore);
  reduced.*member = before.*member;
  EXPECT_EQ(reduced, before) << "others are adjusted as well";
}

/// A later adjustment is used only once all earlier ones have reached their limits.
TEST(TintContrast, AdjustsInOrderAndNoMoreThanNecessary) {
  const auto makeColors = [](const Lab& focus, const Lab& context) {
    return InterfaceColors{toLinear(focus), toLinear(context), 1.0};
  };
  expectLastAdjustment(&ColorAdjustment::contextSaturation, 0.4, muted,
                       makeColors({30.0, 36.0, 22.0}, {49.0, 36.0, 22.0}));
  ColorAdjustment gray = muted;
  gray.contextSaturation = 0.4;
  expectLastAdjustment(&ColorAdjustment::focusLightness, -36.0, gray,
                       makeColors({40.0, 20.0, 14.0}, {55.0, 20.0, 14.0}));
  gray = choose({makeColors({55.0, 2.0, 2.0}, {50.0, 2.0, 2.0})});
  EXPECT_EQ(std::abs(gray.focusLightness), 36.0);
  EXPECT_GT(gray.focusAccent, 0.0);
  EXPECT_LE(gray.focusAccent, 0.6);
}

TEST(TintContrast, DarkFociGetDarkerAndLightFociLighter) {
  const Rgb gray = Rgb::Constant(0.2), light = Rgb::Constant(0.5);
  EXPECT_LT(choose({{gray, light, 1.0}}).focusLightness, 0.0);
  EXPECT_GT(choose({{light, gray, 1.0}}).focusLightness, 0.0);
  EXPECT_EQ(choose({{light, gray, 1.0}}).contextSaturation, muted.contextSaturation)
      << "gray has no saturation to reduce";
}

/// Brighter, it would lose the hue of its accent in an image.
TEST(TintContrast, WhiteFociGetDarker) {
  const ColorAdjustment adjustment =
      choose({{toLinear({84.0, -2.0, 1.0}), toLinear({85.0, 1.0, 17.0}), 1.0}});
  EXPECT_LT(adjustment.focusLightness, -36.0);
  EXPECT_EQ(accentColors[adjustment.accent].name, std::string("blue"));
}

/// A pale organ in dark red would look like muscle.
TEST(TintContrast, AccentsHaveASimilarLightness) {
  const Rgb pale = toLinear({80.0, 2.0, 2.0});
  const ColorAdjustment adjustment = choose({{pale, pale, 1.0}});
  EXPECT_GT(adjustment.focusAccent, 0.0);
  EXPECT_NE(accentColors[adjustment.accent].name, std::string("dark red"));
}

/// Mean colors on both sides of foci in CT of an abdomen and a torso, with the natural library.
TEST(TintContrast, RealFociAreDistinguishable) {
  struct Case {
    const char* name;
    Lab focus, context;
  };
  for (const auto& [name, focus, context] : {
           Case{"spleen", {26.9, 20.3, 4.1}, {66.8, 13.8, 25.6}},
           Case{"liver", {30.0, 20.8, 13.9}, {42.4, 23.0, 17.3}},
           Case{"aorta", {42.1, 36.1, 23.9}, {45.3, 21.5, 17.3}},
           Case{"pancreas", {67.0, 10.7, 23.1}, {58.3, 16.9, 19.0}},
           Case{"kidneys", {35.9, 23.2, 14.8}, {67.3, 13.4, 27.0}},
           Case{"stomach", {61.9, 17.0, 13.8}, {60.5, 15.1, 24.6}},
           Case{"gallbladder", {47.9, -10.7, 19.7}, {45.1, 18.9, 17.0}},
           Case{"duodenum", {61.0, 17.9, 15.9}, {47.4, 21.7, 17.6}},
           Case{"liver of a torso", {30.0, 20.8, 13.9}, {33.0, 25.0, 15.5}},
       }) {
    const InterfaceColors colors{toLinear(focus), toLinear(context), 1.0};
    const Contrast contrast = measureAdjustedContrast(choose({colors}), colors);
    EXPECT_GT(contrast.deltaE[0], 20.0) << name;
    EXPECT_GT(contrast.colorBlind(), 12.0) << name;
    EXPECT_GT(contrast.deltaL, 8.0) << name;
  }
}

/// Images compress the lightness of a focus, and show 26 % of differences of its surroundings. In a
/// groove, these lose 6, which reduces the contrast of a dark focus; in the light, they gain 6,
/// which reduces that of a light focus. A focus that is between them has the typical contrast.
TEST(TintContrast, ModelsShadedAndLitEdges) {
  const auto measure = [](double focus, double context) {
    const Contrast contrast = measureAdjustedContrast(
        {}, {toLinear({focus, 0.0, 0.0}), toLinear({context, 0.0, 0.0}), 1.0});
    EXPECT_NEAR(contrast.deltaE[0], contrast.deltaL, 0.1);
    return contrast.deltaL;
  };
  const auto toFocus = [](double L) { return 16.0 + 1.1 * L - 0.0038 * L * L; };
  EXPECT_NEAR(measure(20.0, 60.0), (51.0 + 0.26 * 60.0 - 6.0) - toFocus(20.0), 1e-3);
  EXPECT_NEAR(measure(90.0, 40.0), toFocus(90.0) - (51.0 + 0.26 * 40.0 + 6.0), 1e-3);
  EXPECT_NEAR(measure(57.0, 50.0), std::abs(toFocus(57.0) - (51.0 + 0.26 * 50.0)), 1e-3);
  const Lab red{30.0, 40.0, 10.0};
  const double chroma = (1.33 - 0.0074 * red.L) * std::hypot(red.a, red.b),
               difference = toFocus(red.L) - (51.0 + 0.26 * 50.0 - 6.0);
  EXPECT_NEAR(
      measureAdjustedContrast({}, {toLinear(red), toLinear({50.0, 0.0, 0.0}), 1.0}).deltaE[0],
      std::hypot(chroma, difference), 0.1);
}

/// Green and red of equal lightness: sufficient for normal vision, not for red-blind viewers.
TEST(TintContrast, ConsidersColorBlindnessAndGrayscalePrints) {
  Contrast contrast{{30.0, 15.0, 15.0, 30.0}, 20.0};
  EXPECT_EQ(contrastScore(contrast), 1.0);
  for (double* value :
       {&contrast.deltaE[0], &contrast.deltaE[1], &contrast.deltaE[2], &contrast.deltaL}) {
    const double before = std::exchange(*value, 1.0);
    EXPECT_LT(contrastScore(contrast), 0.85);
    *value = before;
  }
  const InterfaceColors colors{hexToLinear(0xa06848), hexToLinear(0x608048), 1.0};
  EXPECT_GT(measureAdjustedContrast({}, colors).deltaE[0], 16.0);
  const ColorAdjustment adjustment = choose({colors});
  EXPECT_NE(adjustment, ColorAdjustment());
  const Contrast before = measureAdjustedContrast({}, colors),
                 after = measureAdjustedContrast(adjustment, colors);
  EXPECT_GT(std::min(after.deltaE[1], after.deltaE[2]),
            std::min(before.deltaE[1], before.deltaE[2]));
  EXPECT_GT(after.deltaL, before.deltaL);
}

TEST(TintContrast, ValuesSetByTheUserAreNotAdjusted) {
  const std::vector<InterfaceColors> colors = {{liver, muscle, 1.0}};
  const ColorAdjustment pale = choose(colors, {.saturation = 0.8, .lightness = {}});
  EXPECT_EQ(pale.contextSaturation, 0.8);
  EXPECT_EQ(pale.contextLightness, 0.0);
  const ColorAdjustment light = choose(colors, {.saturation = {}, .lightness = 0.1});
  EXPECT_LT(light.contextSaturation, 1.0);
  EXPECT_EQ(light.contextLightness, 0.1);
  const ColorAdjustment fixed =
      chooseAdjustment(colors, {.saturation = 0.8, .lightness = {}}, Adjustable::nothing);
  EXPECT_EQ(fixed, ColorAdjustment{.contextSaturation = 0.8}) << "nothing else is adjusted";
}

/// The largest part of the interface decides.
TEST(TintContrast, InterfacesAreWeightedByArea) {
  const Lab own = toLab(skin);
  const InterfaceColors dark{skin, toLinear({own.L + 25.0, own.a, own.b}), 1.0},
      light{skin, toLinear({own.L - 25.0, own.a, own.b}), 1.0};
  const auto chooseLightness = [&](double darkArea, double lightArea) {
    InterfaceColors first = dark, second = light;
    first.area = darkArea;
    second.area = lightArea;
    return choose({first, second}).focusLightness;
  };
  EXPECT_LT(chooseLightness(10.0, 1.0), 0.0);
  EXPECT_GT(chooseLightness(1.0, 10.0), 0.0);
}

TEST(TintContrast, ConsidersTheSaturationOfTheContext) {
  const InterfaceColors colors{liver, teal, 1.0},
      gray{liver, toLinear({toLab(teal).L, 0.0, 0.0}), 1.0};
  EXPECT_NEAR(measureAdjustedContrast({.contextSaturation = 0.0}, colors).deltaE[0],
              measureAdjustedContrast({}, gray).deltaE[0], 0.05);
}

// ---- interfaces

/// Cube of 6^3 voxels (component 1, scalar 20). Its neighbors are component 2 beyond it in x
/// (scalar 30), and elsewhere the rest (scalar 10). Voxels of 1 x 2 x 4 mm.
class InterfaceTests : public ::testing::Test {
protected:
  static constexpr std::int64_t edge = 16, low = 5, high = 11;

  static bool isCube(const Size3& v) { return v.minCoeff() >= low && v.maxCoeff() < high; }

  Mask makeMask(const auto& isInside) const {
    Mask mask{
        grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxelCount())), 0, {"part"}};
    Size3 v;
    std::size_t i = 0;
    for (v[2] = 0; v[2] < edge; ++v[2])
      for (v[1] = 0; v[1] < edge; ++v[1])
        for (v[0] = 0; v[0] < edge; ++v[0], ++i)
          mask.count += mask.voxels[i] = isInside(v);
    return mask;
  }
  std::vector<ComponentInterface> measureInterfaces(const TransferFunction& transfer) const {
    const Volume volume = makeVolume<float>(grid, [](const Vec3& index) {
      const Size3 v = index.array().round().cast<std::int64_t>();
      return isCube(v) ? 20.0 : v.x() >= high ? 30.0 : 10.0;
    });
    const LabelWeights weights =
        makeLabelWeights({{makeMask(isCube), 10, 1},
                          {makeMask([](const Size3& v) { return v.x() >= high; }), 10, 2}});
    return findInterfaces(makeMask(isCube), volume, transfer, weights, {false, true, false});
  }

  const Grid grid = makeCenteredGrid({edge, edge, edge}, Vec3(1.0, 2.0, 4.0));
  const TransferFunction all{ScalarFunction({makeKnot(0.0, 1.0)}), ColorFunction({{0.0, skin}})};
};

TEST_F(InterfaceTests, AreasAreInSquareMillimeters) {
  const std::vector<ComponentInterface> found = measureInterfaces(all);
  ASSERT_EQ(found.size(), 2U);
  const double x = 36 * 8.0, y = 36 * 4.0, z = 36 * 2.0;
  EXPECT_EQ(found[0].context, 0);
  EXPECT_NEAR(found[0].area, x + 2.0 * y + 2.0 * z, 1e-6);
  EXPECT_EQ(found[1].context, 2);
  EXPECT_NEAR(found[1].area, x, 1e-6);
  for (const ComponentInterface& interface : found) {
    EXPECT_EQ(interface.focus, 1);
    EXPECT_EQ(interface.focusScalar, 20.0);
  }
  EXPECT_EQ(found[0].contextScalar, 10.0);
  EXPECT_EQ(found[1].contextScalar, 30.0);
}

TEST_F(InterfaceTests, TransparentMediaAreNoNeighbors) {
  TransferFunction transfer = all;
  transfer.extinction = ScalarFunction({makeKnot(10.0, 0.0), makeKnot(20.0, 1.0)});
  const std::vector<ComponentInterface> found = measureInterfaces(transfer);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].context, 2);
}

/// A neighbor with less than a twentieth of the area does not affect the adjustment.
TEST_F(InterfaceTests, SmallOnesAreIgnored) {
  const TintPlan plan{.parts = {},
                      .components = {{}, {}, {}},
                      .names = {"the rest", "focus", "neighbor"},
                      .isFocus = {false, true, false}};
  Tint tint{nullptr, {}};
  for (const Rgb& color : {bone, spleen, spleen})
    tint.albedo.emplace_back(toAlbedo(ColorFunction({{0.0, color}}), 0.0));
  MaterialTable table;
  table.hasContrast = true;
  const auto at = [&](double area) {
    return adjustContrast({{1, 0, 100.0, 0.0, 0.0}, {1, 2, area, 0.0, 0.0}}, plan, tint, table,
                          all);
  };
  EXPECT_EQ(at(4.0).adjustment, muted);
  EXPECT_EQ(at(4.0).neighbor, "the rest");
  EXPECT_NE(at(6.0).adjustment, muted);
  EXPECT_EQ(at(6.0).segment, "focus");
  EXPECT_EQ(at(6.0).neighbor, "neighbor");
  EXPECT_FALSE(adjustContrast({}, plan, tint, table, all).contrast);

  Tint unknown = tint;
  unknown.albedo[1].reset();
  const ColorAdjustment adjustment =
      adjustContrast({{1, 2, 10.0, 0.0, 0.0}}, plan, unknown, table, all).adjustment;
  EXPECT_EQ(adjustFocus(skin, adjustment).matrix(), adjustFocus(skin, {}).matrix())
      << "a focus of unknown material keeps its color";
  EXPECT_LT(chooseAdjustment({{skin, skin, 1.0}}, {}, Adjustable::context).contextSaturation, 0.5);

  const Tint adjusted = applyAdjustment(tint, plan, {.contextSaturation = 0.0}, all);
  const auto chroma = [&](std::size_t i) {
    const Lab lab = toLab(toReflectance(Rgb((*adjusted.albedo[i])(0.0)), 0.0));
    return std::hypot(lab.a, lab.b);
  };
  EXPECT_LT(chroma(0), 0.5);
  EXPECT_GT(chroma(1), 10.0) << "the focus keeps its chroma";
  EXPECT_LT(chroma(2), 0.5);
}

/// The volume's own colors are functions of the scalar; the adjustment changes all their knots.
TEST_F(InterfaceTests, VolumeColorsAreAdjusted) {
  TransferFunction transfer = all;
  transfer.albedo = ColorFunction({{0.0, toAlbedo(skin, 0.0)}, {9.0, toAlbedo(liver, 0.0)}});
  const TintPlan plan{.parts = {}, .components = {{}}, .names = {"the rest"}, .isFocus = {false}};
  const Tint own{nullptr, {std::nullopt}};
  EXPECT_FALSE(applyAdjustment(own, plan, {}, transfer).albedo[0]);
  const ColorAdjustment adjustment{.contextSaturation = 0.5, .contextLightness = 0.2};
  const Tint adjusted = applyAdjustment(own, plan, adjustment, transfer);
  for (const auto& [scalar, color] : {std::pair(0.0, skin), std::pair(9.0, liver)})
    EXPECT_LT(
        (toReflectance(Rgb((*adjusted.albedo[0])(scalar)), 0.0) - adjustContext(color, adjustment))
            .abs()
            .maxCoeff(),
        1e-3);
}

} // namespace
} // namespace fenestra::core::testing::TintContrastTests
