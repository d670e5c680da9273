// Clip weights, visible intervals and bounds are consistent; surfaces agree with the focus; errors.

#include "ClippingTesting.h"
#include "ErrorChecks.h"
#include "RunSettings.h"
#include "clip/surface/ClippingSurface.h"
#include "metrics/BoundaryMetrics.h"

#include <gtest/gtest.h>

namespace fenestra::core::ClipTests {
using namespace testing_clipping;

namespace {

constexpr std::array projections{Projection::orthographic, Projection::perspective};

/// Smaller version of the paper's model: a cuboid focus in the center of a cube.
struct Model {
  Grid volume = makeCenteredGrid({64, 64, 64});
  Mask focus = makeBoxMask(volume, {-16, -16, -24}, {16, 16, 24});

  ClippingSurface surface(const Camera& camera, SurfaceMode mode = SurfaceMode::surface) const {
    return buildClippingSurface(camera, volume, focus, {.mode = mode});
  }
};

/// Knee-like focus: a bent thin shell, seen obliquely.
struct Shell {
  Grid volume = makeCenteredGrid({60, 50, 40}, {1.0, 1.2, 1.5});
  Mask focus = makeMask(volume, [](const Vec3& p) {
    return std::abs(p.norm() - 18.0) < 2.0 && p.x() + 2.0 * p.y() < 8.0;
  });
};

Camera makeObliqueCamera(Projection projection, double distance, int side) {
  CameraPose pose;
  pose.projection = projection;
  pose.position = distance * Vec3(0.5, -1.0, 0.3).normalized();
  pose.target = {1.0, 2.0, -1.0};
  pose.scale = 35.0;
  pose.angle = std::min(45.0, 360.0 / pi * std::atan(pose.scale / distance));
  return {pose, side, side};
}

std::vector<Clip> makeClips(const Camera& camera) {
  const Shell shell;
  std::vector<Clip> clips{ClipNone{}, ClipPlane{camera, {2.0, -3.0, 1.0}, {0.4, -2.0, 0.3}},
                          ClipPlane{camera, {2.0, -3.0, 1.0}, {-0.4, 2.0, -0.3}}};
  for (const auto mode : {SurfaceMode::cutaway, SurfaceMode::surface})
    clips.push_back(buildClippingSurface(camera, shell.volume, shell.focus, {.mode = mode}).clip);
  return clips;
}

TEST(Clip, NoneClipsNothing) {
  EXPECT_EQ(clipWeight(Clip{}, {1e9, -1e9, 0.0}), 1.0);
  EXPECT_EQ(visibleInterval(Clip{}, {}).begin, 0.0);
  EXPECT_EQ(visibleInterval(Clip{}, {}).end, infinity);
}

TEST(Clip, PlaneRemovesTheSideOfItsNormal) {
  const Clip clip = ClipPlane{
      makeAnteriorCamera(Projection::orthographic, 100, 50, 8, 8), {0, -5, 0}, {0, -3, 0}};
  EXPECT_EQ(clipWeight(clip, {0, -6, 0}), 0.0);
  EXPECT_EQ(clipWeight(clip, {0, -4, 0}), 1.0);
  EXPECT_EQ(clipWeight(clip, {0, -200, 0}), 0.0);
  const Interval visible = visibleInterval(clip, {{0, -100, 0}, {0, 1, 0}});
  EXPECT_NEAR(visible.begin, 95.0, 1e-12);
  EXPECT_EQ(visible.end, infinity);
}

TEST(Clip, PlaneParallelToARayRemovesAllOrNothing) {
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 100, 50, 8, 8);
  const Ray ray{{0, -100, 0}, {0, 1, 0}};
  EXPECT_TRUE(visibleInterval(ClipPlane{camera, {-1, 0, 0}, {1, 0, 0}}, ray).isEmpty());
  EXPECT_FALSE(visibleInterval(ClipPlane{camera, {1, 0, 0}, {1, 0, 0}}, ray).isEmpty());
}

TEST(Clip, PerspectiveRemovesPointsBehindTheCameraInEveryMode) {
  const Camera camera = makeObliqueCamera(Projection::perspective, 10.0, 32);
  const Vec3 behind = camera.pose().position - 3.0 * camera.forward();
  const auto clips = makeClips(camera);
  EXPECT_EQ(clipWeight(clips[0], behind), 1.0);
  for (std::size_t i = 1; i < clips.size(); ++i) {
    EXPECT_EQ(clipWeight(clips[i], behind), 0.0);
    EXPECT_EQ(clipWeight(clips[i], camera.pose().position), 0.0);
  }
}

TEST(Clip, VisibleIntervalEndsWhereTheWeightChanges) {
  Random random(1, 0, 0);
  for (const auto projection : projections)
    for (const double distance : {12.0, 120.0, 1e5}) {
      const Camera camera = makeObliqueCamera(projection, distance, 96);
      for (const Clip& clip : makeClips(camera))
        for (int i = 0; i < fenestra::core::testing::scaleSamples(3000); ++i) {
          const Ray ray = camera.makeRay(uniform(random, 0, 96), uniform(random, 0, 96));
          const Interval visible = visibleInterval(clip, ray);
          const double step = 1e-6 * (1.0 + 1e-4 * distance);
          if (!visible.isEmpty()) {
            // Close to a distant camera, (x, y) has too few significant digits.
            const double inside = std::min(visible.begin > 0.0 ? step : 1e-3 * distance,
                                           0.5 * (visible.end - visible.begin));
            ASSERT_EQ(clipWeight(clip, ray.at(visible.begin + inside)), 1.0);
            ASSERT_EQ(clipWeight(clip, ray.at(visible.begin +
                                              0.9 * std::min(visible.end - visible.begin, 50.0))),
                      1.0);
          }
          if (visible.begin > 2.0 * step) {
            ASSERT_EQ(clipWeight(clip, ray.at(visible.begin - step)), 0.0);
            ASSERT_EQ(clipWeight(clip, ray.at(visible.begin * random.uniform() * 0.999)), 0.0);
          }
          if (visible.end < infinity) {
            ASSERT_EQ(clipWeight(clip, ray.at(visible.end + step)), 0.0);
          }
        }
    }
}

TEST(Clip, BoundsHoldForPointsOfTheBox) {
  Random random(2, 0, 0);
  for (const auto projection : projections)
    for (const double distance : {12.0, 120.0}) {
      const Camera camera = makeObliqueCamera(projection, distance, 64);
      const auto clips = makeClips(camera);
      for (std::size_t c = 0; c < clips.size(); ++c) {
        int foundEmpty = 0, empty = 0, foundFull = 0, full = 0;
        for (int trial = 0; trial < fenestra::core::testing::scaleSamples(20000); ++trial) {
          const Vec3 center = randomPoint(random, -35, 35);
          const Vec3 half =
              Vec3::Constant(0.2) + std::pow(random.uniform(), 4) * randomPoint(random, 0, 20);
          const Mat3 rotation =
              makeRotation(random.uniform(), randomPoint(random, -1, 1).normalized()).linear();
          const Box box{-half, half};
          Corners corners;
          for (int i = 0; i < 8; ++i)
            corners[static_cast<std::size_t>(i)] = center + rotation * box.corner(i);
          int visiblePoints = 0;
          for (int i = 0; i < 60; ++i) {
            const Vec3 p =
                i < 8 ? corners[static_cast<std::size_t>(i)]
                      : Vec3(center + rotation * half.cwiseProduct(randomPoint(random, -1, 1)));
            visiblePoints += clipWeight(clips[c], p) > 0.0;
          }
          const ClipBounds bounds = boundClipWeight(clips[c], corners);
          ASSERT_FALSE(bounds == ClipBounds::none && visiblePoints > 0);
          ASSERT_FALSE(bounds == ClipBounds::all && visiblePoints < 60);
          foundEmpty += bounds == ClipBounds::none;
          empty += visiblePoints == 0;
          foundFull += bounds == ClipBounds::all;
          full += visiblePoints == 60;
        }
        // The bounds are tight enough to recognize small boxes that are clipped or unclipped. Clip
        // 0 removes nothing; clip 3 is the cutaway, whose cliffs allow fewer empty boxes.
        EXPECT_GE(foundEmpty, c == 0 ? 0 : c == 3 ? empty / 3 : empty * 3 / 4) << "clip " << c;
        EXPECT_GE(foundFull, full / 3) << "clip " << c;
      }
    }
}

TEST(Clip, BoxAcrossTheCameraPlaneIncludesEveryDirection) {
  // Depth 20 mm, except far to the right, at the edge of the buffer.
  const Camera camera = makeAnteriorCamera(Projection::perspective, 30.0, 10.0, 64, 64);
  auto buffer = std::make_shared<DepthBuffer>(camera, makeCenteredGrid({100, 100, 100}));
  for (std::int64_t i = 0; i < buffer->size(); ++i)
    buffer->set(i, buffer->xAxis().coordinate(i % buffer->columns()) > 100.0 ? -1.0 : 20.0);
  const Clip clip = ClipDepth{camera, buffer, std::make_shared<DepthPyramid>(*buffer)};
  const auto makeCorners = [&](const Vec3& lower, const Vec3& upper) {
    Corners corners;
    for (int i = 0; i < 8; ++i) {
      const Vec3 view = Box{lower, upper}.corner(i);
      corners[static_cast<std::size_t>(i)] = camera.pose().position + view.x() * camera.right() +
                                             view.y() * camera.up() + view.z() * camera.forward();
    }
    return corners;
  };
  EXPECT_EQ(boundClipWeight(clip, makeCorners({1.0, -1.0, 5.0}, {3.0, 1.0, 10.0})),
            ClipBounds::none);
  EXPECT_EQ(boundClipWeight(clip, makeCorners({1.0, -1.0, -0.5}, {3.0, 1.0, 10.0})),
            ClipBounds::some);
  EXPECT_EQ(boundClipWeight(clip, makeCorners({1.0, -1.0, -0.5}, {3.0, 1.0, -0.1})),
            ClipBounds::none);
  EXPECT_EQ(boundClipWeight(clip, makeCorners({1.0, -1.0, 21.0}, {3.0, 1.0, 22.0})),
            ClipBounds::all);
}

TEST(ClippingSurface, DepthAtFocusSamplesEqualsThatOfTheFocus) {
  const Model model;
  for (const auto projection : projections)
    for (const auto mode : {SurfaceMode::cutaway, SurfaceMode::surface}) {
      const Camera camera = makeAnteriorCamera(projection, 200.0, 40.0, 80, 80);
      const ClippingSurface surface = model.surface(camera, mode);
      const auto& clip = std::get<ClipDepth>(surface.clip);
      for (std::int64_t i = 0; i < surface.focus.depth.size(); ++i)
        if (surface.focus.regions[static_cast<std::size_t>(i)] == Region::focus) {
          ASSERT_EQ(clip.buffer->at(i), surface.focus.depth.at(i));
        }
      EXPECT_EQ(clipWeight(surface.clip, {0.3, -16.1, 0.2}), 0.0);
      EXPECT_EQ(clipWeight(surface.clip, {0.3, -15.9, 0.2}), 1.0);
      EXPECT_EQ(clipWeight(surface.clip, {25.0, -30.0, 0.2}),
                mode == SurfaceMode::cutaway ? 1.0 : 0.0);
      EXPECT_TRUE(surface.warnings.empty());
    }
}

/// A cube seen along its axis has a known surface: the plane of its front face.
TEST(ClippingSurface, FlatFocusContinuesAsItsPlane) {
  const Model model;
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 200.0, 40.0, 80, 80);
  for (const Boundary boundary : {Boundary::spline, Boundary::exact}) {
    const ClippingSurface surface =
        buildClippingSurface(camera, model.volume, model.focus, {.boundary = boundary});
    EXPECT_EQ(surface.controlPoints.size(), boundary == Boundary::spline ? 50U : 0U);
    if (boundary == Boundary::spline) {
      EXPECT_LT(surface.mismatch->max, 1e-4);
    }
    const auto& buffer = *std::get<ClipDepth>(surface.clip).buffer;
    for (std::int64_t i = 0; i < buffer.size(); ++i) {
      EXPECT_NEAR(buffer.at(i), 184.0, 1e-3);
    }
  }
}

TEST(ClippingSurface, ExactBoundaryGapIsSmallerThanTheSplines) {
  Shell shell; // smoothed, as masks are by default: without stairs along the outline
  shell.focus.maxValue = 255;
  for (std::int64_t i = 0; i < shell.volume.size.prod(); ++i) {
    const Vec3 p = shell.volume.indexToWorld * Vec3(static_cast<double>(i % 60),
                                                    static_cast<double>(i / 60 % 50),
                                                    static_cast<double>(i / 3000));
    const double depth = std::min(2.0 - std::abs(p.norm() - 18.0), // mm inside the shell
                                  (8.0 - p.x() - 2.0 * p.y()) / std::sqrt(5.0));
    shell.focus.voxels[static_cast<std::size_t>(i)] =
        static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(0.5 + 0.25 * depth, 0.0, 1.0)));
  }
  for (const auto projection : projections) {
    const Camera camera = makeObliqueCamera(projection, 120.0, 160);
    const auto measureGap = [&](Boundary boundary) {
      const ClippingSurface surface =
          buildClippingSurface(camera, shell.volume, shell.focus, {.boundary = boundary});
      return measureBoundary(surface.clip, shell.volume, shell.focus, surface.focus).gap;
    };
    const Distribution spline = measureGap(Boundary::spline), exact = measureGap(Boundary::exact);
    EXPECT_LT(exact.mean, spline.mean);
    EXPECT_LT(exact.p95, spline.p95);
  }
}

TEST(ClippingSurface, JumpAtTheFocusIsWithinTheReportedMismatch) {
  const Shell shell;
  for (const auto projection : projections) {
    const Camera camera = makeObliqueCamera(projection, 120.0, 160);
    const ClippingSurface surface = buildClippingSurface(camera, shell.volume, shell.focus, {});
    EXPECT_LE(surface.mismatch->mean, surface.mismatch->p95);
    EXPECT_LE(surface.mismatch->p95, surface.mismatch->max);
    EXPECT_GT(surface.mismatch->max, 0.0);
    const auto& buffer = *std::get<ClipDepth>(surface.clip).buffer;
    // Between adjacent samples the spline changes by its slope, measured outside the focus.
    double slope = 0.0, worst = 0.0;
    for (std::int64_t row = 0; row < buffer.rows(); ++row)
      for (std::int64_t column = 1; column < buffer.columns(); ++column) {
        const double change = std::abs(buffer.at(buffer.sample(column, row)) -
                                       buffer.at(buffer.sample(column - 1, row)));
        const bool isFocus = surface.focus.isFocus(column, row);
        const bool wasFocus = surface.focus.isFocus(column - 1, row);
        if (isFocus != wasFocus)
          worst = std::max(worst, change);
        else if (!isFocus)
          slope = std::max(slope, change);
      }
    EXPECT_LE(worst, surface.mismatch->max + 2.0 * slope);
  }
}

TEST(ClippingSurface, DoesNotDependOnFraming) {
  const Shell shell;
  const Camera wide = makeAnteriorCamera(Projection::orthographic, 150.0, 40.0, 160, 160);
  const Camera narrow = makeAnteriorCamera(Projection::orthographic, 150.0, 10.0, 40, 40);
  const Clip a = buildClippingSurface(wide, shell.volume, shell.focus, {}).clip;
  const Clip b = buildClippingSurface(narrow, shell.volume, shell.focus, {}).clip;
  Random random(3, 0, 0);
  int different = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = randomPoint(random, -30, 30);
    different += clipWeight(a, p) != clipWeight(b, p);
  }
  EXPECT_LT(different, 20); // samples coincide; the contour's start does not matter
}

TEST(ClippingSurface, WarnsOfAFocusOutsideTheImage) {
  const Model model;
  CameraPose pose;
  pose.position = {28.0, -200.0, 28.0};
  pose.target = {28.0, 0.0, 28.0};
  pose.scale = 2.0;
  const ClippingSurface surface = model.surface({pose, 32, 32});
  ASSERT_EQ(surface.warnings.size(), 1U);
  expectMessage(surface.warnings[0], "focus-outside-image: focus A");
}

TEST(ClippingSurface, FocusThatNoRayHitsIsAnInputError) {
  const Model model;
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 200.0, 40.0, 40, 40);
  Affine shifted = model.focus.grid.indexToWorld;
  shifted.translation() += Vec3(500, 0, 0);
  Mask outside = model.focus;
  outside.grid = Grid(outside.grid.size, shifted);
  Mask emptyMask = makeMask(model.volume, [](const Vec3&) { return false; });
  for (const Mask& mask : {outside, emptyMask})
    catchError(ErrorKind::input, "hidden-focus: focus A",
               [&] { buildClippingSurface(camera, model.volume, mask, {}); });
}

TEST(ClippingSurface, OptionsOutOfRangeAreUsageErrors) {
  const Model model;
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 200.0, 40.0, 8, 8);
  for (const SurfaceOptions& options :
       {SurfaceOptions{.controlPoints = 0}, SurfaceOptions{.controlPoints = 1000001},
        SurfaceOptions{.smoothing = -0.1}, SurfaceOptions{.smoothing = std::nan("")}})
    EXPECT_THROW(buildClippingSurface(camera, model.volume, model.focus, options), Error);
}

TEST(ClippingSurface, OnePixelFocusGivesAFlatSurface) {
  const Grid volume = makeCenteredGrid({21, 21, 21});
  const Mask dot = makeBoxMask(volume, Vec3::Constant(-0.1), Vec3::Constant(0.1));
  CameraPose pose;
  pose.position = {0.5, -100.0, 0.5};
  pose.target = {0.5, 0.0, 0.5};
  pose.scale = 8.0;
  const ClippingSurface surface = buildClippingSurface({pose, 16, 16}, volume, dot, {});
  EXPECT_EQ(surface.controlPoints.size(), 1U);
  EXPECT_EQ(surface.warnings.size(), 1U);
  EXPECT_NEAR(std::get<ClipDepth>(surface.clip).surfaceDepth({9.0, -9.0}), 99.5, 1e-4);
}

} // namespace
} // namespace fenestra::core::ClipTests
