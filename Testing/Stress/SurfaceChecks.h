#pragma once
// Properties of every clipping surface: every depth is finite, the focus keeps its own depth, and
// clipWeight is defined everywhere and agrees with visibleInterval and boundClipWeight.

#include "Unit/ClippingTesting.h"
#include "clip/surface/ClippingSurface.h"
#include "clip/surface/ThinPlateSpline.h"

#include <gtest/gtest.h>

#include <set>

namespace fenestra::core::SurfaceStressTests {
using namespace testing_clipping;

inline constexpr std::array projections{Projection::orthographic, Projection::perspective};
inline constexpr std::array smoothings{0.0, 0.5, 1.0};

struct View {
  Camera camera;
  Grid volume;
  Mask focus;

  ClippingSurface surface(const SurfaceOptions& options) const {
    return buildClippingSurface(camera, volume, focus, options);
  }
};

/// Expects a depth in the focus's depth range, extended because the spline extrapolates slopes.
inline void expectBounded(double depth, const ClippingSurface& surface, const View& view) {
  double least = infinity, greatest = -infinity;
  for (std::int64_t i = 0; i < surface.focus.depth.size(); ++i)
    if (const double focus = surface.focus.depth.at(i); focus < infinity) {
      least = std::min(least, focus);
      greatest = std::max(greatest, focus);
    }
  const double distance = 2.0 * view.volume.boundingRadius();
  ASSERT_GE(depth, least - distance);
  ASSERT_LE(depth, greatest + distance);
}

/// True if the sample or one beside it is in a closed slot (SilhouetteCells.h).
inline bool isAtSlot(const ClippingSurface& surface, std::int64_t column, std::int64_t row) {
  for (std::int64_t r = row - 1; r <= row + 1; ++r)
    for (std::int64_t c = column - 1; c <= column + 1; ++c)
      if (surface.focus.isFocus(c, r) && !surface.shown.isFocus(c, r))
        return true;
  return false;
}

/// Expects focus samples to keep their depth, except at slots. Other samples must have the spline's
/// depth, a finite depth near the focus, or, in a cutaway and outside a hole, -infinity: nothing is
/// removed.
inline void expectDepths(const View& view, const ClippingSurface& surface,
                         const SurfaceOptions& options) {
  const auto& clip = std::get<ClipDepth>(surface.clip);
  std::vector<Vec2> sites;
  std::vector<double> depths;
  for (const ControlPoint& point : surface.controlPoints) {
    sites.push_back(point.site);
    depths.push_back(point.depth);
  }
  const ThinPlateSpline spline(sites, depths, options.smoothing);
  const DepthBuffer& buffer = *clip.buffer;
  const double depth = clip.camera.targetDepth();
  const std::int64_t stride = 1 + buffer.rows() / 200; // skips rows of large buffers
  for (std::int64_t row = 0; row < buffer.rows(); row += stride)
    for (std::int64_t column = 0; column < buffer.columns(); ++column) {
      const std::int64_t i = buffer.sample(column, row);
      if (surface.focus.isFocus(column, row)) {
        ASSERT_TRUE(std::isfinite(buffer.at(i)));
        if (clip.silhouette && isAtSlot(surface, column, row)) {
          ASSERT_TRUE(std::isfinite(clip.surfaceDepth(buffer.position(column, row))));
        } else if (clip.silhouette) {
          const double exact = clip.surfaceDepth(buffer.position(column, row));
          ASSERT_NEAR(exact, surface.focus.depth.at(i), 1e-6 * (std::abs(exact) + depth));
        } else {
          ASSERT_EQ(buffer.at(i), surface.focus.depth.at(i));
        }
        ASSERT_TRUE(clip.camera.pose().projection == Projection::orthographic ||
                    buffer.at(i) >= -1e-6 * depth);
        continue;
      }
      ASSERT_EQ(surface.focus.depth.at(i), infinity);
      if (options.mode == SurfaceMode::cutaway) {
        ASSERT_EQ(buffer.at(i), -infinity);
      } else if (options.mode == SurfaceMode::hole || options.boundary == Boundary::exact) {
        if (options.mode == SurfaceMode::surface || buffer.at(i) > -infinity)
          expectBounded(buffer.at(i), surface, view);
      } else {
        const double f = spline(buffer.position(column, row));
        ASSERT_TRUE(std::isfinite(buffer.at(i)));
        ASSERT_NEAR(buffer.at(i), f, 1e-6 * (std::abs(f) + depth)); // precision of float
      }
    }
}

/// Expects distinct focus samples, at most the requested number, and a consistent mismatch.
inline void expectControlPoints(const ClippingSurface& surface, const SurfaceOptions& options) {
  const auto requested = static_cast<std::size_t>(options.controlPoints);
  EXPECT_GE(surface.controlPoints.size(), 1U);
  EXPECT_LE(surface.controlPoints.size(), requested);
  std::set<std::pair<double, double>> sites;
  for (const ControlPoint& point : surface.controlPoints) {
    EXPECT_TRUE(sites.insert({point.site.x(), point.site.y()}).second);
    EXPECT_EQ(surface.focus.depth.nearestDepth(point.site), point.depth);
  }
  const Distribution& mismatch = surface.mismatch.value();
  EXPECT_GE(mismatch.mean, 0.0);
  EXPECT_LE(mismatch.mean, mismatch.max * (1.0 + 1e-12));
  EXPECT_LE(mismatch.p95, mismatch.max);
  EXPECT_TRUE(std::isfinite(mismatch.max));
  EXPECT_EQ(std::ranges::count(surface.warnings, ErrorCode::tinyFocus, &Message::code),
            surface.controlPoints.size() < std::min<std::size_t>(3, requested) ? 1 : 0);
}

/// Expects clip weights 0 or 1 everywhere: up to double's limits, and where projection fails.
inline void expectClipWeightEverywhere(const View& view, const Clip& clip) {
  Random random(1, 0, 0);
  const Camera& camera = view.camera;
  const Vec3 center = view.volume.worldCenter();
  const Vec3& cameraPosition = camera.pose().position;
  std::vector<Vec3> points{center,
                           cameraPosition,
                           cameraPosition + 1e-300 * camera.forward(),
                           cameraPosition + camera.right(),
                           cameraPosition - 1e300 * camera.forward(),
                           center + Vec3::Constant(1e300)};
  for (const double distance : {1.0, 3.0, 1e3, 1e9})
    for (int i = 0; i < 200; ++i)
      points.push_back(center +
                       distance * view.volume.boundingRadius() * randomPoint(random, -1, 1));
  for (const Vec3& point : points) {
    const double weight = clipWeight(clip, point);
    ASSERT_TRUE(weight == 0.0 || weight == 1.0) << point;
    if (isBehindCamera(camera, camera.toView(point).z())) {
      ASSERT_EQ(weight, 0.0);
    }
  }
}

/// Expects camera rays to have clip weight 1 from the start of visibleInterval, and 0 before.
inline void expectVisibleInterval(const View& view, const Clip& clip) {
  Random random(2, 0, 0);
  const Camera& camera = view.camera;
  for (int i = 0; i < 500; ++i) {
    const Ray ray =
        camera.makeRay(uniform(random, 0, camera.width()), uniform(random, 0, camera.height()));
    const Interval interval = visibleInterval(clip, ray);
    ASSERT_TRUE(std::isfinite(interval.begin) && interval.begin >= 0.0);
    ASSERT_EQ(interval.end, infinity);
    // A position's rounding error times the surface's slope is an error of depth.
    const double step = 1e-9 * (ray.origin.norm() + interval.begin + camera.targetDepth()) + 1e-6;
    ASSERT_EQ(clipWeight(clip, ray.at(interval.begin + step)), 1.0) << interval.begin;
    ASSERT_EQ(clipWeight(clip, ray.at(2.0 * interval.begin + 1e3)), 1.0) << interval.begin;
    if (interval.begin > 2.0 * step) {
      ASSERT_EQ(clipWeight(clip, ray.at(interval.begin - step)), 0.0) << interval.begin;
      ASSERT_EQ(clipWeight(clip, ray.at(interval.begin * random.uniform() * 0.999)), 0.0)
          << interval.begin;
    }
  }
}

/// Expects bounds of 0 or 1 only for boxes without any point of another clip weight.
inline void expectBoxes(const View& view, const Clip& clip) {
  Random random(3, 0, 0);
  const double radius = view.volume.boundingRadius();
  for (int i = 0; i < 500; ++i) {
    const Vec3 center = view.volume.worldCenter() + radius * randomPoint(random, -1, 1);
    const Vec3 half = radius * std::pow(random.uniform(), 4.0) * randomPoint(random, 0.01, 1);
    const Box box{center - half, center + half};
    Corners corners;
    for (int corner = 0; corner < 8; ++corner)
      corners[static_cast<std::size_t>(corner)] = box.corner(corner);
    const ClipBounds bounds = boundClipWeight(clip, corners);
    for (int point = 0; point < 16; ++point) {
      const double weight =
          clipWeight(clip, center + half.cwiseProduct(randomPoint(random, -1, 1)));
      ASSERT_FALSE(bounds == ClipBounds::none && weight > 0.0);
      ASSERT_FALSE(bounds == ClipBounds::all && weight < 1.0);
    }
  }
}

/// Expects the cut to end where the focus begins, at the centers of the image's focus pixels,
/// except at slots. An exact cut may end behind a steep focus surface.
inline void expectFocusVisible(const View& view, const ClippingSurface& surface,
                               Boundary boundary) {
  const DepthBuffer& buffer = surface.focus.depth;
  for (int row = 0; row < view.camera.height(); ++row)
    for (int column = 0; column < view.camera.width(); ++column) {
      const std::int64_t sample = buffer.viewportSample(column, row);
      if (!(buffer.at(sample) < infinity) ||
          isAtSlot(surface, sample % buffer.columns(), sample / buffer.columns()))
        continue;
      const Ray ray = view.camera.makeRay(column + 0.5, row + 0.5);
      const double begin = buffer.at(sample) / view.camera.depthPerLength(ray);
      const double step = 1e-6 * (std::abs(begin) + ray.origin.norm() + view.camera.targetDepth());
      ASSERT_EQ(clipWeight(surface.clip, ray.at(begin - step)), 0.0);
      if (boundary == Boundary::spline) {
        ASSERT_EQ(clipWeight(surface.clip, ray.at(begin + step)), 1.0);
      }
    }
}

inline void expectValid(const View& view, const SurfaceOptions& options) {
  const ClippingSurface surface = view.surface(options);
  expectDepths(view, surface, options);
  if (options.mode == SurfaceMode::surface && options.boundary == Boundary::spline)
    expectControlPoints(surface, options);
  expectClipWeightEverywhere(view, surface.clip);
  expectVisibleInterval(view, surface.clip);
  expectBoxes(view, surface.clip);
  expectFocusVisible(view, surface, options.boundary);
}

/// For every edge and offset, expects clip weights within the bounds of boxes, and at least the
/// ghost in front of the camera.
inline void expectEdges(const View& view) {
  Random random(4, 0, 0);
  const double radius = view.volume.boundingRadius();
  for (const ClipEdge& edge : {ClipEdge{0.3, 0.0}, ClipEdge{1.0, 0.0}, ClipEdge{0.0, 1e-12},
                               ClipEdge{0.3, radius}, ClipEdge{0.0, 1e12}})
    for (const double offset : {0.0, -1e5, 1e5}) {
      SurfaceOptions options;
      options.boundary = Boundary::exact;
      options.offset = offset;
      options.edge = edge;
      const Clip clip = view.surface(options).clip;
      for (int i = 0; i < 100; ++i) {
        const Vec3 lower = view.volume.worldCenter() + radius * randomPoint(random, -1, 1);
        const Box box{lower, lower + radius * std::pow(random.uniform(), 4.0) * Vec3::Ones()};
        Corners corners;
        for (int corner = 0; corner < 8; ++corner)
          corners[static_cast<std::size_t>(corner)] = box.corner(corner);
        const ClipBounds bounds = boundClipWeight(clip, corners);
        for (int point = 0; point < 8; ++point) {
          const Vec3 at =
              lower + Vec3(box.upper - lower).cwiseProduct(randomPoint(random, 0.0, 1.0));
          const double weight = clipWeight(clip, at);
          const bool isBehind = isBehindCamera(view.camera, view.camera.toView(at).z());
          ASSERT_GE(weight, isBehind ? 0.0 : edge.ghost);
          ASSERT_LE(weight, bounds.max);
          ASSERT_TRUE(!bounds.isUniform || weight == bounds.max);
        }
      }
    }
}

/// Tests every mode, smoothing and number of control points; only one case for large buffers.
inline void expectValid(const View& view) {
  if (DepthBuffer(view.camera, view.volume).size() > 40'000)
    return expectValid(view, {.controlPoints = 30, .smoothing = 1.0});
  expectValid(view, {.mode = SurfaceMode::cutaway});
  expectValid(view, {.boundary = Boundary::exact});
  for (const HoleShape shape : {HoleShape::box, HoleShape::cylinder, HoleShape::sphere})
    for (const double margin : {0.0, 5.0})
      expectValid(view, {.mode = SurfaceMode::hole, .hole = {shape, margin}});
  expectEdges(view);
  for (const double smoothing : smoothings)
    for (const int points : {1, 3, 50, 300}) {
      SCOPED_TRACE("p " + std::to_string(smoothing) + ", points " + std::to_string(points));
      expectValid(view, {.controlPoints = points, .smoothing = smoothing});
    }
}

} // namespace fenestra::core::SurfaceStressTests
