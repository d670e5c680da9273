// Soft clip edges, ghosts, holes, automatic planes and boundary metrics, compared with geometry.

#include "ClippingTesting.h"
#include "clip/surface/ClippingSurface.h"
#include "metrics/BoundaryMetrics.h"

#include <gtest/gtest.h>

namespace fenestra::core::ClipKindTests {
using namespace testing_clipping;

namespace {

constexpr std::array projections{Projection::orthographic, Projection::perspective};

/// Ball of radius 12 mm in the center of a cube of 80 mm, seen from 100 mm in front.
struct Ball {
  Grid volume = makeCenteredGrid({80, 80, 80});
  Mask focus = makeMask(volume, [](const Vec3& p) { return p.norm() < 12.0; });
  Camera camera;

  explicit Ball(Projection projection)
      : camera(makeAnteriorCamera(projection, 100, 40, 161, 161)) {}

  ClippingSurface surface(const SurfaceOptions& options) const {
    return buildClippingSurface(camera, volume, focus, options);
  }
  /// Clip weight at a depth on the camera ray through (x, y) of the plane through the target.
  double rayClipWeight(const Clip& clip, double x, double y, double depth) const {
    return clipWeight(clip, fromBuffer(camera, Vec3(x, y, depth)));
  }
};

TEST(ClipEdge, WeightRisesLinearlyFromTheGhostToOne) {
  const ClipEdge sharp, ghost{0.25, 0.0}, soft{0.0, 4.0}, both{0.2, 4.0};
  EXPECT_EQ(sharp(-1e-9), 0.0);
  EXPECT_EQ(sharp(0.0), 1.0);
  EXPECT_EQ(ghost(-3.0), 0.25);
  EXPECT_EQ(ghost(0.0), 1.0);
  EXPECT_EQ(soft(-1.0), 0.0);
  EXPECT_DOUBLE_EQ(soft(1.0), 0.25);
  EXPECT_EQ(soft(4.0), 1.0);
  EXPECT_DOUBLE_EQ(both(0.0), 0.2);
  EXPECT_DOUBLE_EQ(both(2.0), 0.6);
  EXPECT_EQ(both(infinity), 1.0);
}

TEST(ClipEdge, GhostIsVisibleFromTheCameraOn) {
  const Ball ball(Projection::perspective);
  SurfaceOptions options;
  options.edge.ghost = 0.125;
  const Clip clip = ball.surface(options).clip;
  EXPECT_EQ(ball.rayClipWeight(clip, 0, 0, 50.0), 0.125);
  EXPECT_EQ(ball.rayClipWeight(clip, 0, 0, 95.0), 1.0);
  EXPECT_EQ(clipWeight(clip, ball.camera.pose().position - ball.camera.forward()), 0.0);
  const Ray ray = ball.camera.makePlaneRay({0.0, 0.0});
  EXPECT_EQ(visibleInterval(clip, ray).begin, 0.0);
  EXPECT_NEAR(intervalBehindSurface(clip, ray).begin, 88.0, 0.3);
}

TEST(ClipEdge, BoundsHoldForTheWeightOfEveryPoint) {
  Random random(3, 0, 0);
  for (const Projection projection : projections) {
    const Ball ball(projection);
    std::vector<Clip> clips;
    for (const ClipEdge& edge : {ClipEdge{0.25, 0.0}, ClipEdge{0.0, 6.0}, ClipEdge{0.25, 6.0}}) {
      clips.push_back(ClipPlane{ball.camera, {0, -5, 0}, Vec3(0.3, -1, 0.2).normalized(), edge});
      for (const SurfaceMode mode : {SurfaceMode::surface, SurfaceMode::hole}) {
        SurfaceOptions options;
        options.mode = mode;
        options.edge = edge;
        clips.push_back(ball.surface(options).clip);
      }
    }
    for (const Clip& clip : clips) {
      int reducedBoxes = 0, uniformBoxes = 0;
      for (int trial = 0; trial < 2000; ++trial) {
        const Vec3 lower = randomPoint(random, -40, 36);
        const Box box{lower, lower + std::pow(random.uniform(), 3) * randomPoint(random, 0, 30)};
        Corners corners;
        for (int i = 0; i < 8; ++i)
          corners[static_cast<std::size_t>(i)] = box.corner(i);
        const ClipBounds bounds = boundClipWeight(clip, corners);
        for (int i = 0; i < 30; ++i) {
          const Vec3 fraction = randomPoint(random, 0, 1);
          const double weight =
              clipWeight(clip, box.lower + fraction.cwiseProduct(Vec3(box.upper - box.lower)));
          ASSERT_LE(weight, bounds.max);
          if (bounds.isUniform) {
            ASSERT_EQ(weight, bounds.max);
          }
        }
        reducedBoxes += bounds.max < 1.0;
        uniformBoxes += bounds.isUniform;
      }
      EXPECT_GT(reducedBoxes, 30) << "the bounds are not trivial";
      EXPECT_GT(uniformBoxes, 200);
    }
  }
}

TEST(Clip, OffsetMovesTheSurfaceAlongTheViewDirection) {
  const Ball ball(Projection::orthographic);
  SurfaceOptions options;
  const auto plain = std::get<ClipDepth>(ball.surface(options).clip);
  options.offset = -2.5;
  const auto moved = std::get<ClipDepth>(ball.surface(options).clip);
  for (std::int64_t i = 0; i < plain.buffer->size(); ++i)
    ASSERT_NEAR(moved.buffer->at(i), plain.buffer->at(i) - 2.5, 1e-4);
}

class Holes : public ::testing::TestWithParam<Projection> {};

TEST_P(Holes, BoxIsFlatAtTheFarthestVisiblePointAndWiderByItsMargin) {
  const Ball ball(GetParam());
  SurfaceOptions options;
  options.mode = SurfaceMode::hole;
  options.hole = {HoleShape::box, 6.0};
  const ClippingSurface surface = ball.surface(options);
  double half = 0.0, bottom = 0.0;
  const DepthBuffer& depth = surface.focus.depth;
  for (std::int64_t row = 0; row < depth.rows(); ++row)
    for (std::int64_t column = 0; column < depth.columns(); ++column)
      if (surface.focus.isFocus(column, row)) {
        half = std::max(half, depth.position(column, row).x());
        bottom = std::max(bottom, depth.at(depth.sample(column, row)));
      }
  EXPECT_NEAR(half, 12.0, 0.6);
  const auto weight = [&](double x, double y, double z) {
    return ball.rayClipWeight(surface.clip, x, y, z);
  };
  const double inside = half + 5.0, outside = half + 7.0;
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(weight(sign * inside, inside, bottom - 0.01), 0.0) << "a box has corners";
    EXPECT_EQ(weight(sign * inside, inside, bottom + 0.01), 1.0);
    EXPECT_EQ(weight(sign * outside, 0, 70.0), 1.0);
    EXPECT_EQ(weight(0, sign * outside, 70.0), 1.0);
  }
  EXPECT_EQ(weight(0, 0, 89.0), 1.0) << "the focus is not clipped";
  EXPECT_EQ(weight(0, 0, 87.0), 0.0);
}

TEST_P(Holes, CylinderIsRound) {
  const Ball ball(GetParam());
  SurfaceOptions options;
  options.mode = SurfaceMode::hole;
  options.hole = {HoleShape::cylinder, 6.0};
  const Clip clip = ball.surface(options).clip;
  EXPECT_EQ(ball.rayClipWeight(clip, 17.0, 0, 80.0), 0.0);
  EXPECT_EQ(ball.rayClipWeight(clip, 13.0, 13.0, 80.0), 1.0);
  EXPECT_EQ(ball.rayClipWeight(clip, 19.5, 0, 80.0), 1.0);
}

TEST_P(Holes, SphereLeavesASphericalSurface) {
  const Ball ball(GetParam());
  SurfaceOptions options;
  options.mode = SurfaceMode::hole;
  options.hole = {HoleShape::sphere, 8.0};
  const Clip clip = ball.surface(options).clip;
  // The sphere contains at most the visible half of the focus. Its center is reconstructed from
  // four points of its bottom.
  const auto& depth = std::get<ClipDepth>(clip);
  const auto bottom = [&](double x, double y) {
    return fromBuffer(ball.camera, Vec3(x, y, depth.surfaceDepth({x, y})));
  };
  const Vec3 a = bottom(14.0, 0), b = bottom(-14.0, 0), c = bottom(0, 15.0), d = bottom(0, -16.0);
  const Mat3 chords = Mat3::FromRows(b - a, c - a, d - a);
  const Vec3 rhs(0.5 * (b.squaredNorm() - a.squaredNorm()),
                 0.5 * (c.squaredNorm() - a.squaredNorm()),
                 0.5 * (d.squaredNorm() - a.squaredNorm()));
  const Vec3 center = chords.inverse() * rhs;
  EXPECT_NEAR(center.x(), 0.0, 0.5);
  EXPECT_NEAR(center.z(), 0.0, 0.5);
  EXPECT_GT((a - center).norm(), 12.0 + 7.0);
  EXPECT_LT((a - center).norm(), 15.0 + 8.0);
  EXPECT_EQ(ball.rayClipWeight(clip, 30.0, 0, 70.0), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Projections, Holes, ::testing::ValuesIn(projections));

TEST(FocusPlane, FlatFocusGivesItsPlane) {
  const Grid volume = makeCenteredGrid({80, 80, 80});
  const Vec3 normal = Vec3(0.3, -1.0, 0.2).normalized();
  const Mask focus = makeMask(volume, [&](const Vec3& p) {
    return std::abs(p.dot(normal)) < 4.0 && (p - p.dot(normal) * normal).norm() < 20.0;
  });
  for (const Projection projection : projections) {
    const Camera camera = makeAnteriorCamera(projection, 150, 40, 128, 128);
    const ClipPlane plane = fitFocusPlane(camera, FocusTracer(camera, volume, focus).traceDepths());
    EXPECT_GT(plane.normal.dot(normal), std::cos(4.0 * pi / 180.0));
    // The plane is the side of the slab that faces the camera, to half a voxel.
    EXPECT_NEAR(plane.point.dot(normal), 4.0, 0.6);
    EXPECT_LT(plane.normal.dot(camera.forward()), 0.0);
  }
}

TEST(FocusPlane, OneSampleGivesAPlaneFacingTheCamera) {
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 150, 40, 3, 3);
  const Grid volume = makeCenteredGrid({80, 80, 80});
  const Mask focus = makeBoxMask(volume, {-3, -3, -3}, {3, 3, 3});
  const ClipPlane plane = fitFocusPlane(camera, FocusTracer(camera, volume, focus).traceDepths());
  EXPECT_LT((plane.normal + camera.forward()).norm(), 1e-9);
}

/// Cuboid focus with its front face at a depth of 84 mm, in a cube with its face at 60 mm.
struct Cuboid {
  Grid volume = makeCenteredGrid({80, 80, 80});
  Mask focus = makeBoxMask(volume, {-16, -16, -24}, {16, 16, 24});
  Camera camera = makeAnteriorCamera(Projection::orthographic, 100, 40, 160, 160);
};

TEST(BoundaryMetrics, CutawayGapIsTheHeightOfItsCliffs) {
  const Cuboid model;
  const ClippingSurface surface =
      buildClippingSurface(model.camera, model.volume, model.focus, {.mode = SurfaceMode::cutaway});
  const BoundaryMetrics metrics =
      measureBoundary(surface.clip, model.volume, model.focus, surface.focus);
  const DepthBuffer& depth = surface.focus.depth;
  const double front = depth.at(depth.viewportSample(80, 80));
  // The cuboid's edges are rounded by half a voxel.
  EXPECT_NEAR(metrics.gap.mean, front - 60.0, 0.5);
  EXPECT_NEAR(metrics.gap.max, front - 60.0, 0.5);
  EXPECT_LT(metrics.slopeJump.mean, 0.5);
  EXPECT_EQ(metrics.depthJumpFraction, 0.0);
  EXPECT_GT(metrics.crossings, 100U);
}

TEST(BoundaryMetrics, AreZeroOnAPlanarFocus) {
  const Cuboid model;
  for (const Boundary boundary : {Boundary::spline, Boundary::exact}) {
    SurfaceOptions options;
    options.boundary = boundary;
    const ClippingSurface surface =
        buildClippingSurface(model.camera, model.volume, model.focus, options);
    const BoundaryMetrics metrics =
        measureBoundary(surface.clip, model.volume, model.focus, surface.focus);
    EXPECT_LT(metrics.gap.max, 0.5) << "the cuboid's edges are rounded by half a voxel";
    EXPECT_LT(metrics.gap.mean, boundary == Boundary::exact ? 0.15 : 0.4);
    EXPECT_LT(metrics.slopeJump.mean, 0.5);
  }
}

TEST(BoundaryMetrics, TiltedPlaneGapEqualsItsDistance) {
  const Cuboid model;
  const FocusDepth focus = FocusTracer(model.camera, model.volume, model.focus).traceDepths();
  const double front = focus.depth.at(focus.depth.viewportSample(80, 80));
  // Depth front + 0.25 x over the view: gaps of 0 to 4 mm along the face's outline.
  const Vec3 through = fromBuffer(model.camera, Vec3(0, 0, front));
  const Vec3 normal = 0.25 * model.camera.right() - model.camera.forward();
  const Clip clip = ClipPlane{model.camera, through, normal.normalized()};
  const BoundaryMetrics metrics = measureBoundary(clip, model.volume, model.focus, focus);
  // The cuboid's edges are rounded by half a voxel, which lowers the surface there.
  EXPECT_NEAR(metrics.gap.max, 4.0, 0.6);
  EXPECT_NEAR(metrics.gap.mean, 0.5 * (4.0 + 2.0), 0.4) << "4 on two sides, 0 to 4 on the others";
  const BoundaryMetrics flat =
      measureBoundary(Clip(ClipPlane{model.camera, through, -model.camera.forward()}), model.volume,
                      model.focus, focus);
  EXPECT_NEAR(metrics.slopeJump.max, flat.slopeJump.max + 0.25, 1e-3);
}

TEST(BoundaryMetrics, JumpsWithinTheFocusAreCountedSeparately) {
  const Grid volume = makeCenteredGrid({80, 80, 80});
  // The right half is 10 mm deeper.
  const Mask focus = makeMask(volume, [](const Vec3& p) {
    return std::abs(p.x()) < 16.0 && std::abs(p.z()) < 16.0 &&
           std::abs(p.y() - (p.x() > 0.0 ? 10.0 : 0.0)) < 6.0;
  });
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 100, 40, 160, 160);
  SurfaceOptions options;
  options.boundary = Boundary::exact;
  const ClippingSurface surface = buildClippingSurface(camera, volume, focus, options);
  const BoundaryMetrics metrics = measureBoundary(surface.clip, volume, focus, surface.focus);
  // Two samples on each side of the jump, at its top and at its bottom.
  EXPECT_NEAR(metrics.depthJumpFraction * static_cast<double>(metrics.crossings), 4.0, 4.0);
  EXPECT_GT(metrics.depthJumpFraction, 0.0);
  EXPECT_LT(metrics.gap.max, 3.0);
}

} // namespace
} // namespace fenestra::core::ClipKindTests
