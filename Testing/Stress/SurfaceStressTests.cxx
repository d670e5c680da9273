// Clipping surface of awkward focuses and views: every depth is finite, the focus keeps its own
// depth, keep is defined everywhere and agrees with visible and keptIn.

#include "Unit/ClippingTesting.h"
#include "base/Error.h"
#include "clip/surface/ClippingSurface.h"
#include "clip/surface/ThinPlateSpline.h"

#include <gtest/gtest.h>

#include <set>

namespace fenestra::SurfaceStressTests {
using namespace testing_clipping;

namespace {

constexpr std::array projections{Projection::orthographic, Projection::perspective};
constexpr std::array smoothings{0.0, 0.5, 1.0};

struct View {
  Camera camera;
  Grid volume;
  Mask focus;

  ClippingSurface surface(const SurfaceOptions& options) const {
    return buildClippingSurface(camera, volume, focus, options);
  }
};

// ---- properties of every surface

/// Expects a depth in the focus's range, extended by a length for extrapolated slopes.
void expectBounded(double depth, const ClippingSurface& surface, const View& view) {
  double least = infinity, greatest = -infinity;
  for (std::int64_t i = 0; i < surface.focus.depth.size(); ++i)
    if (const double focus = surface.focus.depth.at(i); focus < infinity) {
      least = std::min(least, focus);
      greatest = std::max(greatest, focus);
    }
  const double reach = 2.0 * view.volume.boundingRadius();
  ASSERT_GE(depth, least - reach);
  ASSERT_LE(depth, greatest + reach);
}

/// Expects focus samples to keep their depth, and other samples to have the spline's depth, or some
/// finite depth near the focus, or, in a cutaway and beside a hole, nothing to remove.
void expectDepths(const View& view, const ClippingSurface& surface, const SurfaceOptions& options) {
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
  const std::int64_t stride = 1 + buffer.rows() / 200; // fewer rows, for speed
  for (std::int64_t row = 0; row < buffer.rows(); row += stride)
    for (std::int64_t column = 0; column < buffer.columns(); ++column) {
      const std::int64_t i = buffer.sample(column, row);
      if (surface.focus.isFocus(column, row)) {
        ASSERT_TRUE(std::isfinite(buffer.at(i)));
        ASSERT_EQ(buffer.at(i), surface.focus.depth.at(i));
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
        ASSERT_NEAR(buffer.at(i), f, 1e-6 * (std::abs(f) + depth)); // a float's precision
      }
    }
}

/// Expects distinct focus samples, at most the requested number, and consistent mismatches.
void expectControlPoints(const ClippingSurface& surface, const SurfaceOptions& options) {
  const auto asked = static_cast<std::size_t>(options.controlPoints);
  EXPECT_GE(surface.controlPoints.size(), 1U);
  EXPECT_LE(surface.controlPoints.size(), asked);
  std::set<std::pair<double, double>> sites;
  for (const ControlPoint& point : surface.controlPoints) {
    EXPECT_TRUE(sites.insert({point.site.x(), point.site.y()}).second);
    EXPECT_EQ(surface.focus.depth.nearest(point.site), point.depth);
  }
  const BoundaryMismatch& mismatch = surface.mismatch.value();
  EXPECT_GE(mismatch.mean, 0.0);
  EXPECT_LE(mismatch.mean, mismatch.max * (1.0 + 1e-12));
  EXPECT_LE(mismatch.p95, mismatch.max);
  EXPECT_TRUE(std::isfinite(mismatch.max));
  const std::string flat = "the focus covers hardly a pixel: the clipping surface is flat";
  EXPECT_EQ(std::ranges::count(surface.warnings, flat),
            surface.controlPoints.size() < std::min<std::size_t>(3, asked) ? 1 : 0);
}

/// Expects 0 or 1 in and around the volume, up to double's limits, and where projection fails.
void expectKeepEverywhere(const View& view, const Clip& clip) {
  Random random(1, 0, 0);
  const Camera& camera = view.camera;
  const Vec3 center = view.volume.worldCenter();
  const Vec3& eye = camera.pose().position;
  std::vector<Vec3> points{center,
                           eye,
                           eye + 1e-300 * camera.forward(),
                           eye + camera.right(),
                           eye - 1e300 * camera.forward(),
                           center + Vec3::Constant(1e300)};
  for (const double reach : {1.0, 3.0, 1e3, 1e9})
    for (int i = 0; i < 200; ++i)
      points.push_back(center + reach * view.volume.boundingRadius() * randomPoint(random, -1, 1));
  for (const Vec3& point : points) {
    const double kept = keep(clip, point);
    ASSERT_TRUE(kept == 0.0 || kept == 1.0) << point;
    if (behindEye(camera, camera.toView(point).z())) {
      ASSERT_EQ(kept, 0.0);
    }
  }
}

/// Expects eye rays to be kept from the start of visible on, and not before.
void expectVisible(const View& view, const Clip& clip) {
  Random random(2, 0, 0);
  const Camera& camera = view.camera;
  for (int i = 0; i < 500; ++i) {
    const Ray ray =
        camera.ray(uniform(random, 0, camera.width()), uniform(random, 0, camera.height()));
    const Interval seen = visible(clip, ray);
    ASSERT_TRUE(std::isfinite(seen.begin) && seen.begin >= 0.0);
    ASSERT_EQ(seen.end, infinity);
    // Rounding of a position times the surface's slope is an error of depth.
    const double step = 1e-9 * (ray.origin.norm() + seen.begin + camera.targetDepth()) + 1e-6;
    ASSERT_EQ(keep(clip, ray.at(seen.begin + step)), 1.0) << seen.begin;
    ASSERT_EQ(keep(clip, ray.at(2.0 * seen.begin + 1e3)), 1.0) << seen.begin;
    if (seen.begin > 2.0 * step) {
      ASSERT_EQ(keep(clip, ray.at(seen.begin - step)), 0.0) << seen.begin;
      ASSERT_EQ(keep(clip, ray.at(seen.begin * random.uniform() * 0.999)), 0.0) << seen.begin;
    }
  }
}

/// Expects no box to be reported as wholly kept, or removed, if a point of it is not.
void expectBoxes(const View& view, const Clip& clip) {
  Random random(3, 0, 0);
  const double radius = view.volume.boundingRadius();
  for (int i = 0; i < 500; ++i) {
    const Vec3 center = view.volume.worldCenter() + radius * randomPoint(random, -1, 1);
    const Vec3 half = radius * std::pow(random.uniform(), 4.0) * randomPoint(random, 0.01, 1);
    const Box box{center - half, center + half};
    Corners corners;
    for (int corner = 0; corner < 8; ++corner)
      corners[static_cast<std::size_t>(corner)] = box.corner(corner);
    const Kept verdict = keptIn(clip, corners);
    for (int point = 0; point < 16; ++point) {
      const double kept = keep(clip, center + half.cwiseProduct(randomPoint(random, -1, 1)));
      ASSERT_FALSE(verdict == Kept::none && kept > 0.0);
      ASSERT_FALSE(verdict == Kept::all && kept < 1.0);
    }
  }
}

/// Expects the cut to end where the focus begins, at the centres of the picture's focus pixels; an
/// exact cut may end behind, where the focus falls away steeply.
void expectFocusShown(const View& view, const ClippingSurface& surface, Boundary boundary) {
  const DepthBuffer& buffer = surface.focus.depth;
  for (int row = 0; row < view.camera.height(); ++row)
    for (int column = 0; column < view.camera.width(); ++column) {
      const std::int64_t sample = buffer.viewportSample(column, row);
      if (!(buffer.at(sample) < infinity))
        continue;
      const Ray ray = view.camera.ray(column + 0.5, row + 0.5);
      const double begin = buffer.at(sample) / view.camera.depthPerLength(ray);
      const double step = 1e-6 * (std::abs(begin) + ray.origin.norm() + view.camera.targetDepth());
      ASSERT_EQ(keep(surface.clip, ray.at(begin - step)), 0.0);
      if (boundary == Boundary::spline) {
        ASSERT_EQ(keep(surface.clip, ray.at(begin + step)), 1.0);
      }
    }
}

void expectSound(const View& view, const SurfaceOptions& options) {
  const ClippingSurface surface = view.surface(options);
  expectDepths(view, surface, options);
  if (options.mode == SurfaceMode::surface && options.boundary == Boundary::spline)
    expectControlPoints(surface, options);
  expectKeepEverywhere(view, surface.clip);
  expectVisible(view, surface.clip);
  expectBoxes(view, surface.clip);
  expectFocusShown(view, surface, options.boundary);
}

/// For every edge and offset, expects keep in [0, 1], at least the ghost in front of the eye, and
/// bounded by boxes.
void expectEdges(const View& view) {
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
        const Kept verdict = keptIn(clip, corners);
        for (int point = 0; point < 8; ++point) {
          const Vec3 at =
              lower + Vec3(box.upper - lower).cwiseProduct(randomPoint(random, 0.0, 1.0));
          const double kept = keep(clip, at);
          const bool isBehind = behindEye(view.camera, view.camera.toView(at).z());
          ASSERT_GE(kept, isBehind ? 0.0 : edge.ghost);
          ASSERT_LE(kept, verdict.most);
          ASSERT_TRUE(!verdict.isUniform || kept == verdict.most);
        }
      }
    }
}

/// Tests every mode, smoothing and number of control points; for large buffers only one.
void expectSound(const View& view) {
  if (DepthBuffer(view.camera, view.volume).size() > 40'000)
    return expectSound(view, {.controlPoints = 30, .smoothing = 1.0});
  expectSound(view, {.mode = SurfaceMode::cutaway});
  expectSound(view, {.boundary = Boundary::exact});
  for (const HoleShape shape : {HoleShape::box, HoleShape::cylinder, HoleShape::sphere})
    for (const double margin : {0.0, 5.0})
      expectSound(view, {.mode = SurfaceMode::hole, .hole = {shape, margin}});
  expectEdges(view);
  for (const double smoothing : smoothings)
    for (const int points : {1, 3, 50, 300}) {
      SCOPED_TRACE("p " + std::to_string(smoothing) + ", points " + std::to_string(points));
      expectSound(view, {.controlPoints = points, .smoothing = smoothing});
    }
}

// ---- the focuses

const Grid cube = centredGrid({32, 32, 32});

/// Tests views from 100 mm in front, `scale` mm up and down at the centre.
void expectSoundFromFront(const Mask& focus, double scale, const Grid& volume = cube) {
  for (const auto projection : projections)
    for (const auto& [width, height] : {std::pair{40, 30}, std::pair{5, 13}}) {
      SCOPED_TRACE(projection == Projection::perspective ? "perspective" : "orthographic");
      expectSound({anteriorCamera(projection, 100.0, scale, width, height), volume, focus});
    }
}

Mask oneVoxel() {
  return boxMask(cube, Vec3::Constant(0.1), Vec3::Constant(0.9));
}

TEST(SurfaceStress, OneVoxel) {
  for (const double scale : {0.9, 4.0})
    expectSoundFromFront(oneVoxel(), scale);
}

TEST(SurfaceStress, OnePixel) {
  const Camera camera = anteriorCamera(Projection::orthographic, 100.0, 20.0, 40, 40);
  const View view{camera, cube, oneVoxel()};
  const ClippingSurface surface = view.surface({});
  EXPECT_EQ(surface.controlPoints.size(), 1U);
  EXPECT_EQ(surface.warnings.size(), 1U);
  EXPECT_EQ(surface.warnings[0], "the focus covers hardly a pixel: the clipping surface is flat");
  expectSound(view);
}

TEST(SurfaceStress, AFocusAtTheVolumesBorder) {
  for (const Vec3& corner : {Vec3(-16, -16, -16), Vec3(16, 16, 16), Vec3(-16, 16, 0)}) {
    const Mask focus =
        maskOf(cube, [&](const Vec3& p) { return (p - corner).cwiseAbs().maxCoeff() < 9.0; });
    expectSoundFromFront(focus, 20.0);
    expectSoundFromFront(focus, 10.0);
  }
}

TEST(SurfaceStress, AFocusThatFillsTheView) {
  const Mask everything = maskOf(cube, [](const Vec3&) { return true; });
  for (const double scale : {5.0, 15.9, 16.0, 40.0})
    expectSoundFromFront(everything, scale);
  for (const auto projection : projections) { // the face is at -16 for every ray
    const View view{anteriorCamera(projection, 50.0, 7.0, 20, 20), cube, everything};
    const FocusDepth focus = view.surface({}).focus;
    for (int pixel = 0; pixel < 400; ++pixel) {
      ASSERT_NEAR(focus.depth.at(focus.depth.viewportSample(pixel % 20, pixel / 20)), 34.0, 1e-4);
    }
  }
  expectSoundFromFront(boxMask(cube, {-11, -9, -11}, {11, 9, 11}), 8.0);
  expectSoundFromFront(sphereMask(cube, 14.0), 3.0);
}

TEST(SurfaceStress, ManyComponents) {
  const auto every = [](const Vec3& p, double n) {
    const Vec3 cell = (p.array() + 15.5) / n;
    return cell == Vec3(cell.array().floor());
  };
  for (const double n : {2.0, 3.0, 10.0})
    expectSoundFromFront(maskOf(cube, [&](const Vec3& p) { return every(p, n); }), 17.0);
}

TEST(SurfaceStress, Holes) {
  const Mask plate = maskOf(cube, [](const Vec3& p) {
    const bool isHole = std::hypot(std::remainder(p.x(), 8.0), std::remainder(p.z(), 8.0)) < 2.5;
    return std::abs(p.y()) < 3.0 && !isHole;
  });
  expectSoundFromFront(plate, 17.0);
  const Mask ring = maskOf(cube, [](const Vec3& p) {
    return std::abs(p.y() - 0.3 * p.x()) < 2.0 && std::abs(std::hypot(p.x(), p.z()) - 10.0) < 1.1;
  });
  expectSoundFromFront(ring, 17.0);
}

TEST(SurfaceStress, ASheetSeenEdgeOn) {
  // Sheet one voxel thick along the view: exactly parallel, and where the sheet is a staircase.
  for (const double tilt : {0.0, 1e-3, 0.3}) {
    const Mask sheet = maskOf(cube, [&](const Vec3& p) {
      const double x = p.x() - tilt * p.y();
      return x >= 0.0 && x < 1.0 && std::abs(p.z()) < 9.0;
    });
    for (const double scale : {5.0, 15.0, 17.0})
      expectSoundFromFront(sheet, scale);
  }
}

TEST(SurfaceStress, DepthJumps) {
  // Stripes and a chequerboard of plates, two voxels thick each, 500 mm apart.
  const Grid deep = centredGrid({32, 32, 32}, {1.0, 20.0, 1.0});
  const auto plate = [](const Vec3& p, bool isNear) {
    return std::abs(p.y() + (isNear ? 250.0 : -250.0)) < 20.0;
  };
  for (const double width : {1.0, 5.0}) {
    const auto isOdd = [&](double x) { return std::fmod(std::floor(x / width) + 100.0, 2.0) > 0; };
    for (const auto projection : projections) {
      const Camera camera = anteriorCamera(projection, 700.0, 17.0, 40, 40);
      expectSound(
          {camera, deep, maskOf(deep, [&](const Vec3& p) { return plate(p, isOdd(p.x())); })});
      expectSound({camera, deep, maskOf(deep, [&](const Vec3& p) {
                     return plate(p, isOdd(p.x()) != isOdd(p.z()));
                   })});
    }
  }
}

// ---- the views

/// Camera whose middle pixel looks at the target.
Camera camera(Projection projection, const Vec3& from, const Vec3& to, double scale,
              double angle = 40.0, const Vec3& up = {0.1, 0.2, 1.0}) {
  CameraPose pose;
  pose.projection = projection;
  pose.position = from;
  pose.target = to;
  pose.scale = scale;
  pose.angle = angle;
  pose.up = up;
  return {pose, 17, 13};
}

TEST(SurfaceStress, TheCameraInsideTheVolume) {
  const Mask ball = sphereMask(cube, 6.0);
  for (const auto projection : projections)
    for (const Vec3& from : {Vec3(10, -11, 3), Vec3(8, 0, 0), Vec3(-16, -16, -16), Vec3(2, 1, 3)})
      for (const double angle : {20.0, 120.0}) {
        SCOPED_TRACE(from);
        expectSound({camera(projection, from, Vec3::Zero(), 5.0, angle), cube, ball});
      }
}

TEST(SurfaceStress, TheCameraInsideTheFocus) {
  const Mask everything = maskOf(cube, [](const Vec3&) { return true; });
  for (const auto projection : projections) {
    const View view{camera(projection, {3, 2, 1}, {-1, 5, 2}, 5.0), cube, everything};
    const ClippingSurface surface = view.surface({});
    for (std::int64_t i = 0; i < surface.focus.depth.size(); ++i)
      if (projection == Projection::perspective) {
        ASSERT_NEAR(surface.focus.depth.at(i), 0.0, 1e-6);
      }
    for (const double smoothing : smoothings) {
      const ClippingSurface other = view.surface({.smoothing = smoothing});
      expectDepths(view, other, {.smoothing = smoothing});
      expectKeepEverywhere(view, other.clip);
      expectVisible(view, other.clip);
      expectBoxes(view, other.clip);
    }
  }
}

TEST(SurfaceStress, LooksAlongAxesAndDiagonalsThroughFacesAndCorners) {
  const Mask box = boxMask(cube, {-6, -6, -6}, {6, 6, 6}); // voxel centres at half-integers
  for (const auto projection : projections)
    for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0, 0, -1), Vec3(1, 1, 0), Vec3(1, 1, 1)})
      for (const double offset : {0.0, 0.5}) {
        const Vec3 at = Vec3::Constant(offset);
        const Vec3 up = way.z() == -1.0 ? Vec3::UnitY() : Vec3::UnitZ();
        expectSound({camera(projection, at - 64.0 * way, at, 12.0, 20.0, up), cube, box});
      }
}

TEST(SurfaceStress, FieldsOfView) {
  const Mask ball = sphereMask(cube, 9.0);
  for (const double angle : {1.0, 150.0, 179.0})
    for (const double distance : {20.0, 60.0}) {
      SCOPED_TRACE(angle);
      expectSound({camera(Projection::perspective, {0, -distance, 0.2}, Vec3::Zero(), 1, angle),
                   cube, ball});
    }
  expectSound({camera(Projection::orthographic, {0, -60, 0.2}, Vec3::Zero(), 100.0), cube, ball});
  // Picture of one point of the focus, 1e-6 mm wide.
  expectSound({camera(Projection::orthographic, {0, -60, 0.2}, Vec3::Zero(), 5e-7), cube, ball});
  expectSound({camera(Projection::perspective, {0, -60, 0.2}, Vec3::Zero(), 1, 1e-6), cube, ball});
}

TEST(SurfaceStress, FlatVoxels) {
  const Grid flat = centredGrid({100, 100, 3}, {0.01, 0.01, 100.0});
  const Mask focus = boxMask(flat, {-0.2, -0.3, -1.0}, {0.2, 0.3, 1.0});
  for (const auto projection : projections) {
    expectSound({camera(projection, {0, -30, 0}, Vec3::Zero(), 0.7, 3.0), flat, focus});
    expectSound({camera(projection, {0, -300, 0}, Vec3::Zero(), 160.0, 60.0), flat,
                 maskOf(flat, [](const Vec3&) { return true; })});
  }
}

TEST(SurfaceStress, FarFromTheOriginIsTheSame) {
  const Vec3 far(1e6, -1e6, 1e6);
  Mask ball = sphereMask(cube, 9.0);
  for (const auto projection : projections) {
    const Vec3 from(10, -60, 5);
    const View here{camera(projection, from, Vec3::Zero(), 14.0), cube, ball};
    Affine moved = cube.indexToWorld;
    moved.translation() += far;
    const Grid there(cube.size, moved);
    Mask focus = ball;
    focus.grid = there;
    const View away{camera(projection, far + from, far, 14.0), there, focus};
    expectSound(away);
    const ClippingSurface a = here.surface({}), b = away.surface({});
    const auto& depths = *std::get<ClipDepth>(a.clip).buffer;
    const auto& others = *std::get<ClipDepth>(b.clip).buffer;
    ASSERT_EQ(depths.size(), others.size());
    for (std::int64_t i = 0; i < depths.size(); ++i) {
      ASSERT_NEAR(depths.at(i), others.at(i), 1e-4) << i;
    }
  }
}

// ---- refusals

void expectRefused(const Camera& camera, const Domain& volume, const Mask& focus) {
  for (const auto mode : {SurfaceMode::cutaway, SurfaceMode::surface})
    try {
      buildClippingSurface(camera, volume, focus, {.mode = mode});
      ADD_FAILURE() << "no Error";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_EQ(std::string(error.what()).find("focus A: cannot be seen: "), 0U) << error.what();
    }
}

TEST(SurfaceStress, AFocusThatNoRayMeetsIsRefused) {
  const Mask ball = sphereMask(cube, 4.0);
  const Camera ahead = anteriorCamera(Projection::perspective, 100.0, 20.0, 16, 16);
  expectRefused(ahead, cube, maskOf(cube, [](const Vec3&) { return false; }));
  // Focus behind the eye, and the eye in the volume.
  expectRefused(camera(Projection::perspective, {0, 12, 0}, {0, 20, 0}, 1.0), cube, ball);
  expectRefused(camera(Projection::orthographic, {0, 12, 0}, {0, 20, 0}, 5.0), cube, ball);
  // Focus smaller than a pixel, between the samples.
  expectRefused(anteriorCamera(Projection::orthographic, 100.0, 1e3, 16, 16), cube, oneVoxel());
  // Cropped focus, and a crop box that leaves no volume.
  Affine crop = Affine::Identity();
  crop.translation() = Vec3(10, 0, 0);
  crop.linear() *= 2.0;
  expectRefused(ahead, Domain(cube, CropBox(crop)), ball);
  crop.translation() = Vec3(1e4, 0, 0);
  expectRefused(ahead, Domain(cube, CropBox(crop)), ball);
  // Focus away from the volume.
  Mask elsewhere = ball;
  Affine moved = cube.indexToWorld;
  moved.translation() += Vec3(0, 0, 1e6);
  elsewhere.grid = Grid(cube.size, moved);
  expectRefused(ahead, cube, elsewhere);
}

} // namespace
} // namespace fenestra::SurfaceStressTests
