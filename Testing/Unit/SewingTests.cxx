// Between samples: where the focus ends or hides a part of itself, the exact surface is known
// finely.

#include "ClippingTesting.h"
#include "clipping/ClippingSurface.h"

#include <gtest/gtest.h>

using namespace fenestra;
using namespace fenestra::testing_clipping;

namespace {

constexpr std::array projections{Projection::orthographic, Projection::perspective};

/// A ball, which falls away steeply where it ends; seen by pixels smaller than its voxels.
struct Ball {
  Domain volume{centredGrid({60, 60, 60})};
  Mask focus = sphereMask(centredGrid({60, 60, 60}), 20.3);
  Camera camera;

  explicit Ball(Projection projection)
      : camera(anteriorCamera(projection, 200.0, 30.0, 100, 100)) {}

  ClippingSurface surface() const {
    return buildClippingSurface(camera, volume, focus, {.boundary = Boundary::exact});
  }
};

/// A ray's depth in the focus, by stepping.
double focusDepth(const Ball& ball, const Vec2& at) {
  const Ray ray = ball.camera.rayThrough(at);
  const Mask& mask = ball.focus;
  const auto inside = [&](double t) {
    const Vec3 index = mask.grid.worldToIndex * ray.at(t);
    const Vec3 base = index.array().floor();
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 offset(corner & 1, corner >> 1 & 1, corner >> 2);
      const Vec3 voxel = base + offset;
      const Vec3 weight = (1.0 - (index - voxel).array().abs()).matrix();
      const Size3 v = voxel.cast<std::int64_t>();
      if ((v.array() >= 0).all() && (v.array() < mask.grid.size.array()).all())
        sum += weight.prod() *
               mask.voxels[static_cast<std::size_t>(v.x() + 60 * (v.y() + 60 * v.z()))];
    }
    return sum >= 0.5;
  };
  for (double t = 170.0; t < 230.0; t += 0.01)
    if (inside(t))
      return t * ball.camera.depthPerLength(ray);
  return infinity;
}

TEST(Sewing, HidesNoneOfTheFocusBetweenSamples) {
  for (const Projection projection : projections) {
    const Ball ball(projection);
    const ClippingSurface surface = ball.surface();
    const auto& clip = std::get<ClipDepth>(surface.clip);
    Random random(1, 0, 0);
    std::vector<double> inFront;
    while (inFront.size() < 400) {
      const double angle = uniform(random, 0.0, 2.0 * pi);
      const Vec2 at = uniform(random, 18.0, 21.0) * Vec2(std::cos(angle), std::sin(angle));
      if (const double depth = focusDepth(ball, at); depth < infinity)
        inFront.push_back(std::max(0.0, depth - clip.surface(at)));
    }
    std::ranges::sort(inFront);
    EXPECT_LT(inFront[360], 0.02) << "a step of this test's search";
    EXPECT_LT(inFront[396], 0.6) << "a square of 0.15 mm where the ball ends";
  }
}

TEST(Sewing, BesideTheFocusItsDepthGoesOn) {
  const Ball ball(Projection::orthographic);
  const ClippingSurface surface = ball.surface();
  const auto& clip = std::get<ClipDepth>(surface.clip);
  for (int i = 0; i < 200; ++i) {
    const Vec2 way(std::cos(0.03 * i), std::sin(0.03 * i));
    double radius = 18.0, last = 0.0;
    for (double depth = 0.0; depth < infinity; radius += 0.01) {
      last = depth;
      depth = focusDepth(ball, radius * way);
    }
    // Just outside: as deep as the focus is before it ends, and not far deeper.
    const double before = focusDepth(ball, (radius - 0.35) * way);
    EXPECT_GT(clip.surface((radius + 0.02) * way), before - 1.0);
    EXPECT_LT(clip.surface((radius + 0.02) * way), last + 8.0 * ball.camera.pixelPitch());
  }
}

TEST(Sewing, MeetsOtherCellsWhereTheyBegin) {
  const Ball ball(Projection::orthographic);
  const ClippingSurface surface = ball.surface();
  const DepthBuffer& buffer = *std::get<ClipDepth>(surface.clip).buffer;
  const auto isFine = [&](std::int64_t column, std::int64_t row) {
    return buffer.fineCells()[static_cast<std::size_t>(buffer.sample(column, row))] >= 0;
  };
  std::vector<double> steps;
  for (std::int64_t row = 1; row + 1 < buffer.rows(); ++row)
    for (std::int64_t column = 1; column + 1 < buffer.columns(); ++column)
      if (isFine(column, row) && !isFine(column - 1, row) && !surface.focus.isFocus(column, row) &&
          !surface.focus.isFocus(column, row + 1)) {
        const Vec2 low = buffer.position(column, row), high = buffer.position(column, row + 1);
        const Vec2 edge = 0.5 * (low + high),
                   aside = 1e-6 * (buffer.position(1, 0) - buffer.position(0, 0));
        steps.push_back(std::abs(buffer.depth(edge + aside) - buffer.depth(edge - aside)));
      }
  ASSERT_GT(steps.size(), 20U);
  std::ranges::sort(steps);
  EXPECT_LT(steps[steps.size() / 2], 0.25 * ball.camera.pixelPitch());
}

TEST(Sewing, AFocusThatHidesAPartOfItselfHasTheFartherDepthBetween) {
  // The right half lies 10 mm deeper.
  const Grid volume = centredGrid({60, 60, 60});
  const Mask focus = maskOf(volume, [](const Vec3& p) {
    return std::abs(p.x()) < 16.0 && std::abs(p.z()) < 16.0 &&
           std::abs(p.y() - (p.x() > 0.0 ? 10.0 : 0.0)) < 6.0;
  });
  const Camera camera = anteriorCamera(Projection::orthographic, 100, 30, 77, 77);
  const ClippingSurface surface =
      buildClippingSurface(camera, volume, focus, {.boundary = Boundary::exact});
  const auto& clip = std::get<ClipDepth>(surface.clip);
  int between = 0;
  for (double x = -3.0; x < 3.0; x += 0.01) {
    const double depth = clip.surface({x, 0.3});
    between += depth > 95.0 && depth < 103.0;
  }
  EXPECT_LT(between * 0.01, 1.0) << "mm; the voxels' own slope";
}

TEST(Sewing, MovesWithTheSurface) {
  const Ball ball(Projection::orthographic);
  SurfaceOptions options;
  options.boundary = Boundary::exact;
  const ClippingSurface plain = buildClippingSurface(ball.camera, ball.volume, ball.focus, options);
  options.offset = 3.0;
  const ClippingSurface moved = buildClippingSurface(ball.camera, ball.volume, ball.focus, options);
  Random random(2, 0, 0);
  for (int i = 0; i < 1000; ++i) {
    const Vec2 at(uniform(random, -25, 25), uniform(random, -25, 25));
    EXPECT_NEAR(std::get<ClipDepth>(moved.clip).surface(at),
                std::get<ClipDepth>(plain.clip).surface(at) + 3.0, 1e-4);
  }
}

} // namespace
