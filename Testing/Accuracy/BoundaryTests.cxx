// Clipping surface of a knee, compared with independently traced rays.

#include "BoundaryMeasure.h"
#include "Subjects.h"
#include "TemporaryFolder.h"

#include <gtest/gtest.h>

using namespace fenestra::core;
using namespace fenestra::core::accuracy;

namespace {

/// A ball of 20 voxels radius: intersections are exact up to its voxelization.
TEST(FocusField, FirstHitOnBallMatchesClosedForm) {
  Indicator ball{Size3(50, 50, 50), Affine::Identity(), {}};
  const Vec3 center(24.0, 25.0, 26.0);
  for (int z = 0; z < 50; ++z)
    for (int y = 0; y < 50; ++y)
      for (int x = 0; x < 50; ++x)
        ball.voxels.push_back((Vec3(x, y, z) - center).norm() <= 20.0 ? 1 : 0);
  const FocusField field(ball);
  EXPECT_LT((field.center() - center).norm(), 1e-12);
  EXPECT_NEAR(field.radius(), 20.0, 1e-12);
  for (int i = -24; i <= 24; ++i) {
    const double height = i;
    const double distance = field.findFirstHit({-100.0, 25.0, 26.0 + height}, Vec3::UnitX());
    if (std::abs(height) > 21.0) {
      EXPECT_EQ(distance, infinity);
    } else if (std::abs(height) < 19.0) {
      EXPECT_NEAR(distance, 124.0 - std::sqrt(400.0 - height * height), 1.0);
    }
  }
}

/// Along an axis, the level 0.5 is halfway between two voxel centers.
TEST(FocusField, BoxFaceIsHalfwayBetweenVoxelCenters) {
  Indicator box{Size3(8, 8, 8), Affine::Identity(), std::vector<std::uint8_t>(512, 0)};
  for (std::size_t z = 2; z < 6; ++z)
    for (std::size_t y = 2; y < 6; ++y)
      for (std::size_t x = 2; x < 6; ++x)
        box.voxels[(z * 8 + y) * 8 + x] = 1;
  const FocusField field(box);
  EXPECT_NEAR(field.findFirstHit({3.3, 4.2, -10.0}, Vec3::UnitZ()), 11.5, 1e-9);
  EXPECT_NEAR(field.findFirstHit({3.3, 4.2, 20.0}, -Vec3::UnitZ()), 14.5, 1e-9);
  EXPECT_EQ(field.findFirstHit({3.3, 6.2, -10.0}, Vec3::UnitZ()), infinity);
}

struct ViewCase {
  int number; ///< of the twelve views
  bool isPerspective;
  double smoothing; ///< of the labels, mm
  double elevation; ///< degrees
};

TEST(Boundary, ExactSurfaceGapIsBelowAThirdOfTheSpline) {
  const TemporaryFolder folder;
  Subject knee = makeKnee(folder.path(), "150x172x60");
  for (const ViewCase& viewCase :
       {ViewCase{0, false, 0.0, 0.0}, ViewCase{1, true, 0.0, 0.0}, ViewCase{2, false, 0.6, 25.0}}) {
    SCOPED_TRACE(viewCase.number);
    knee.smoothing = viewCase.smoothing;
    const FocusField field(readIndicator(knee));
    View view = makeView(field, viewCase.number, 12, 256, viewCase.elevation);
    view.isPerspective = viewCase.isPerspective;
    const FocusView focus(field, view);
    const BoundaryMeasure spline = focus.measure(makeSurface(knee, view, "spline"));
    const BoundaryMeasure exact = focus.measure(makeSurface(knee, view, "exact"));
    EXPECT_GT(exact.rays, 1e5);
    EXPECT_LT(spline.centerGap, 1e-3);
    EXPECT_LT(exact.centerGap, strictTolerance) << "beside closed slots";
    EXPECT_LT(exact.slotFraction, 0.01);
    EXPECT_LT(exact.gap.mean, 0.3 * spline.gap.mean);
    EXPECT_LT(exact.gap.p95, 0.3 * spline.gap.p95);
    EXPECT_LT(exact.gap.p95, 0.05);
    EXPECT_LT(exact.gap.max, 0.5) << "beside closed slots";
    EXPECT_GT(exact.strictFraction, 0.999);
    EXPECT_GT(exact.halfVoxelSmooth, 0.999);
    EXPECT_GT(exact.halfVoxelSmooth, spline.halfVoxelSmooth);
  }
}

/// Next to the focus, the rendered depth of the context is that of the surface.
TEST(Boundary, ImageShowsContextAtTheSurfaceDepth) {
  const TemporaryFolder folder;
  Subject knee = makeKnee(folder.path(), "150x172x60");
  knee.smoothing = 0.6;
  const FocusField field(readIndicator(knee));
  const View view = makeView(field, 1, 12, 256, 25.0);
  const FocusView focus(field, view);
  const Surface spline = makeSurface(knee, view, "spline");
  const Surface exact = makeSurface(knee, view, "exact");
  const auto splineDepths = renderDepths(knee, view, "spline", folder.path());
  const auto exactDepths = renderDepths(knee, view, "exact", folder.path());
  EXPECT_GT(focus.match(splineDepths, spline).fraction, 0.999);
  EXPECT_GT(focus.match(exactDepths, exact).fraction, 0.999);
  EXPECT_LT(focus.match(exactDepths, spline).fraction, 0.9);
  EXPECT_GT(focus.match(exactDepths, exact).pixels, 200.0);
}

} // namespace
