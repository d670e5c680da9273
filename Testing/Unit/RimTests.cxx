// The rim of the focus: where the surface between samples would hide what the samples do not show.

#include "ClippingTesting.h"
#include "clipping/ClippingSurface.h"
#include "clipping/SmoothFill.h"

#include <gtest/gtest.h>

using namespace fenestra;
using namespace fenestra::testing_clipping;

namespace {

/// A ball, which falls away steeply where it ends; seen by pixels smaller than its voxels.
struct Ball {
  Domain volume{centredGrid({60, 60, 60})};
  Mask focus = sphereMask(centredGrid({60, 60, 60}), 20.3);
  Camera camera = anteriorCamera(Projection::orthographic, 200.0, 30.0, 100, 100);
  FocusTracer tracer{camera, volume, focus};
  FocusDepth depths = tracer.depths();
  Rim rim = tracer.rim(depths);
  double pitch = camera.pixelPitch();

  bool isFocus(std::int64_t sample) const {
    return depths.regions[static_cast<std::size_t>(sample)] == Region::focus;
  }
  /// The four samples around a place.
  std::array<std::int64_t, 4> around(const Vec2& at) const {
    const auto column = static_cast<std::int64_t>(depths.depth.xAxis().index(at.x()));
    const auto row = static_cast<std::int64_t>(depths.depth.yAxis().index(at.y()));
    const std::int64_t first = depths.depth.sample(column, row);
    return {first, first + 1, first + depths.depth.columns(), first + depths.depth.columns() + 1};
  }
};

TEST(Rim, LiesBesideTheFocus) {
  const Ball ball;
  EXPECT_GT(ball.rim.samples.size(), 100U);
  for (std::size_t i = 0; i < ball.rim.samples.size(); ++i) {
    const std::int64_t sample = ball.rim.samples[i].sample;
    EXPECT_FALSE(ball.isFocus(sample));
    EXPECT_TRUE(i == 0 || ball.rim.samples[i - 1].sample < sample); // each once
    const double r =
        ball.depths.depth
            .position(sample % ball.depths.depth.columns(), sample / ball.depths.depth.columns())
            .norm();
    EXPECT_NEAR(r, 20.5, 1.6) << sample;
  }
}

/// Every ray found between the samples meets the focus where the focus is, on the ball to a voxel.
TEST(Rim, IsFoundByRaysThatMeetTheFocus) {
  const Ball ball;
  EXPECT_GT(ball.rim.meetings.size(), 500U);
  for (const Meeting& meeting : ball.rim.meetings) {
    const double y = 200.0 - meeting.depth; // of the ball, toward the eye
    EXPECT_NEAR(std::hypot(meeting.position.norm(), y), 20.3, 1.0);
  }
}

TEST(Rim, IsSoDeepThatTheSurfaceDoesNotHideTheFocus) {
  const Ball ball;
  const ClippingSurface surface =
      buildClippingSurface(ball.camera, ball.volume, ball.focus, {.boundary = Boundary::exact});
  const DepthBuffer& buffer = *std::get<ClipDepth>(surface.clip).buffer;
  std::size_t limited = 0;
  for (const Meeting& meeting : ball.rim.meetings) {
    double deepestRim = -infinity, deepestFocus = -infinity;
    for (const std::int64_t sample : ball.around(meeting.position)) {
      double& deepest = ball.isFocus(sample) ? deepestFocus : deepestRim;
      deepest = std::max(deepest, buffer.at(sample));
    }
    if (deepestRim >= deepestFocus + steepestRim * ball.pitch - 1e-3)
      ++limited;
    else
      EXPECT_LE(meeting.depth - buffer.depth(meeting.position),
                steepestBoundary * ball.pitch + 1e-3);
  }
  EXPECT_LT(limited, ball.rim.meetings.size() / 2);
}

/// A plate's edges, rounded by its voxels, are no steep fall.
TEST(Rim, AFlatFocusHasNone) {
  const Domain volume(centredGrid({40, 40, 40}));
  const Mask plate = boxMask(centredGrid({40, 40, 40}), {-8, -3, -8}, {8, 3, 8});
  const Camera camera = anteriorCamera(Projection::orthographic, 100.0, 20.0, 40, 40);
  const FocusTracer tracer(camera, volume, plate);
  const Rim rim = tracer.rim(tracer.depths());
  EXPECT_TRUE(rim.samples.empty());
  EXPECT_FALSE(rim.meetings.empty());
}

} // namespace
