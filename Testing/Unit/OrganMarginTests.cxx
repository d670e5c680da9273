// Organ margins, on an ellipsoid between fat and lung with partial volume, noise and lesions.

#include "base/Random.h"
#include "model/masks/OrganMargin.h"
#include "scene/PreparedScene.h"

#include "ClippingTesting.h"
#include "MedicalFiles.h"

#include <gtest/gtest.h>

namespace fenestra::core::OrganMarginTests {
using namespace testing_clipping;

namespace {

constexpr double organ = 60.0, fat = -100.0, lung = -850.0; // HU
const Vec3 radii(38.0, 30.0, 32.0);                         // mm

/// Signed distance to the ellipsoid's surface, approximately, mm; negative inside.
double computeDistance(const Vec3& p) {
  const Vec3 scaled = p.cwiseQuotient(radii);
  return (scaled.norm() - 1.0) * scaled.norm() / std::max(scaled.cwiseQuotient(radii).norm(), 1e-9);
}

/// Fraction of a voxel inside an edge at a signed distance, blurred by the scanner.
double computeFraction(double distance) {
  return 0.5 * std::erfc(distance / std::sqrt(2.0)); // standard deviation 1 mm
}

struct Lesion {
  Vec3 center;
  double diameter, value; ///< mm, HU

  double distance(const Vec3& p) const { return (p - center).norm() - 0.5 * diameter; }
};

struct Phantom {
  Mask label; ///< on the half x > 0 it reaches 1.5 mm too far
  Volume volume;
};

/// `noise`: HU. The label includes what protrudes of the lesion, unless it ends at the capsule.
Phantom makePhantom(double noise, const std::optional<Lesion>& lesion = {}, double scale = 1.0,
                    bool endsAtCapsule = false) {
  const Grid grid = makeCenteredGrid({62, 54, 56}, scale * Vec3(1.5, 1.5, 1.5));
  Phantom phantom{makeMask(grid,
                           [&](const Vec3& p) {
                             return computeDistance(p / scale) < (p.x() > 0.0 ? 1.5 : 0.0) ||
                                    (lesion && !endsAtCapsule && lesion->distance(p) < 0.0);
                           }),
                  {}};
  phantom.volume.grid = grid;
  Random random(7);
  LargeArray<std::int16_t> voxels;
  for (std::int64_t i = 0; i < grid.voxelCount(); ++i) {
    const Size3 voxel(i % grid.size.x(), i / grid.size.x() % grid.size.y(),
                      i / (grid.size.x() * grid.size.y()));
    const Vec3 p = grid.indexToWorld * voxel.cast<double>();
    const double inside = computeFraction(computeDistance(p / scale));
    double value = inside * organ + (1.0 - inside) * (p.z() > 0.0 ? lung : fat);
    if (lesion)
      value += computeFraction(lesion->distance(p)) * (lesion->value - value);
    double sum = -6.0; // of twelve uniform numbers: nearly normal
    for (int k = 0; k < 12; ++k)
      sum += random.uniform();
    voxels.push_back(static_cast<std::int16_t>(std::lround(value + noise * sum)));
  }
  phantom.volume.voxels = std::move(voxels);
  computeRange(phantom.volume);
  return phantom;
}

/// Sets the volume to a value, HU, at the points where isWithin(point).
void fillWhere(Phantom& phantom, std::int16_t value, const auto& isWithin) {
  const Mask within = makeMask(phantom.volume.grid, isWithin);
  auto& voxels = std::get<LargeArray<std::int16_t>>(phantom.volume.voxels);
  for (std::size_t i = 0; i < voxels.size(); ++i)
    if (within.voxels[i])
      voxels[i] = value;
}

/// Fraction of the voxels with a face on the mask's surface in which the organ is less than half.
double computeForeignSurface(const Mask& mask, double scale = 1.0) {
  double foreign = 0.0, all = 0.0;
  const Size3& size = mask.grid.size;
  const std::array<std::int64_t, 3> steps = {1, size.x(), size.x() * size.y()};
  for (std::int64_t i = 0; i < mask.grid.voxelCount(); ++i) {
    const auto at = [&](std::int64_t j) { return mask.voxels[static_cast<std::size_t>(j)]; };
    if (!at(i) ||
        std::ranges::all_of(steps, [&](auto step) { return at(i - step) && at(i + step); }))
      continue;
    const Size3 voxel(i % size.x(), i / size.x() % size.y(), i / steps[2]);
    foreign += computeDistance(mask.grid.indexToWorld * voxel.cast<double>() / scale) > 0.0;
    all += 1.0;
  }
  return foreign / all;
}

/// Fraction of a lesion's labeled voxels that the margin removes.
double computeLoss(const Phantom& phantom, const Lesion& lesion) {
  const OrganMargin margin = findOrganMargin(phantom.label, phantom.volume);
  EXPECT_TRUE(margin.isApplied);
  double lost = 0.0, all = 0.0;
  const Mask body =
      makeMask(phantom.label.grid, [&](const Vec3& p) { return lesion.distance(p) < 0.0; });
  for (std::size_t i = 0; i < body.voxels.size(); ++i)
    if (body.voxels[i] && phantom.label.voxels[i]) {
      all += 1.0;
      lost += !margin.kept.voxels[i];
    }
  return lost / all;
}

TEST(OrganMargin, RemovesOtherTissueAndNeverAdds) {
  for (const double noise : {0.0, 10.0, 33.0}) {
    const Phantom phantom = makePhantom(noise);
    const OrganMargin margin = findOrganMargin(phantom.label, phantom.volume);
    ASSERT_TRUE(margin.isApplied) << noise;
    std::int64_t removed = 0;
    for (std::size_t i = 0; i < phantom.label.voxels.size(); ++i) {
      ASSERT_LE(margin.kept.voxels[i], phantom.label.voxels[i]);
      removed += phantom.label.voxels[i] - margin.kept.voxels[i];
    }
    EXPECT_EQ(margin.kept.count, phantom.label.count - removed);
    EXPECT_DOUBLE_EQ(margin.volume, static_cast<double>(removed) * 1.5 * 1.5 * 1.5);
    EXPECT_GT(computeForeignSurface(phantom.label), 0.4);
    EXPECT_LT(computeForeignSurface(margin.kept), 0.02) << noise;
    EXPECT_GT(margin.mean, 0.5) << noise;
    EXPECT_LT(margin.mean, 3.0) << noise;
    EXPECT_GE(margin.p95, 1.5) << noise;
    EXPECT_LT(margin.p95, 5.0) << noise;
  }
}

/// Subcapsular metastases, cysts and calcifications lose at most 5 %.
TEST(OrganMargin, PreservesLesions) {
  const auto expectPreserved = [](double diameter, double depth, double value, double noise) {
    for (const double side : {1.0, -1.0}) {
      const Lesion lesion{{side * (radii.x() - depth), 0.0, -4.0}, diameter, value};
      EXPECT_LE(computeLoss(makePhantom(noise, lesion), lesion), 0.05)
          << diameter << " mm, center at depth " << depth << " mm, " << value << " HU, noise "
          << noise << ", side " << side;
    }
  };
  for (const double depth : {0.0, 5.0, 7.0})
    for (const double noise : {10.0, 33.0})
      for (const double value : {0.0, 400.0})
        expectPreserved(10.0, depth, value, noise);
  expectPreserved(10.0, 5.0, 20.0, 33.0); // as faint as what is still removed
  expectPreserved(20.0, 10.0, 10.0, 33.0);
}

/// Lesions half outside a label that ends at the capsule lose at most 5 % of what it contains.
TEST(OrganMargin, PreservesLesionsAcrossTheCapsule) {
  for (const Vec3& direction :
       {Vec3(0.99, 0.0, -0.14), Vec3(0.3, 0.8, 0.5), Vec3(-0.5, -0.6, -0.6)})
    for (const auto& [value, noise] : {std::pair(0.0, 33.0), std::pair(20.0, 10.0),
                                       std::pair(20.0, 33.0), std::pair(400.0, 33.0)}) {
      const Lesion lesion{direction / direction.cwiseQuotient(radii).norm(), 10.0, value};
      EXPECT_LE(computeLoss(makePhantom(noise, lesion, 1.0, true), lesion), 0.05)
          << value << " HU, noise " << noise << ", " << direction.x();
    }
}

/// A sheet of fluid or partial volume along the surface is removed, but no lesion that touches it.
TEST(OrganMargin, RemovesSheetsAndPreservesLesionsBesideThem) {
  const auto isInSheet = [](const Vec3& p) {
    const double distance = computeDistance(p);
    return p.x() > 0.5 * radii.x() && distance > -3.0 && distance < 1.5;
  };
  constexpr std::int16_t fluid = 5; // HU
  Phantom phantom = makePhantom(10.0);
  fillWhere(phantom, fluid, isInSheet);
  const OrganMargin margin = findOrganMargin(phantom.label, phantom.volume);
  ASSERT_TRUE(margin.isApplied);
  const Mask sheet = makeMask(phantom.label.grid, isInSheet);
  double kept = 0.0;
  for (std::size_t i = 0; i < sheet.voxels.size(); ++i)
    kept += sheet.voxels[i] && margin.kept.voxels[i];
  EXPECT_LT(kept, 0.2 * static_cast<double>(sheet.count));
  for (const double value : {0.0, 400.0}) {
    const Lesion lesion{{radii.x() - 7.0, 0.0, -4.0}, 10.0, value};
    Phantom diseased = makePhantom(10.0, lesion);
    fillWhere(diseased, fluid, isInSheet);
    EXPECT_LE(computeLoss(diseased, lesion), 0.05) << value;
  }
}

TEST(OrganMargin, IsNotAppliedToSmallOrMixedSegments) {
  Phantom small = makePhantom(10.0, {}, 0.3);
  EXPECT_FALSE(findOrganMargin(small.label, small.volume).isApplied) << "nothing is 8 mm deep";
  EXPECT_EQ(findOrganMargin(small.label, small.volume).kept.voxels, small.label.voxels);
  const Phantom coarse = makePhantom(10.0, {}, 2.0); // voxels of 3 mm
  EXPECT_FALSE(findOrganMargin(coarse.label, coarse.volume).isApplied);
  const Phantom mixed = makePhantom(90.0);
  EXPECT_FALSE(findOrganMargin(mixed.label, mixed.volume).isApplied);
  Phantom airy = makePhantom(10.0);
  for (std::int16_t& voxel : std::get<LargeArray<std::int16_t>>(airy.volume.voxels))
    voxel = static_cast<std::int16_t>(voxel - 200);
  EXPECT_FALSE(findOrganMargin(airy.label, airy.volume).isApplied) << "fat";
}

/// A cortex of 3 mm belongs to its bone; ribs over a tenth of an organ do not.
TEST(OrganMargin, BonesRemainWhole) {
  const auto isApplied = [](const auto& isBone) {
    Phantom phantom = makePhantom(10.0);
    fillWhere(phantom, 500, [&](const Vec3& p) {
      const double distance = computeDistance(p);
      return distance > -3.0 && distance < 1.0 && isBone(p);
    });
    return findOrganMargin(phantom.label, phantom.volume).isApplied;
  };
  EXPECT_FALSE(isApplied([](const Vec3&) { return true; }));
  EXPECT_TRUE(isApplied([](const Vec3& p) { return p.x() > 0.9 * radii.x(); }));
}

/// The phantom as a lung at -800 HU, on its side of `fat` in soft tissue.
Phantom makeLung(double noise, const std::optional<Lesion>& lesion = {}) {
  Phantom phantom = makePhantom(noise / 4.0, lesion);
  for (std::int16_t& voxel : std::get<LargeArray<std::int16_t>>(phantom.volume.voxels))
    voxel = static_cast<std::int16_t>(-800.0 + 4.0 * (organ - voxel));
  computeRange(phantom.volume);
  return phantom;
}

TEST(OrganMargin, RemovesTheChestWallFromLungsAndPreservesNodules) {
  for (const double noise : {20.0, 90.0}) {
    const Phantom phantom = makeLung(noise);
    const OrganMargin margin = findOrganMargin(phantom.label, phantom.volume);
    ASSERT_TRUE(margin.isApplied) << noise;
    EXPECT_LT(computeForeignSurface(margin.kept), 0.05) << noise;
    for (const double depth : {0.0, 5.0, 7.0}) {
      const Lesion nodule{{radii.x() - depth, 0.0, -4.0}, 10.0, organ - 210.0}; // 40 HU
      EXPECT_LE(computeLoss(makeLung(noise, nodule), nodule), 0.05) << depth << " " << noise;
    }
  }
}

/// The segment of a phantom with thick voxels, trimmed in halves of them.
Mask trimDivided(const Phantom& phantom) {
  LargeArray<std::uint8_t> labels(phantom.label.voxels.begin(), phantom.label.voxels.end());
  const SegmentsInput segments{
      Segmentation("s", phantom.label.grid, 1, std::move(labels), {{"1", "organ"}})};
  const TrimmedSegments trimmed = trimSegments(
      std::make_shared<SegmentsInput>(segments), std::make_shared<std::vector<bool>>(1, true),
      {"1"}, std::make_shared<VolumeInput>(VolumeInput{phantom.volume, {}}));
  EXPECT_TRUE(trimmed.margins.at(0).isApplied);
  return trimmed.input->segmentation.makeFocusMask({"1"}, phantom.volume.grid);
}

TEST(OrganMargin, IsFoundInHalvesOfThickVoxels) {
  constexpr double scale = 2.0; // voxels of 3 mm
  for (const double noise : {10.0, 33.0}) {
    const Phantom phantom = makePhantom(noise, {}, scale);
    const Mask kept = trimDivided(phantom);
    EXPECT_NEAR(kept.grid.spacing().maxCoeff(), 1.5, 1e-9);
    EXPECT_GT(computeForeignSurface(phantom.label, scale), 0.4);
    EXPECT_LT(computeForeignSurface(kept, scale), 0.02) << noise;
    for (const double value : {0.0, 400.0}) {
      const Lesion lesion{{scale * radii.x() - 7.0, 0.0, -4.0}, 10.0, value};
      const Phantom diseased = makePhantom(noise, lesion, scale);
      const Mask rest = trimDivided(diseased);
      double lost = 0.0, all = 0.0;
      const Mask body =
          makeMask(rest.grid, [&](const Vec3& p) { return lesion.distance(p) < 0.0; });
      for (std::size_t i = 0; i < body.voxels.size(); ++i) {
        all += body.voxels[i];
        lost += body.voxels[i] && !rest.voxels[i];
      }
      EXPECT_LE(lost, 0.05 * all) << noise << " " << value;
    }
  }
}

/// Requests of the phantom in files.
class OrganMarginScene : public ::testing::Test {
protected:
  OrganMarginScene() {
    const Phantom phantom = makePhantom(10.0);
    FileGeometry geometry;
    for (int axis = 0; axis < 3; ++axis) {
      geometry.size[static_cast<std::size_t>(axis)] =
          static_cast<std::size_t>(phantom.label.grid.size[axis]);
      geometry.spacing[static_cast<std::size_t>(axis)] = 1.5;
    }
    std::vector<std::int16_t> voxels(
        std::get<LargeArray<std::int16_t>>(phantom.volume.voxels).begin(),
        std::get<LargeArray<std::int16_t>>(phantom.volume.voxels).end());
    voxels[0] = 900; // bone, as in CT
    writeFile(folder / "ct.nrrd", voxels, geometry);
    for (std::int16_t& voxel : voxels)
      voxel = static_cast<std::int16_t>(voxel + 2000);
    writeFile(folder / "mr.nrrd", voxels, geometry);
    std::ranges::fill(voxels, static_cast<std::int16_t>(organ));
    voxels[0] = 900;
    voxels[1] = -1000;
    writeFile(folder / "uniform.nrrd", voxels, geometry);
    writeFile(folder / "labels.nrrd", phantom.label.voxels, geometry);
    std::vector<std::uint8_t> halves = phantom.label.voxels;
    for (std::size_t i = halves.size() / 2; i < halves.size(); ++i)
      halves[i] = static_cast<std::uint8_t>(2 * halves[i]);
    writeFile(folder / "halves.nrrd", halves, geometry);
    std::vector<std::uint8_t> thirds = phantom.label.voxels; // 1, 3 and 2, along z
    for (std::size_t i = 0; i < thirds.size(); ++i)
      thirds[i] = static_cast<std::uint8_t>(
          thirds[i] * std::array{1, 3, 2}[std::min<std::size_t>(2, 3 * i / thirds.size())]);
    writeFile(folder / "thirds.nrrd", thirds, geometry);
    count = phantom.label.count;
    request.input = folder / "ct.nrrd";
    request.segmentation = folder / "labels.nrrd";
    request.focus = {"1"};
    request.materials = "library";
    request.materialChanges = {"1: color=#ff0000"};
    request.focusStyle.shaping.smoothing = 0.0;
    request.focusStyle.hasOrganMargin = true;
    request.width = request.height = 8;
  }

  TemporaryFolder folder;
  RenderRequest request;
  std::int64_t count = 0;
};

/// Without smoothing, the tint covers exactly the voxels of the focus.
TEST_F(OrganMarginScene, TrimsFocusAndTint) {
  const PreparedScene trimmed(request);
  ASSERT_EQ(trimmed.margins().size(), 1U);
  EXPECT_TRUE(trimmed.margins()[0].isApplied);
  EXPECT_LT(trimmed.focus()->count, count);
  EXPECT_DOUBLE_EQ(trimmed.margins()[0].volume,
                   static_cast<double>(count - trimmed.focus()->count) * 1.5 * 1.5 * 1.5);
  const Grid& grid = trimmed.focus()->grid;
  ASSERT_TRUE(trimmed.tint());
  const LabelWeights& weights = *trimmed.tint()->weights;
  std::int64_t differences = 0;
  for (std::int64_t i = 0; i < grid.voxelCount(); ++i) {
    const Size3 voxel(i % grid.size.x(), i / grid.size.x() % grid.size.y(),
                      i / (grid.size.x() * grid.size.y()));
    const Vec3 world = grid.indexToWorld * voxel.cast<double>();
    double tinted = 0.0;
    weights.forEachWeight(
        weights.grid().worldToIndex * world,
        [&](std::uint8_t component, double weight) { tinted += component == 0 ? 0.0 : weight; });
    differences +=
        std::abs(tinted -
                 static_cast<double>(trimmed.focus()->voxels[static_cast<std::size_t>(i)])) > 1e-6;
  }
  EXPECT_EQ(differences, 0);

  request.focusStyle.hasOrganMargin = false;
  const PreparedScene whole = trimmed.withRequest(request);
  EXPECT_EQ(whole.focus()->count, count);
  EXPECT_TRUE(whole.margins().empty());
}

/// Where nothing is removed, the segments are not copied: the focus is the same.
TEST_F(OrganMarginScene, SharesSegmentsThatItDoesNotTrim) {
  const PreparedScene trimmed(request);
  request.focusStyle.hasOrganMargin = false;
  EXPECT_TRUE(trimmed.withRequest(request).updatedStages().focus);
  request.focusStyle.hasOrganMargin = true;
  request.input = folder / "uniform.nrrd";
  const PreparedScene scene(request);
  ASSERT_EQ(scene.margins().size(), 1U);
  EXPECT_TRUE(scene.margins()[0].isApplied);
  EXPECT_EQ(scene.focus()->count, count);
  request.focusStyle.hasOrganMargin = false;
  EXPECT_FALSE(scene.withRequest(request).updatedStages().focus);
}

/// Halves of one organ get its margin: they stay in contact.
TEST_F(OrganMarginScene, AdjacentSegmentsAreOneOrgan) {
  const PreparedScene whole(request);
  request.segmentation = folder / "halves.nrrd";
  request.materialChanges.clear();
  request.focus = {"1", "2"};
  const PreparedScene halves(request);
  ASSERT_EQ(halves.margins().size(), 1U);
  EXPECT_EQ(halves.margins()[0].volume, whole.margins()[0].volume);
  EXPECT_EQ(halves.focus()->count, whole.focus()->count);
}

/// Also if only the last of three connects the others.
TEST_F(OrganMarginScene, ChainsOfAdjacentSegmentsAreOneOrgan) {
  const PreparedScene whole(request);
  request.segmentation = folder / "thirds.nrrd";
  request.materialChanges.clear();
  request.focus = {"1", "2", "3"};
  const PreparedScene chain(request);
  ASSERT_EQ(chain.margins().size(), 1U);
  EXPECT_EQ(chain.margins()[0].volume, whole.margins()[0].volume);
  EXPECT_EQ(chain.focus()->count, whole.focus()->count);
  request.focus = {"1", "2"};
  EXPECT_EQ(PreparedScene(request).margins().size(), 2U) << "apart";
}

TEST_F(OrganMarginScene, OnlyForCt) {
  request.input = folder / "mr.nrrd";
  const PreparedScene scene(request);
  EXPECT_TRUE(scene.margins().empty());
  EXPECT_EQ(scene.focus()->count, count);
}

} // namespace
} // namespace fenestra::core::OrganMarginTests
