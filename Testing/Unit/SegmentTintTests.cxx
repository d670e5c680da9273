// Components of segments and their materials, as a tint and as a mixture; refused requests.

#include "model/medium/Reflectance.h"
#include "scene/Contrast.h"
#include "scene/SegmentTint.h"

#include "Refusals.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fenestra::core::SegmentTintTests {
namespace {

/// Labelmap of one row with one voxel per segment: value i + 1 at voxel 2 i + 2. The segment
/// "empty" has no voxel.
Handle<SegmentsInput> makeRow(const std::vector<std::string>& names) {
  std::vector<SegmentInfo> segments;
  LargeArray<std::uint8_t> labels(2 * names.size() + 3);
  for (std::size_t i = 0; i < names.size(); ++i) {
    segments.push_back({.id = "id" + std::to_string(i),
                        .name = names[i],
                        .labelValue = static_cast<std::int32_t>(i + 1)});
    if (names[i] != "empty")
      labels[2 * i + 2] = static_cast<std::uint8_t>(i + 1);
  }
  const Grid grid(Size3(static_cast<std::int64_t>(labels.size()), 1, 1), Affine::Identity());
  return std::make_shared<SegmentsInput>(
      SegmentsInput{Segmentation("row.seg.nrrd", grid, 1, labels, segments)});
}

Handle<NamedMaterials> makeMaterials(const std::string& json) {
  return std::make_shared<NamedMaterials>(
      NamedMaterials{parseMaterials(json, "m.json", findMaterials("library").table), "m.json"});
}

const Handle<NamedMaterials> library = std::make_shared<NamedMaterials>(findMaterials("library"));
const Handle<NamedMaterials> contrast = std::make_shared<NamedMaterials>(findMaterials("contrast"));

TintPlan makePlan(const Handle<SegmentsInput>& segments, const Handle<NamedMaterials>& materials,
                  const std::vector<std::string>& changes = {},
                  const std::vector<std::string>& focus = {}, const Handle<Mask>& skin = {},
                  const TransparentFocus& transparent = {}) {
  const auto isNonEmpty = std::make_shared<std::vector<bool>>(findNonEmpty(segments));
  return makeTintPlan(segments, isNonEmpty, materials, changes, focus, skin,
                      std::make_shared<TransparentFocus>(transparent));
}

using Parts = std::vector<TintPart>; ///< each: segments, priority, component; is it the focus?

TEST(SegmentTint, MakesOnePartPerColorAndPriority) {
  const auto segments = makeRow({"kidney_left", "empty", "aorta", "kidney_right", "body_trunc"});
  const TintPlan plan = makePlan(segments, library, {});
  EXPECT_EQ(plan.components.size(), 3U) << "the volume's own color, kidney, artery";
  EXPECT_EQ(plan.parts, (Parts{{{2}, 15, 1}, {{0, 3}, 10, 2}}))
      << "the body keeps the volume's own color and overrides no segment";
  const TintPlan raised = makePlan(segments, library, {"aorta: priority=3"});
  EXPECT_EQ(raised.parts, (Parts{{{4}, 5, 0}, {{2}, 3, 1}, {{0, 3}, 10, 2}}))
      << "the body overrides the aorta where both overlap";
}

TEST(SegmentTint, DoesNotDependOnTheOrderInTheFile) {
  const TintPlan one = makePlan(makeRow({"spleen", "aorta", "liver"}), contrast, {}, {"liver"}),
                 other = makePlan(makeRow({"liver", "spleen", "aorta"}), contrast, {}, {"liver"});
  EXPECT_EQ(one.names, other.names);
  EXPECT_EQ(one.isFocus, other.isFocus);
}

TEST(SegmentTint, ChangedSegmentGetsItsOwnComponent) {
  const auto segments = makeRow({"kidney_left", "kidney_right", "spleen"});
  const TintPlan red = makePlan(segments, library, {"kidney_left: color=#ff0000"});
  EXPECT_EQ(red.parts, (Parts{{{0}, 10, 1}, {{1}, 10, 2}, {{2}, 10, 3}}));
  const TintPlan blue =
      makePlan(segments, library, {"id0: color=#ff0000", "1: color=#0000ff, priority=12"});
  EXPECT_EQ(blue.parts, (Parts{{{0}, 12, 1}, {{1}, 10, 2}, {{2}, 10, 3}}));
  EXPECT_EQ(blue.components[1].material.color->knots()[0].value.z(), 1.0);
  const TintPlan same = makePlan(segments, library, {"spleen: material=kidney"});
  EXPECT_EQ(same.parts, (Parts{{{0, 1, 2}, 10, 1}}));
}

/// With contrast adjustment, the focus has its own components, even if a context segment or the
/// rest has the same color.
TEST(SegmentTint, FocusIsSeparateIfContrastIsAdjusted) {
  const auto segments = makeRow({"kidney_left", "kidney_right", "aorta", "body", "Thing"});
  const TintPlan one = makePlan(segments, contrast, {}, {"kidney_right"});
  EXPECT_EQ(one.names,
            (std::vector<std::string>{"the rest", "aorta", "kidney_left", "kidney_right"}));
  EXPECT_EQ(one.isFocus, (std::vector<bool>{false, false, false, true}));
  EXPECT_EQ(one.parts, (Parts{{{4}, 10, 0}, {{2}, 15, 1}, {{0}, 10, 2}, {{1}, 15, 3, true}}))
      << "the focus is not overridden by the aorta, which excludes it";
  const TintPlan both = makePlan(segments, contrast, {}, {"1", "body", "id1"});
  EXPECT_EQ(both.names, (std::vector<std::string>{"the rest", "aorta", "body", "kidney"}));
  EXPECT_EQ(both.isFocus, (std::vector<bool>{false, false, true, true}));
  EXPECT_FALSE(both.components[2].material.color) << "the volume's own color";
  EXPECT_EQ(makePlan(segments, library, {}, {"aorta"}).isFocus, std::vector<bool>(4, false));
}

/// The library gives segments with unknown names palette colors, but not around a focus, with which
/// they would compete.
TEST(SegmentTint, OnlyKnownSegmentsHaveColorsAroundAFocus) {
  const auto segments = makeRow({"liver", "Thing", "Other"});
  EXPECT_EQ(makePlan(segments, library).components.size(), 4U);
  EXPECT_EQ(makePlan(segments, contrast).components.size(), 2U);
  const Handle<NamedMaterials> muted =
      std::make_shared<NamedMaterials>(findMaterials("library", defaultContextSaturation));
  EXPECT_EQ(makePlan(segments, muted, {}, {"liver"}).components.size(), 2U);
  const TintPlan requested = makePlan(segments, contrast, {"Thing: color=#00ff00"});
  EXPECT_EQ(requested.components.size(), 3U);
}

TEST(SegmentTint, RestColorsVoxelsOutsideAllSegments) {
  const auto segments = makeRow({"liver", "body"});
  const TintPlan plan =
      makePlan(segments, makeMaterials(R"({"version": 1, "materials": {"red": {"color": "#ff0000"}},
                              "rest": {"material": "red"}})"),
               {});
  ASSERT_EQ(plan.components.size(), 3U);
  EXPECT_EQ(plan.components[0].material.color->knots()[0].value.x(), 1.0);
  EXPECT_FALSE(plan.components[1].material.color) << "the body keeps the volume's own color";
  const TintPlan bodyOnly = makePlan(makeRow({"body"}), library, {});
  EXPECT_EQ(bodyOnly.parts, (Parts{{{0}, 5, 0}})) << "one part, without a color";
}

/// Segments of one color get separate components if their media differ; empty segments get none.
TEST(SegmentTint, DifferentMediaMakeAMixture) {
  const auto segments = makeRow({"kidney_left", "kidney_right", "spleen", "empty"});
  EXPECT_TRUE(isTintOnly(makePlan(segments, library)));
  EXPECT_TRUE(isTintOnly(makePlan(segments, library, {"empty: density=2"})));
  for (const char* change : {"kidney_right: clip=no", "kidney_right: density=2",
                             "kidney_right: extinction=2", "kidney_right: kind=matter"}) {
    const TintPlan plan = makePlan(segments, library, {change});
    EXPECT_FALSE(isTintOnly(plan)) << change;
    EXPECT_EQ(plan.parts, (Parts{{{0}, 10, 1}, {{1}, 10, 2}, {{2}, 10, 3}})) << change;
  }
  EXPECT_EQ(makePlan(segments, library, {"id0: density=2", "id1: density=3"}).parts.size(), 3U);
  EXPECT_EQ(makePlan(segments, library, {"id0: density=2", "id1: density=2"}).parts,
            (Parts{{{0, 1}, 10, 1}, {{2}, 10, 2}}));
}

TEST(SegmentTint, MixturesHaveTheMediaOfTheirMaterials) {
  const auto segments = makeRow({"kidney_left", "kidney_right", "liver", "spleen"});
  TransferFunction own{
      ScalarFunction({{0.0, ScalarFunction::Value(0.0)}, {100.0, ScalarFunction::Value(2.0)}}),
      ColorFunction({{0.0, Rgb(0.3, 0.4, 0.5)}})};
  own.g = 0.3;
  own.gradientOpacity = own.extinction;
  own.shading = SurfaceShading{0.8, 0.3, 12.0, 0.7};
  const auto plan = std::make_shared<TintPlan>(
      makePlan(segments, library,
               {"kidney_left: density=3", "kidney_right: clip=no",
                "spleen: color=#808080, extinction=1.5, g=0.6, specular=0.4, roughness=0.25, "
                "diffuse=0.7, border=0.5",
                "liver: kind=matter"}));
  const auto weights = std::make_shared<LabelWeights>(
      computeLabelWeights(segments, plan->parts, {}, 0.0, segments->segmentation.grid()));
  const Mixture mixture =
      buildMixture(*plan, *std::make_shared<Tint>(buildTint(plan, weights, own.g)), own);
  ASSERT_EQ(mixture.components.size(), 5U);
  EXPECT_TRUE(mixture.hasUnclipped());
  const auto evalExtinction = [&](std::size_t i, double scalar) {
    return mixture.components[i].transfer.extinction(scalar).value();
  };
  EXPECT_EQ(evalExtinction(0, 50.0), 1.0);
  EXPECT_EQ(mixture.components[0].transfer.albedo(50.0).matrix(), Vec3(0.3, 0.4, 0.5));
  EXPECT_EQ(evalExtinction(1, 50.0), 3.0);
  EXPECT_EQ(evalExtinction(2, 50.0), 1.0);
  EXPECT_FALSE(mixture.components[2].isClipped);
  EXPECT_TRUE(mixture.components[1].isClipped);
  EXPECT_EQ(mixture.components[2].transfer.g, 0.3) << "a tint keeps the volume's phase function";

  const Component& spleen = mixture.components[4];
  EXPECT_EQ(evalExtinction(4, -500.0), 1.5);
  EXPECT_EQ(evalExtinction(3, 50.0), 1.0) << "the volume's";
  EXPECT_FALSE(spleen.transfer.gradientOpacity) << "it applies to the volume's extinction only";
  EXPECT_TRUE(mixture.components[3].transfer.gradientOpacity);
  EXPECT_EQ(spleen.transfer.g, 0.6);
  EXPECT_EQ(spleen.interfaceWeight, 0.5);
  const double gray = decodeSrgb(Rgb::Constant(128.0 / 255.0)).x();
  EXPECT_NEAR(toReflectance(spleen.transfer.albedo(0.0).x(), 0.6), gray, 1e-3);
  EXPECT_EQ(spleen.transfer.shading->diffuse, 0.7);
  EXPECT_EQ(spleen.transfer.shading->specular, 0.4);
  EXPECT_EQ(spleen.transfer.shading->gamma, 0.7) << "the volume's";
  EXPECT_TRUE(spleen.transfer.shading->coated);

  own.shading.reset();
  for (const Component& component :
       buildMixture(*plan, buildTint(plan, weights, own.g), own).components)
    EXPECT_FALSE(component.transfer.shading) << "the volume has none";
}

/// Lungs become bodies with the color of their median, others remain tints. A segment without a
/// color has none to show, and --material overrides.
TEST(SegmentTint, TransparentFocusIsSolid) {
  const auto segments = makeRow({"lung_left", "lung_right", "torso", "liver"});
  const TransparentFocus transparent = {{0, -850.0}, {1, -700.0}, {2, -900.0}};
  const auto makeSolid = [&](const std::vector<std::string>& changes) {
    return makePlan(segments, library, changes, {}, {}, transparent);
  };
  const TintPlan plan = makeSolid({});
  ASSERT_EQ(plan.components.size(), 4U);
  const ColorFunction& color = *library->table.materials.at("lung").color;
  const auto expectSolid = [&](std::size_t component, double median) {
    const Material& lung = plan.components[component].material;
    EXPECT_EQ(lung.kind, MaterialKind::medium);
    for (const double scalar : {-1000.0, 0.0, 500.0}) {
      EXPECT_EQ((*lung.color)(scalar).matrix(), color(median).matrix());
      EXPECT_GT((*lung.extinction)(scalar).value(), 1.0);
    }
  };
  EXPECT_EQ(plan.components[1].material.kind, MaterialKind::tint) << "liver";
  expectSolid(2, -850.0);
  expectSolid(3, -700.0);
  EXPECT_TRUE(isTintOnly(makeSolid({"lung_left: material=lung", "lung_right: material=lung"})));
}

TEST(SegmentTint, RefusesInvalidRequests) {
  const auto segments = makeRow({"liver", "empty"});
  expectRefused("row.seg.nrrd", "unknown-name | \"live\" | liver",
                [&] { makePlan(segments, library, {"live: color=#ffffff"}); });
  expectRefused("row.seg.nrrd", "no-voxel-to-color",
                [&] { makePlan(makeRow({"empty"}), library, {}); });
  const auto refuseTable = [&](const std::string& members, const std::string& text) {
    const auto table = makeMaterials(R"({"version": 1, )" + members + "}");
    expectRefused("m.json", text, [&] { makePlan(segments, table, {}); });
  };
  refuseTable(R"("context": {"saturation": 0.5})", "focus-required: context");
  refuseTable(R"("context": {"lightness": 0})", "focus-required: context");
}

TEST(SegmentTint, RefusesMoreThan255Materials) {
  std::vector<SegmentInfo> segments;
  LargeArray<std::int16_t> labels;
  for (int i = 0; i < 256; ++i) {
    labels.push_back(static_cast<std::int16_t>(i + 1));
    segments.push_back({.id = std::to_string(i),
                        .name = "thing",
                        .labelValue = i + 1,
                        .color = Rgb(i / 255.0, 0.2, 0.3)});
  }
  const auto makeInput = [&](std::size_t count) {
    segments.resize(count);
    return std::make_shared<SegmentsInput>(SegmentsInput{
        Segmentation("s.nrrd", Grid(Size3(256, 1, 1), Affine::Identity()), 1, labels, segments)});
  };
  expectRefused("s.nrrd", "too-many-materials | 255",
                [&] { makePlan(makeInput(256), library, {}); });
  EXPECT_EQ(makePlan(makeInput(255), library, {}).components.size(), 256U);
}

TEST(SegmentTint, WeightsAndColorsMatchTheLabels) {
  const auto segments = makeRow({"liver", "spleen"});
  const auto plan = std::make_shared<TintPlan>(makePlan(segments, library, {}));
  const Grid& grid = segments->segmentation.grid();
  const auto weights =
      std::make_shared<LabelWeights>(computeLabelWeights(segments, plan->parts, {}, 0.0, grid));
  const Rgb own(0.1, 0.2, 0.3);
  for (const double g : {0.0, 0.5}) {
    const Tint tint = buildTint(plan, weights, g);
    const TintField field(tint, grid);
    const auto measureColor = [&](double x) {
      return Rgb(field.albedo(Vec3(x, 0, 0), 7.0, own).unaryExpr([g](double albedo) {
        return toReflectance(albedo, g);
      }));
    };
    for (const std::size_t i : {0U, 1U}) {
      const Rgb expected = (*plan->components[i + 1].material.color)(7.0);
      EXPECT_LT((measureColor(2.0 * static_cast<double>(i) + 2.0) - expected).abs().maxCoeff(),
                1e-3);
    }
    EXPECT_EQ(field.albedo(Vec3(3, 0, 0), 7.0, own).matrix(), own.matrix());
    const Rgb half = 0.5 * (own + field.albedo(Vec3(2, 0, 0), 7.0, own));
    EXPECT_LT((field.albedo(Vec3(2.5, 0, 0), 7.0, own) - half).abs().maxCoeff(), 1e-12);
    const double ratio = std::pow(0.6 / 0.4, 16.0);
    const Rgb most = (ratio * field.albedo(Vec3(2, 0, 0), 7.0, own) + own) / (ratio + 1.0);
    EXPECT_LT((field.albedo(Vec3(2.4, 0, 0), 7.0, own) - most).abs().maxCoeff(), 1e-12);
  }
  const auto sumLiverWeight = [&](const std::vector<TintPart>& parts) {
    const LabelWeights smooth = computeLabelWeights(segments, parts, {}, 1.0, grid);
    double liver = 0.0;
    smooth.forEachWeight(
        smooth.grid().worldToIndex * Vec3(2, 0, 0),
        [&](std::uint8_t component, double weight) { liver += component == 1 ? weight : 0.0; });
    return liver;
  };
  const double liver = sumLiverWeight(plan->parts);
  EXPECT_GT(liver, 0.0);
  EXPECT_LT(liver, 0.5) << "smoothing as requested";
}

/// A vein of higher priority beside a vertebra, as 2 x 8 x 8 voxels each: the last of the
/// vertebra's voxels has hardly any of the vein's color.
TEST(SegmentTint, FocusHasItsOwnColorBesideASegmentOfHigherPriority) {
  const Grid grid(Size3(8, 8, 8), Affine::Identity());
  LargeArray<std::uint8_t> labels(512);
  for (std::size_t i = 0; i < 512; ++i)
    labels[i] = static_cast<std::uint8_t>(i % 8 / 2 % 3);
  const std::vector<SegmentInfo> segments{
      {.id = "a", .name = "vertebrae_L4", .labelValue = 1},
      {.id = "b", .name = "inferior_vena_cava", .labelValue = 2}};
  const auto input = std::make_shared<SegmentsInput>(
      SegmentsInput{Segmentation("two.seg.nrrd", grid, 1, labels, segments)});
  const auto plan = std::make_shared<TintPlan>(makePlan(input, contrast, {}, {"vertebrae_L4"}));
  const auto weights =
      std::make_shared<LabelWeights>(computeLabelWeights(input, plan->parts, {}, 1.0, grid));
  const auto find = [&](const char* name) {
    return static_cast<std::size_t>(std::ranges::find(plan->names, name) - plan->names.begin());
  };
  Tint black{weights,
             {std::vector<std::optional<ColorFunction>>(plan->names.size(),
                                                        ColorFunction({{0.0, Rgb::Zero()}}))}};
  black.albedo[find("inferior_vena_cava")] = ColorFunction({{0.0, Rgb::Ones()}});
  EXPECT_LT(TintField(black, grid).albedo(Vec3(3, 4, 4), 0.0, Rgb::Zero()).maxCoeff(), 0.05);
}

/// Name of the only component in a voxel of two segments, which are in different layers.
std::string findOverlapColor(const char* one, const char* other, const char* focus) {
  const Grid grid(Size3(3, 1, 1), Affine::Identity());
  const std::array<std::uint8_t, 6> layers = {1, 0, 1, 2, 0, 2};
  LargeArray<std::uint8_t> labels(layers.size());
  std::ranges::copy(layers, labels.begin());
  const std::vector<SegmentInfo> segments{{.id = "a", .name = one, .labelValue = 1},
                                          {.id = "b", .name = other, .labelValue = 2, .layer = 1}};
  const auto input = std::make_shared<SegmentsInput>(
      SegmentsInput{Segmentation("two.seg.nrrd", grid, 2, labels, segments)});
  const TintPlan plan = makePlan(input, contrast, {}, {focus});
  const LabelWeights weights = computeLabelWeights(input, plan.parts, {}, 0.0, grid);
  std::string name;
  weights.forEachWeight(weights.grid().worldToIndex * Vec3(1, 0, 0),
                        [&](std::uint8_t component, double weight) {
                          EXPECT_EQ(weight, 1.0);
                          name = plan.names[component];
                        });
  return name;
}

TEST(SegmentTint, FocusHasItsOwnColorWhereSegmentsOverlap) {
  EXPECT_EQ(findOverlapColor("liver", "spleen", "liver"), "liver");
  EXPECT_EQ(findOverlapColor("liver", "spleen", "spleen"), "spleen");
  EXPECT_EQ(findOverlapColor("vertebrae_L4", "inferior_vena_cava", "vertebrae_L4"),
            "inferior_vena_cava")
      << "of higher priority, and in another layer: it may lie inside the focus";
}

/// Mask of detected skin: the first voxel of the row.
Handle<Mask> makeSkin(const Grid& grid) {
  Mask skin{
      grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxelCount())), 1, {}, 255};
  skin.voxels[0] = 255;
  return std::make_shared<Mask>(skin);
}

TEST(SegmentTint, DetectedSkinIsAPartWithoutSegment) {
  const auto segments = makeRow({"liver", "spleen"});
  const Grid& grid = segments->segmentation.grid();
  const TintPlan plan = makePlan(segments, contrast, {}, {"liver"}, makeSkin(grid));
  EXPECT_EQ(plan.parts, (Parts{{{0}, 10, 1, true}, {{1}, 10, 2}, {{}, 1, 3}}));
  EXPECT_EQ(plan.names.back(), "skin");
  EXPECT_TRUE(plan.hasDetectedSkin());
  const LabelWeights weights = computeLabelWeights(segments, plan.parts, makeSkin(grid), 0.0, grid);
  const auto sumSkinWeight = [&](double x) {
    double skin = 0.0;
    weights.forEachWeight(
        weights.grid().worldToIndex * Vec3(x, 0, 0),
        [&](std::uint8_t component, double weight) { skin += component == 3 ? weight : 0.0; });
    return skin;
  };
  EXPECT_EQ(sumSkinWeight(0.0), 1.0);
  EXPECT_NEAR(sumSkinWeight(0.25), 0.75, 0.01);
  EXPECT_EQ(sumSkinWeight(1.0), 0.0);

  EXPECT_FALSE(
      makePlan(segments, contrast, {}, {"liver"}, std::make_shared<Mask>()).hasDetectedSkin());
  EXPECT_FALSE(makePlan(segments, contrast, {}, {"liver"}).hasDetectedSkin());
  EXPECT_FALSE(makePlan(makeRow({"liver", "skin"}), contrast, {}, {"liver"}, makeSkin(grid))
                   .hasDetectedSkin());
  EXPECT_TRUE(makePlan(makeRow({"body"}), contrast, {}, {}, makeSkin(grid)).hasDetectedSkin());
}

TEST(SegmentTint, AlbedoIsUsedUnchanged) {
  const auto segments = makeRow({"liver"});
  const auto plan = std::make_shared<TintPlan>(makePlan(
      segments,
      makeMaterials(R"({"version": 1, "materials": {"liver": {"albedo": [0.5, 0.6, 0.7]}}})"), {}));
  const auto weights = std::make_shared<LabelWeights>(
      computeLabelWeights(segments, plan->parts, {}, 0.0, segments->segmentation.grid()));
  EXPECT_EQ((*buildTint(plan, weights, 0.3).albedo[1])(0.0).matrix(), Vec3(0.5, 0.6, 0.7));
}

} // namespace
} // namespace fenestra::core::SegmentTintTests
