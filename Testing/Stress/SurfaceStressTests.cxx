// Clipping surfaces of difficult focuses and views (SurfaceChecks.h).

#include "ErrorChecks.h"
#include "Stress/SurfaceChecks.h"

namespace fenestra::core::SurfaceStressTests {
namespace {

// ---- focuses

const Grid cube = makeCenteredGrid({32, 32, 32});

/// Tests views from 100 mm in front; `scale`: half the view's height at the center, mm.
void expectValidFromFront(const Mask& focus, double scale, const Grid& volume = cube) {
  for (const auto projection : projections)
    for (const auto& [width, height] : {std::pair{40, 30}, std::pair{5, 13}}) {
      SCOPED_TRACE(projection == Projection::perspective ? "perspective" : "orthographic");
      expectValid({makeAnteriorCamera(projection, 100.0, scale, width, height), volume, focus});
    }
}

Mask makeOneVoxel() {
  return makeBoxMask(cube, Vec3::Constant(0.1), Vec3::Constant(0.9));
}

TEST(SurfaceStress, OneVoxelIsValid) {
  for (const double scale : {0.9, 4.0})
    expectValidFromFront(makeOneVoxel(), scale);
}

TEST(SurfaceStress, OnePixelGivesFlatSurfaceAndWarning) {
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 100.0, 20.0, 40, 40);
  const View view{camera, cube, makeOneVoxel()};
  const ClippingSurface surface = view.surface({});
  EXPECT_EQ(surface.controlPoints.size(), 1U);
  EXPECT_EQ(surface.warnings.size(), 1U);
  expectMessage(surface.warnings[0], "tiny-focus: focus");
  expectValid(view);
}

TEST(SurfaceStress, FocusAtVolumeBoundaryIsValid) {
  for (const Vec3& corner : {Vec3(-16, -16, -16), Vec3(16, 16, 16), Vec3(-16, 16, 0)}) {
    const Mask focus =
        makeMask(cube, [&](const Vec3& p) { return (p - corner).cwiseAbs().maxCoeff() < 9.0; });
    expectValidFromFront(focus, 20.0);
    expectValidFromFront(focus, 10.0);
  }
}

TEST(SurfaceStress, FocusThatFillsViewIsValid) {
  const Mask everything = makeMask(cube, [](const Vec3&) { return true; });
  for (const double scale : {5.0, 15.9, 16.0, 40.0})
    expectValidFromFront(everything, scale);
  for (const auto projection : projections) { // the face is at -16 for every ray
    const View view{makeAnteriorCamera(projection, 50.0, 7.0, 20, 20), cube, everything};
    const FocusDepth focus = view.surface({}).focus;
    for (int pixel = 0; pixel < 400; ++pixel) {
      ASSERT_NEAR(focus.depth.at(focus.depth.viewportSample(pixel % 20, pixel / 20)), 34.0, 1e-4);
    }
  }
  expectValidFromFront(makeBoxMask(cube, {-11, -9, -11}, {11, 9, 11}), 8.0);
  expectValidFromFront(makeSphereMask(cube, 14.0), 3.0);
}

TEST(SurfaceStress, ManyComponentsAreValid) {
  const auto every = [](const Vec3& p, double n) {
    const Vec3 cell = (p.array() + 15.5) / n;
    return cell == Vec3(cell.array().floor());
  };
  for (const double n : {2.0, 3.0, 10.0})
    expectValidFromFront(makeMask(cube, [&](const Vec3& p) { return every(p, n); }), 17.0);
}

TEST(SurfaceStress, HolesInFocusAreValid) {
  const Mask plate = makeMask(cube, [](const Vec3& p) {
    const bool isHole = std::hypot(std::remainder(p.x(), 8.0), std::remainder(p.z(), 8.0)) < 2.5;
    return std::abs(p.y()) < 3.0 && !isHole;
  });
  expectValidFromFront(plate, 17.0);
  const Mask ring = makeMask(cube, [](const Vec3& p) {
    return std::abs(p.y() - 0.3 * p.x()) < 2.0 && std::abs(std::hypot(p.x(), p.z()) - 10.0) < 1.1;
  });
  expectValidFromFront(ring, 17.0);
}

TEST(SurfaceStress, SheetSeenEdgeOnIsValid) {
  // Sheet one voxel thick, parallel to the view, and tilted: a staircase of voxels.
  for (const double tilt : {0.0, 1e-3, 0.3}) {
    const Mask sheet = makeMask(cube, [&](const Vec3& p) {
      const double x = p.x() - tilt * p.y();
      return x >= 0.0 && x < 1.0 && std::abs(p.z()) < 9.0;
    });
    for (const double scale : {5.0, 15.0, 17.0})
      expectValidFromFront(sheet, scale);
  }
}

TEST(SurfaceStress, DepthJumpsAreValid) {
  // Stripes and a checkerboard of plates, each two voxels thick, 500 mm apart.
  const Grid deep = makeCenteredGrid({32, 32, 32}, {1.0, 20.0, 1.0});
  const auto plate = [](const Vec3& p, bool isNear) {
    return std::abs(p.y() + (isNear ? 250.0 : -250.0)) < 20.0;
  };
  for (const double width : {1.0, 5.0}) {
    const auto isOdd = [&](double x) { return std::fmod(std::floor(x / width) + 100.0, 2.0) > 0; };
    for (const auto projection : projections) {
      const Camera camera = makeAnteriorCamera(projection, 700.0, 17.0, 40, 40);
      expectValid(
          {camera, deep, makeMask(deep, [&](const Vec3& p) { return plate(p, isOdd(p.x())); })});
      expectValid({camera, deep, makeMask(deep, [&](const Vec3& p) {
                     return plate(p, isOdd(p.x()) != isOdd(p.z()));
                   })});
    }
  }
}

// ---- views

/// Camera whose middle pixel looks at the target.
Camera makeCamera(Projection projection, const Vec3& from, const Vec3& to, double scale,
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

TEST(SurfaceStress, CameraInsideVolumeIsValid) {
  const Mask ball = makeSphereMask(cube, 6.0);
  for (const auto projection : projections)
    for (const Vec3& from : {Vec3(10, -11, 3), Vec3(8, 0, 0), Vec3(-16, -16, -16), Vec3(2, 1, 3)})
      for (const double angle : {20.0, 120.0}) {
        SCOPED_TRACE(from);
        expectValid({makeCamera(projection, from, Vec3::Zero(), 5.0, angle), cube, ball});
      }
}

TEST(SurfaceStress, CameraInsideFocusIsValid) {
  const Mask everything = makeMask(cube, [](const Vec3&) { return true; });
  for (const auto projection : projections) {
    const View view{makeCamera(projection, {3, 2, 1}, {-1, 5, 2}, 5.0), cube, everything};
    const ClippingSurface surface = view.surface({});
    for (std::int64_t i = 0; i < surface.focus.depth.size(); ++i)
      if (projection == Projection::perspective) {
        ASSERT_NEAR(surface.focus.depth.at(i), 0.0, 1e-6);
      }
    for (const double smoothing : smoothings) {
      const ClippingSurface other = view.surface({.smoothing = smoothing});
      expectDepths(view, other, {.smoothing = smoothing});
      expectClipWeightEverywhere(view, other.clip);
      expectVisibleInterval(view, other.clip);
      expectBoxes(view, other.clip);
    }
  }
}

TEST(SurfaceStress, ViewsAlongAxesAndDiagonalsAreValid) {
  const Mask box = makeBoxMask(cube, {-6, -6, -6}, {6, 6, 6}); // voxel centers at half-integers
  for (const auto projection : projections)
    for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, 0, -1), Vec3(1, 1, 0), Vec3(1, 1, 1)})
      for (const double offset : {0.0, 0.5}) {
        const Vec3 at = Vec3::Constant(offset);
        const Vec3 up = direction.z() == -1.0 ? Vec3::UnitY() : Vec3::UnitZ();
        expectValid({makeCamera(projection, at - 64.0 * direction, at, 12.0, 20.0, up), cube, box});
      }
}

TEST(SurfaceStress, ExtremeFieldsOfViewAreValid) {
  const Mask ball = makeSphereMask(cube, 9.0);
  for (const double angle : {1.0, 150.0, 179.0})
    for (const double distance : {20.0, 60.0}) {
      SCOPED_TRACE(angle);
      expectValid({makeCamera(Projection::perspective, {0, -distance, 0.2}, Vec3::Zero(), 1, angle),
                   cube, ball});
    }
  expectValid(
      {makeCamera(Projection::orthographic, {0, -60, 0.2}, Vec3::Zero(), 100.0), cube, ball});
  // Image of one point of the focus, 1e-6 mm wide.
  expectValid(
      {makeCamera(Projection::orthographic, {0, -60, 0.2}, Vec3::Zero(), 5e-7), cube, ball});
  expectValid(
      {makeCamera(Projection::perspective, {0, -60, 0.2}, Vec3::Zero(), 1, 1e-6), cube, ball});
}

TEST(SurfaceStress, FlatVoxelsAreValid) {
  const Grid flat = makeCenteredGrid({100, 100, 3}, {0.01, 0.01, 100.0});
  const Mask focus = makeBoxMask(flat, {-0.2, -0.3, -1.0}, {0.2, 0.3, 1.0});
  for (const auto projection : projections) {
    expectValid({makeCamera(projection, {0, -30, 0}, Vec3::Zero(), 0.7, 3.0), flat, focus});
    expectValid({makeCamera(projection, {0, -300, 0}, Vec3::Zero(), 160.0, 60.0), flat,
                 makeMask(flat, [](const Vec3&) { return true; })});
  }
}

TEST(SurfaceStress, FarFromOriginDepthsAreUnchanged) {
  const Vec3 far(1e6, -1e6, 1e6);
  Mask ball = makeSphereMask(cube, 9.0);
  for (const auto projection : projections) {
    const Vec3 from(10, -60, 5);
    const View nearby{makeCamera(projection, from, Vec3::Zero(), 14.0), cube, ball};
    Affine moved = cube.indexToWorld;
    moved.translation() += far;
    const Grid farGrid(cube.size, moved);
    Mask focus = ball;
    focus.grid = farGrid;
    const View farView{makeCamera(projection, far + from, far, 14.0), farGrid, focus};
    expectValid(farView);
    const ClippingSurface a = nearby.surface({}), b = farView.surface({});
    const auto& depths = *std::get<ClipDepth>(a.clip).buffer;
    const auto& others = *std::get<ClipDepth>(b.clip).buffer;
    ASSERT_EQ(depths.size(), others.size());
    for (std::int64_t i = 0; i < depths.size(); ++i) {
      ASSERT_NEAR(depths.at(i), others.at(i), 1e-4) << i;
    }
  }
}

// ---- errors

void expectRefused(const Camera& camera, const Domain& volume, const Mask& focus) {
  for (const auto mode : {SurfaceMode::cutaway, SurfaceMode::surface})
    catchError(ErrorKind::input, "hidden-focus: focus A",
               [&] { buildClippingSurface(camera, volume, focus, {.mode = mode}); });
}

TEST(SurfaceStress, FocusThatNoRayHitsIsError) {
  const Mask ball = makeSphereMask(cube, 4.0);
  const Camera ahead = makeAnteriorCamera(Projection::perspective, 100.0, 20.0, 16, 16);
  expectRefused(ahead, cube, makeMask(cube, [](const Vec3&) { return false; }));
  // Focus behind the camera, and the camera in the volume.
  expectRefused(makeCamera(Projection::perspective, {0, 12, 0}, {0, 20, 0}, 1.0), cube, ball);
  expectRefused(makeCamera(Projection::orthographic, {0, 12, 0}, {0, 20, 0}, 5.0), cube, ball);
  // Focus smaller than a pixel, between the samples.
  expectRefused(makeAnteriorCamera(Projection::orthographic, 100.0, 1e3, 16, 16), cube,
                makeOneVoxel());
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
} // namespace fenestra::core::SurfaceStressTests
