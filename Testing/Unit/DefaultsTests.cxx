// Default view, transfer function and channels of a scene.

#include "scene/Defaults.h"
#include "scene/FilmImage.h"

#include "Approx.h"
#include "Support.h"
#include "base/Error.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::DefaultsTests {
namespace {

Volume makeRamp(double low, double high) {
  return makeVolume<float>(makeCenteredGrid({40, 30, 20}, {2.0, 2.0, 2.0}),
                           [=](const Vec3& p) { return low + (high - low) * p.x() / 39.0; });
}

Mask makeSmallFocus() {
  Affine map = Affine::Identity();
  map.translation() = Vec3(10, 5, -8);
  return {Grid({8, 8, 8}, map), std::vector<std::uint8_t>(512, 1), 512, {"A"}};
}

TEST(FrameView, NamedViewShowsTheCompleteVolumeAlongAnAxis) {
  const Grid grid = makeRamp(0, 1).grid;
  ViewRequest view;
  view.name = "left";
  const Camera camera(frameView(view, grid, nullptr, 200, 100), 200, 100);
  EXPECT_TRUE(isApprox(camera.forward(), Vec3::UnitX())) << "a viewer at the left looks right";
  EXPECT_TRUE(isApprox(camera.up(), Vec3::UnitZ()));
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = camera.toView(grid.worldCorner(i));
    EXPECT_GT(corner.z(), 0.0) << "nothing is behind the camera";
    EXPECT_LE(std::abs(corner.y()), camera.pose().scale);
    EXPECT_LE(std::abs(corner.x()), 2.0 * camera.pose().scale);
  }
}

TEST(FrameView, UpCanHaveAnyLength) {
  const Grid grid = makeRamp(0, 1).grid;
  const auto frame = [&grid](const Vec3& up) {
    ViewRequest view;
    view.up = up;
    return frameView(view, grid, nullptr, 200, 100);
  };
  const CameraPose expected = frame(Vec3(1, 1, 1));
  for (const double length : {0x1p-1070, 0x1p-600, 0x1p600, 0x1p1023}) {
    const CameraPose pose = frame(length * Vec3(1, 1, 1));
    EXPECT_EQ(pose.scale, expected.scale) << length;
    EXPECT_EQ(pose.position, expected.position) << length;
    EXPECT_TRUE(isApprox(Camera(pose, 200, 100).up(), Camera(expected, 200, 100).up(), 1e-15));
  }
}

TEST(FrameView, FocusFramingIsEqualInBothProjections) {
  const Grid grid = makeRamp(0, 1).grid;
  const Mask focus = makeSmallFocus();
  ViewRequest view;
  const Camera orthographic(frameView(view, grid, &focus, 64, 64), 64, 64);
  view.projection = Projection::perspective;
  const Camera perspective(frameView(view, grid, &focus, 64, 64), 64, 64);
  EXPECT_TRUE(isApprox(orthographic.pose().target, focus.grid.worldCenter()));
  EXPECT_NEAR(perspective.pixelPitch(), orthographic.pixelPitch(), 1e-9);
  EXPECT_LT(orthographic.pose().scale, 10.0) << "frames the focus, not the volume";
  const Vec3 fromCenter =
      grid.worldToIndex * perspective.pose().position - grid.indexBox().center();
  const Vec3 half = 0.5 * grid.size.cast<double>();
  EXPECT_GT((fromCenter.cwiseAbs() - half).maxCoeff(), 0.0) << "the camera is outside the volume";
}

TEST(FrameView, FocusNearAnEndOfTheScanIsFramedUpToThatEnd) {
  const Grid grid = makeRamp(0, 1).grid; // 40 mm high
  const auto makeFocus = [&](double height, int voxels) {
    const Vec3 center = grid.worldCenter() + Vec3(0.0, 0.0, height);
    const Affine moved = Affine(makeTranslation(center)) *
                         Affine(makeTranslation(Vec3::Constant(0.5 - 0.5 * voxels)));
    return Mask{Grid({voxels, voxels, voxels}, moved), {}, 0, {"A"}};
  };
  const auto frame = [&](const Mask& focus, const Domain& occupied, const ViewRequest& view = {}) {
    const CameraPose pose = frameView(view, occupied, &focus, 64, 64);
    return Vec2(pose.target.z() - grid.worldCenter().z(), pose.scale);
  };
  for (const double side : {-1.0, 1.0}) {
    const Mask near = makeFocus(side * 15.0, 10);
    const Vec2 framing = frame(near, grid);
    EXPECT_NEAR(framing.y(), 8.0, 1e-9) << "same scale as elsewhere";
    EXPECT_NEAR(framing.x(), side * 12.0, 1e-9) << "shifted to the end of the scan";
    Box occupied = grid.indexBox();
    (side > 0.0 ? occupied.upper : occupied.lower).z() -= side * 1.0;
    EXPECT_NEAR(frame(near, Domain(grid).intersect(occupied)).x(), side * 15.0, 1e-9)
        << "the medium ends before the scan";
    ViewRequest view;
    view.scale = 8.0;
    EXPECT_NEAR(frame(near, grid, view).x(), side * 15.0, 1e-9);
    const Mask large = makeFocus(side * 4.0, 30);
    EXPECT_NEAR(frame(large, grid).x(), 0.0, 1e-9) << "equal margins on both sides";
  }
  EXPECT_NEAR(frame(makeFocus(3.0, 10), grid).x(), 3.0, 1e-9);
}

TEST(FrameView, CroppedVolumeIsFramed) {
  const Grid grid = makeRamp(0, 1).grid; // 80 x 60 x 40 mm
  // Rotated box that reaches beyond the volume's right face.
  const CropBox crop(makeTranslation(grid.worldCenter() + Vec3(30, 0, 0)) *
                     makeRotation(pi / 4, Vec3::UnitY()) * makeScaling(Vec3::Constant(10.0)));
  const Camera camera(frameView({}, Domain(grid, crop), nullptr, 64, 64), 64, 64);
  // Width: from the rotated box's corner to the volume's face, 24.14 mm; height: 28.28 mm.
  const double width = 10.0 * std::numbers::sqrt2 + 10.0;
  const Vec3 center = grid.worldCenter() + Vec3(40.0 - 0.5 * width, 0.0, 0.0);
  EXPECT_LT((camera.pose().target - center).norm(), 1e-6);
  EXPECT_NEAR(camera.pose().scale, 1.05 * 10.0 * std::numbers::sqrt2, 1e-6);

  const CropBox outside(Affine(makeTranslation({500, 0, 0})));
  EXPECT_EQ(frameView({}, Domain(grid, outside), nullptr, 64, 64).scale,
            frameView({}, grid, nullptr, 64, 64).scale)
      << "the crop is empty, so the volume is framed";
}

TEST(FrameView, RejectsAnUnknownName) {
  ViewRequest view;
  view.name = "sideways";
  EXPECT_THROW(frameView(view, makeRamp(0, 1).grid, nullptr, 8, 8), Error);
}

TEST(TransparentFraction, CountsFocusVoxelsWithoutExtinction) {
  const Volume volume = makeRamp(0, 39); // the value is the voxel's x index
  const Affine map = volume.grid.indexToWorld;
  const Mask focus{Grid({20, 30, 20}, map), std::vector<std::uint8_t>(12000, 1), 12000, {"A"}};
  const auto makeTransfer = [](double value) {
    return TransferFunction{
        ScalarFunction({{value, ScalarFunction::Value(0.0)}, {100.0, ScalarFunction::Value(1.0)}}),
        ColorFunction({{0.0, Rgb(1, 1, 1)}})};
  };
  EXPECT_EQ(transparentFraction(focus, volume, makeTransfer(-1.0)), 0.0);
  EXPECT_NEAR(transparentFraction(focus, volume, makeTransfer(4.5)), 0.25, 1e-12)
      << "0 to 4, of 0 to 19";
  EXPECT_EQ(transparentFraction(focus, volume, makeTransfer(50.0)), 1.0);
}

TEST(AirThreshold, FollowsTheModalityAndIsMissingForMaskedBackgrounds) {
  EXPECT_EQ(findAirThreshold(makeRamp(-1000, 1500)), -300.0);
  const auto makeHead = [](double air) {
    return makeVolume<float>(makeCenteredGrid({40, 30, 20}, {2.0, 2.0, 2.0}), [=](const Vec3& p) {
      return p.norm() < 20.0 ? 400.0 + p.x() : air * std::abs(std::sin(100.0 * p.x() + p.y()));
    });
  };
  const std::optional<double> level = findAirThreshold(makeHead(30.0));
  ASSERT_TRUE(level);
  EXPECT_GT(*level, 30.0);
  EXPECT_LT(*level, 380.0);
  EXPECT_FALSE(findAirThreshold(makeHead(0.0))) << "masked background";
  EXPECT_FALSE(findAirThreshold(makeRamp(7, 7))) << "constant";
}

TEST(FilmImage, PlaneLiesThroughTheTargetWithTheCornersOfTheImage) {
  CameraPose pose;
  pose.position = {0, -100, 0};
  pose.target = {0, 0, 0};
  pose.scale = 10.0;
  const ImagePlane plane = makeImagePlane(Camera(pose, 40, 20));
  EXPECT_TRUE(isApprox(plane.topLeft, Vec3(-19.5, 0.0, 9.5)));
  EXPECT_TRUE(isApprox(plane.columnStep, Vec3(1, 0, 0)));
  EXPECT_TRUE(isApprox(plane.rowStep, Vec3(0, 0, -1)));
}

TEST(FilmImage, HasEveryDocumentedChannel) {
  CameraPose pose;
  const Camera camera(pose, 2, 1);
  Film film(2, 1);
  PathSample hit;
  hit.radiance = Rgb(1, 2, 3);
  hit.depth = 5.0;
  film.at(0, 0).add(hit);
  PathSample miss;
  miss.alpha = 0.0;
  film.at(1, 0).add(miss);
  const Image image =
      makeImage(film, camera, ClipPlane{camera, Vec3(0, 3, 0), -Vec3::UnitY()}, parseLayers({}));
  for (const char* name :
       {"R", "G", "B", "A", "Z", "clip.Z", "albedo.R", "albedo.G", "albedo.B", "normal.X",
        "normal.Y", "normal.Z", "error.R", "error.G", "error.B", "samples.N"})
    ASSERT_TRUE(image.find(name)) << name;
  EXPECT_EQ(*image.find("Z"), (std::vector<float>{5.0F, std::numeric_limits<float>::infinity()}));
  EXPECT_EQ(*image.find("A"), (std::vector<float>{1.0F, 0.0F}));
  EXPECT_NEAR((*image.find("clip.Z"))[0], 3.0F, 1e-5);
  EXPECT_EQ(makeImage(film, camera, ClipNone{}, parseLayers({"depth"})).channels.size(), 1U);
}

} // namespace
} // namespace fenestra::core::testing::DefaultsTests
