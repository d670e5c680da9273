// Depth of the exact clipping surface between buffer samples: it must equal the depth of the focus.

#include "ClippingTesting.h"
#include "clip/surface/ClippingSurface.h"

#include <gtest/gtest.h>

namespace fenestra::core::SilhouetteCellsTests {
using namespace testing_clipping;

namespace {

constexpr std::array projections{Projection::orthographic, Projection::perspective};

/// Ball with pixels smaller than its voxels; its depth is steep at the outline.
struct Ball {
  Domain volume{makeCenteredGrid({60, 60, 60})};
  Mask focus = makeSphereMask(makeCenteredGrid({60, 60, 60}), 20.3);
  Camera camera;

  explicit Ball(Projection projection)
      : camera(makeAnteriorCamera(projection, 200.0, 30.0, 100, 100)) {}

  ClippingSurface surface() const {
    return buildClippingSurface(camera, volume, focus, {.boundary = Boundary::exact});
  }
};

/// Depth at which a ray enters the focus, found by ray marching.
double findFocusDepth(const Ball& ball, const Vec2& at) {
  const Ray ray = ball.camera.makePlaneRay(at);
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
  for (double t = 178.0; t < 222.0; t += 0.01)
    if (inside(t))
      return t * ball.camera.depthPerLength(ray);
  return infinity;
}

/// Points on both sides of the ball's outline on a radial line.
struct OutlinePoint {
  Vec2 inside, outside; ///< at most 1e-7 mm apart
};
OutlinePoint findOutlinePoint(const FocusTracer& tracer, const Vec2& direction) {
  double inner = 17.0, outer = 22.0;
  while (outer - inner > 1e-7) {
    const double middle = 0.5 * (inner + outer);
    (tracer.findDepths({middle * direction})[0] < infinity ? inner : outer) = middle;
  }
  return {inner * direction, outer * direction};
}

TEST(SilhouetteCells, DepthBetweenSamplesIsThatOfTheFocus) {
  for (const Projection projection : projections) {
    const Ball ball(projection);
    const ClippingSurface surface = ball.surface();
    const auto& clip = std::get<ClipDepth>(surface.clip);
    Random random(1, 0, 0);
    std::vector<double> differences;
    while (differences.size() < 400) {
      const double angle = uniform(random, 0.0, 2.0 * pi);
      const Vec2 at = uniform(random, 18.0, 21.0) * Vec2(std::cos(angle), std::sin(angle));
      if (const double depth = findFocusDepth(ball, at); depth < infinity)
        differences.push_back(std::abs(depth - clip.surfaceDepth(at)));
    }
    std::ranges::sort(differences);
    EXPECT_LT(differences[399], 0.02) << "the step of this test's ray marching";
  }
}

TEST(SilhouetteCells, SurfaceContinuesFromTheOutline) {
  for (const Projection projection : projections) {
    const Ball ball(projection);
    const ClippingSurface surface = ball.surface();
    const auto& clip = std::get<ClipDepth>(surface.clip);
    const FocusTracer tracer(ball.camera, ball.volume, ball.focus);
    std::vector<double> steps;
    for (int i = 0; i < 200; ++i) {
      const OutlinePoint outline =
          findOutlinePoint(tracer, {std::cos(0.0314 * i), std::sin(0.0314 * i)});
      const double depth = tracer.findDepths({outline.inside})[0];
      EXPECT_NEAR(clip.surfaceDepth(outline.inside), depth, 1e-4);
      steps.push_back(std::abs(clip.surfaceDepth(outline.outside) - depth));
    }
    std::ranges::sort(steps);
    EXPECT_LT(steps[190], 1e-3);
    EXPECT_LT(steps[199], 1.5) << "where the outlines of two voxels cross";
  }
}

TEST(SilhouetteCells, SurfaceDoesNotRiseTowardTheFocus) {
  const Ball ball(Projection::orthographic);
  const ClippingSurface surface = ball.surface();
  const auto& clip = std::get<ClipDepth>(surface.clip);
  const FocusTracer tracer(ball.camera, ball.volume, ball.focus);
  constexpr double step = 1e-3; // mm
  std::vector<double> slopes;
  for (int i = 0; i < 50; ++i) {
    const Vec2 direction(std::cos(0.126 * i), std::sin(0.126 * i));
    const double outline = findOutlinePoint(tracer, direction).outside.norm();
    for (double r = outline + 0.1; r < outline + 3.0; r += step)
      if (tracer.findDepths({r * direction, (r + step) * direction}) ==
          std::vector{infinity, infinity})
        slopes.push_back(
            std::abs(clip.surfaceDepth((r + step) * direction) - clip.surfaceDepth(r * direction)) /
            step);
  }
  std::ranges::sort(slopes);
  EXPECT_LT(slopes[slopes.size() * 998 / 1000], 2.0) << "that of the focus is over 5";
}

/// A tilted disk of 3 mm voxels, seen along an axis: ray maxima lie on planes of voxels.
struct Stairs {
  Grid grid{{24, 24, 24}, makeTranslation(Vec3::Constant(-34.5)) * makeScaling({3.0, 3.0, 3.0})};
  Domain volume{grid};
  Mask focus = makeSphereMask(grid, 25.0);
  Camera camera = makeAnteriorCamera(Projection::orthographic, 200.0, 30.0, 100, 100);

  Stairs() {
    for (std::int64_t i = 0; i < grid.size.prod(); ++i) {
      const Size3 voxel(i % 24, i / 24 % 24, i / 576);
      const Vec3 at = grid.indexToWorld * voxel.cast<double>();
      if (std::abs(at.y() - 0.5 * at.x() - 0.25 * at.z()) > 8.0)
        focus.voxels[static_cast<std::size_t>(i)] = 0;
    }
  }

  ClippingSurface surface() const {
    return buildClippingSurface(camera, volume, focus, {.boundary = Boundary::exact});
  }
};

TEST(SilhouetteCells, OutlineHasNoNotches) {
  const ClippingSurface surface = Stairs().surface();
  const FocusDepth& focus = surface.focus;
  const DepthBuffer& buffer = *std::get<ClipDepth>(surface.clip).buffer;
  std::vector<double> jumps; // between neighbors just outside the focus
  const auto isBeside = [&](std::int64_t c, std::int64_t r) {
    return !focus.isFocus(c, r) && (focus.isFocus(c + 1, r) || focus.isFocus(c - 1, r) ||
                                    focus.isFocus(c, r + 1) || focus.isFocus(c, r - 1));
  };
  for (std::int64_t r = 1; r + 1 < buffer.rows(); ++r)
    for (std::int64_t c = 1; c + 1 < buffer.columns(); ++c)
      for (const auto& [x, y] : {std::pair{1, 0}, {1, 1}, {0, 1}, {-1, 1}})
        if (isBeside(c, r) && isBeside(c + x, r + y))
          jumps.push_back(
              std::abs(buffer.at(buffer.sample(c, r)) - buffer.at(buffer.sample(c + x, r + y))));
  std::ranges::sort(jumps);
  EXPECT_LT(jumps[jumps.size() * 9 / 10], 0.5) << "of 3 mm voxels";
  EXPECT_LT(jumps.back(), 1.0);
}

TEST(SilhouetteCells, OutlineShowsTheFocusAndStepsAtMostAVoxel) {
  const Stairs stairs;
  const ClippingSurface surface = stairs.surface();
  const auto& clip = std::get<ClipDepth>(surface.clip);
  const FocusTracer tracer(stairs.camera, stairs.volume, stairs.focus);
  int hits = 0;
  Random random(4, 0, 0);
  for (int i = 0; i < 4000; ++i) {
    const Vec2 at(uniform(random, -29.0, 29.0), uniform(random, -29.0, 29.0));
    if (const double focus = tracer.findDepths({at})[0]; focus < infinity) {
      ++hits;
      ASSERT_NEAR(clip.surfaceDepth(at), focus, 1e-4) << at;
    }
  }
  EXPECT_GT(hits, 1000);
  std::vector<double> steps;
  for (const auto& [sample, rayMaximum, depth] : clip.silhouette->halo()) {
    const std::array<DepthQuery, 1> query{DepthQuery{
        clip.buffer->position(sample % clip.buffer->columns(), sample / clip.buffer->columns()),
        {150.0, 250.0}}};
    std::array<DepthHit, 1> hit;
    tracer.findHitsAndMaxima(query, hit);
    steps.push_back(std::abs(depth - hit[0].depth));
  }
  ASSERT_GT(steps.size(), 100U);
  std::ranges::sort(steps);
  EXPECT_LT(steps[steps.size() * 9 / 10], 3.0);
}

/// Two boxes, smoothed at their upper faces. The farther one is higher by half a voxel, or by
/// `extra` voxels more.
Mask makeBoxesBehindEachOther(int extra) {
  Mask mask;
  mask.grid = makeCenteredGrid({60, 60, 60});
  mask.names = {"A"};
  mask.maxValue = 255;
  const auto fall = [](std::int64_t above, std::uint8_t first, std::uint8_t second) {
    return above < 0    ? std::uint8_t{255}
           : above == 0 ? first
           : above == 1 ? second
                        : std::uint8_t{0};
  };
  for (std::int64_t i = 0; i < mask.grid.size.prod(); ++i) {
    const Size3 at(i % 60, i / 60 % 60, i / 3600);
    const bool isWithin = at.x() >= 15 && at.x() < 45 && at.z() >= 20;
    mask.voxels.push_back(!isWithin                     ? std::uint8_t{0}
                          : at.y() >= 20 && at.y() < 27 ? fall(at.z() - 40, 115, 90)
                          : at.y() >= 45 && at.y() < 52 ? fall(at.z() - 40 - extra, 150, 100)
                                                        : std::uint8_t{0});
  }
  mask.count = mask.countInside();
  return mask;
}

/// In slots of half a voxel are some samples per row of pixels, or only one.
TEST(SilhouetteCells, NarrowSlotsAlongTheOutlineAreClosed) {
  constexpr double near = 190.0, far = 215.0, halfHeight = 12.0; // mm
  for (const int pixels : {120, 40})
    for (const int extra : {0, 6}) {
      SCOPED_TRACE(::testing::Message() << pixels << " pixels, extra " << extra);
      const Mask focus = makeBoxesBehindEachOther(extra);
      const ClippingSurface surface = buildClippingSurface(
          makeAnteriorCamera(Projection::orthographic, 200.0, halfHeight, pixels, pixels),
          Domain(focus.grid), focus, {.boundary = Boundary::exact});
      const auto& clip = std::get<ClipDepth>(surface.clip);
      for (double x = -8.0; x < 8.0; x += 0.7) {
        EXPECT_NEAR(clip.surfaceDepth(Vec2(x, 8.0)), near, 1e-3);
        EXPECT_NEAR(clip.surfaceDepth(Vec2(x, 10.7)), extra > 0 ? far : near,
                    extra > 0 ? 1e-3 : 2.0) // the slope of the near box continues
            << "between the upper faces, at 10.4 and 10.9";
      }
      const auto countFocus = [](const FocusDepth& focus) {
        return static_cast<double>(std::ranges::count(focus.regions, Region::focus));
      };
      const double pitch = 2.0 * halfHeight / pixels;
      const double closed = pitch * pitch * (countFocus(surface.focus) - countFocus(surface.shown));
      EXPECT_GE(closed, extra > 0 ? 0.0 : 4.0) << "mm^2";
      EXPECT_LE(closed, extra > 0 ? 1.6 : 24.0) << "mm^2, beside the step of the outline";
    }
}

TEST(SilhouetteCells, ClipWeightEqualsThatOfTheFullSurface) {
  // clipWeight() evaluates only the part of the surface that affects its result.
  for (const Projection projection : projections)
    for (const double softness : {0.0, 1.5}) {
      const Ball ball(projection);
      SurfaceOptions options;
      options.boundary = Boundary::exact;
      options.offset = softness;
      options.edge = {0.25, softness};
      const CropBox crop(makeTranslation({0.0, 10.0, 4.0}) * makeScaling({30.0, 22.0, 20.0}));
      const ClippingSurface surface =
          buildClippingSurface(ball.camera, Domain(ball.volume.grid(), crop), ball.focus, options);
      const auto& clip = std::get<ClipDepth>(surface.clip);
      Random random(3, 0, 0);
      int partialCount = 0;
      for (int i = 0; i < 5000; ++i) {
        const Vec2 position(uniform(random, -22.0, 22.0), uniform(random, -22.0, 22.0));
        const double depth = clip.surfaceDepth(position) + uniform(random, -4.0, 4.0);
        const Vec3 world = fromBuffer(ball.camera, {position.x(), position.y(), depth});
        const Vec3 at = toBuffer(ball.camera, world);
        const double expected = clip.edge(at.z() - clip.surfaceDepth(at.head<2>()));
        partialCount += expected > 0.25 && expected < 1.0;
        ASSERT_NEAR(clipWeight(clip, world), expected, 1e-6) << position << ' ' << depth;
        const auto bounds = clip.pyramid->bounds(*clip.buffer, position, position);
        ASSERT_GE(clip.surfaceDepth(position), bounds.begin - 1e-4);
        ASSERT_LE(clip.surfaceDepth(position), bounds.end + 1e-4);
      }
      EXPECT_EQ(partialCount > 250, softness > 0.0);
    }
}

TEST(SilhouetteCells, DepthIsThatOfASmoothedFocus) {
  Ball ball(Projection::orthographic);
  ball.focus = makeMask(ball.volume.grid(), [](const Vec3&) { return false; });
  ball.focus.maxValue = 255;
  for (std::size_t i = 0; i < ball.focus.voxels.size(); ++i) {
    const auto n = static_cast<std::int64_t>(i);
    const Vec3 p = ball.volume.grid().indexToWorld * Vec3(static_cast<double>(n % 60),
                                                          static_cast<double>(n / 60 % 60),
                                                          static_cast<double>(n / 3600));
    ball.focus.voxels[i] = static_cast<std::uint8_t>(
        std::lround(255.0 * std::clamp(0.5 + 0.25 * (20.3 - p.norm()), 0.0, 1.0)));
  }
  const ClippingSurface surface = ball.surface();
  const auto& clip = std::get<ClipDepth>(surface.clip);
  const FocusTracer tracer(ball.camera, ball.volume, ball.focus);
  for (int i = 0; i < 100; ++i) {
    const OutlinePoint outline =
        findOutlinePoint(tracer, {std::cos(0.0628 * i), std::sin(0.0628 * i)});
    EXPECT_NEAR(outline.inside.norm(), 20.3, 0.05);
    EXPECT_NEAR(clip.surfaceDepth(outline.outside), 200.0, 1.0) << "the depth of the ball's center";
    EXPECT_NEAR(clip.surfaceDepth(outline.outside), clip.surfaceDepth(outline.inside), 0.01);
    EXPECT_NEAR(clip.surfaceDepth(1.02 * outline.outside), 200.0, 1.0);
  }
}

TEST(SilhouetteCells, SelfOccludingFocusHasTheFartherDepthBetween) {
  // The right half lies 10 mm deeper.
  const Grid volume = makeCenteredGrid({60, 60, 60});
  const Mask focus = makeMask(volume, [](const Vec3& p) {
    return std::abs(p.x()) < 16.0 && std::abs(p.z()) < 16.0 &&
           std::abs(p.y() - (p.x() > 0.0 ? 10.0 : 0.0)) < 6.0;
  });
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 100, 30, 77, 77);
  const ClippingSurface surface =
      buildClippingSurface(camera, volume, focus, {.boundary = Boundary::exact});
  const auto& clip = std::get<ClipDepth>(surface.clip);
  int partialCount = 0;
  for (double x = -3.0; x < 3.0; x += 0.01) {
    const double depth = clip.surfaceDepth({x, 0.3});
    partialCount += depth > 95.0 && depth < 103.0;
  }
  EXPECT_LT(partialCount * 0.01, 1.0) << "mm; the slope of the voxels themselves";
}

TEST(SilhouetteCells, OffsetShiftsTheDepth) {
  const Ball ball(Projection::orthographic);
  SurfaceOptions options;
  options.boundary = Boundary::exact;
  const ClippingSurface plain = buildClippingSurface(ball.camera, ball.volume, ball.focus, options);
  options.offset = 3.0;
  const ClippingSurface shifted =
      buildClippingSurface(ball.camera, ball.volume, ball.focus, options);
  Random random(2, 0, 0);
  for (int i = 0; i < 1000; ++i) {
    const Vec2 at(uniform(random, -25, 25), uniform(random, -25, 25));
    EXPECT_NEAR(std::get<ClipDepth>(shifted.clip).surfaceDepth(at),
                std::get<ClipDepth>(plain.clip).surfaceDepth(at) + 3.0, 1e-4);
  }
}

} // namespace
} // namespace fenestra::core::SilhouetteCellsTests
