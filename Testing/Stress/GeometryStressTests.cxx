// Invariance to the volume's geometry: extreme spacings, far origins, oblique, sheared and mirrored
// axes, against the same scene with simple numbers.

#include "StressSupport.h"

namespace fenestra::core::testing::GeometryStressTests {
namespace {

double bump(const Vec3& p) {
  return 0.5 + 0.5 * std::sin(0.9 * p.x()) * std::cos(0.7 * p.y() + 0.3 * p.z());
}

/// 12x10x8 voxels of 1 x 1.2 x 1.5 mm around the origin, seen from a corner.
TestScene makeBumpScene() {
  const Grid grid = makeCenteredGrid({12, 10, 8}, {1.0, 1.2, 1.5});
  TestScene scene{makeVolume(grid, bump),
                  makeLinearTransfer(0.6, Rgb::Constant(0.8), 0.4),
                  {EnvironmentLight{}},
                  {},
                  16,
                  16};
  scene.pose.position = {20.0, -30.0, 15.0};
  scene.pose.target = Vec3::Zero();
  scene.pose.scale = 9.0;
  return scene;
}

/// Transforms a scene, including its camera.
TestScene transformScene(TestScene scene, const Affine& map) {
  Grid& grid = scene.volume.grid;
  grid = Grid(grid.size, map * grid.indexToWorld);
  scene.pose.position = map * scene.pose.position;
  scene.pose.target = map * scene.pose.target;
  scene.pose.up = map.linear() * scene.pose.up;
  return scene;
}

Affine makeRigid(double angle, const Vec3& translation = Vec3::Zero()) {
  return Affine(makeTranslation(translation) *
                makeRotation(angle, Vec3(1.0, -2.0, 0.5).normalized()));
}

struct Place {
  const char* name;
  Affine map;
};

class PlacedVolume : public ::testing::TestWithParam<Place> {};

TEST_P(PlacedVolume, ImageIsUnchanged) {
  const TestScene scene = makeBumpScene();
  const TestScene elsewhere = transformScene(scene, GetParam().map);
  const int samples = scaleSamples(400);
  expectSameImage(renderScene(scene, samples, 1).film, renderScene(elsewhere, samples, 2).film);
}

TEST_P(PlacedVolume, IndexRoundTripKeepsVoxelPrecision) {
  // Rounding error, in voxels, of a few operations with coordinates of magnitude `far`: half an ulp
  // each. At 1e6 mm and 1 mm voxels: 1e-9 of a voxel.
  const Grid grid = transformScene(makeBumpScene(), GetParam().map).volume.grid;
  const double far = 100.0 + grid.indexToWorld.translation().cwiseAbs().maxCoeff();
  const double bound = 16.0 * 0x1p-53 * far / grid.spacing().minCoeff();
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = grid.indexBox().corner(i);
    EXPECT_LT((grid.worldToIndex * (grid.indexToWorld * corner) - corner).cwiseAbs().maxCoeff(),
              bound);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Places, PlacedVolume,
    ::testing::Values(Place{"far", Affine(makeTranslation({1e6, -1e6, 1e6}))},
                      Place{"farther", Affine(makeTranslation({-1e9, 7e8, 1e9}))},
                      Place{"rotated", makeRigid(1.0)},
                      Place{"rotatedFar", makeRigid(2.0, {1e6, 1e6, -1e6})},
                      Place{"rotatedSlightly", makeRigid(1e-9)}, Place{"halfTurn", makeRigid(pi)}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(MirroredAxes, ImageIsUnchanged) {
  const TestScene scene = makeBumpScene();
  const Size3 size = scene.volume.grid.size;
  for (int axis = 0; axis < 3; ++axis) {
    Affine flip = Affine::Identity();
    flip.linear()(axis, axis) = -1.0;
    flip.translation()[axis] = static_cast<double>(size[axis] - 1);
    TestScene mirrored = scene;
    mirrored.volume = makeVolume(Grid(size, scene.volume.grid.indexToWorld * flip),
                                 [&](const Vec3& p) { return bump(flip * p); });
    EXPECT_LT(mirrored.volume.grid.indexToWorld.linear().determinant(), 0.0);
    const int samples = scaleSamples(400);
    expectSameImage(renderScene(scene, samples, 3).film, renderScene(mirrored, samples, 4).film);
  }
}

/// Field that is linear in world space, sampled on any grid; grids differ only outside the crop.
TestScene makeLinearScene(const Size3& size, const Mat3& axes) {
  Affine map;
  map.linear() = axes;
  map.translation() = -axes * (0.5 * (size - Size3::Ones()).cast<double>());
  const Grid grid(size, map);
  const auto field = [&](const Vec3& p) {
    return 0.5 + Vec3(0.05, -0.04, 0.06).dot(grid.indexToWorld * p);
  };
  TestScene scene = makeBumpScene();
  scene.volume = makeVolume(grid, field);
  scene.crop = CropBox(makeRigid(0.4) * Affine(makeScaling(Vec3(4.0, 3.0, 3.5))));
  scene.pose.scale = 6.0;
  return scene;
}

TEST(ShearedAxes, ImageIsUnchanged) {
  const TestScene straight = makeLinearScene({14, 14, 14}, Mat3::Identity());
  const Mat3 sheared = Mat3::FromRows({1.0, 0.9, 0.3}, {0.0, 0.8, -0.7}, {0.0, 0.0, 1.1});
  const Mat3 flat = // two axes nearly parallel
      Mat3::FromRows({0.5, 0.5, 0.1}, {0.5, 0.5 - 1e-3, 0.0}, {0.0, 0.2, 1.0});
  const int samples = scaleSamples(400);
  const RenderResult expected = renderScene(straight, samples, 5);
  expectSameImage(expected.film,
                  renderScene(makeLinearScene({50, 50, 30}, sheared), samples, 6).film);
  // The flat parallelepiped contains only a small part of the crop. The part common to both is
  // compared by camera rays through a still smaller crop.
  TestScene small = straight;
  small.crop = CropBox(Affine(makeScaling(Vec3(0.01, 0.01, 0.5))));
  small.pose.scale = 0.3;
  small.transfer = makeLinearTransfer(5.0, Rgb::Constant(0.8));
  TestScene smallFlat = makeLinearScene({101, 101, 9}, flat);
  smallFlat.crop = small.crop;
  smallFlat.pose = small.pose;
  smallFlat.transfer = small.transfer;
  expectSameImage(renderScene(small, samples, 7).film, renderScene(smallFlat, samples, 8).film);
}

// ---- needles: 0.01 x 0.01 x 100 mm

double needleValue(double i, double j, double z) {
  return 0.5 + 0.3 * std::sin(1.1 * i + 0.4 * j) + 0.2 * std::sin(z / 30.0 + j);
}

/// 24 x 24 needles of two slices, or the same field in slices of 20 mm.
Volume makeNeedles(bool resampled) {
  const auto value = [](const Vec3& p, double z) { // linear between z = -50 and 50, clamped
    const double f = std::clamp((z + 50.0) / 100.0, 0.0, 1.0);
    return (1.0 - f) * needleValue(p.x(), p.y(), -50.0) + f * needleValue(p.x(), p.y(), 50.0);
  };
  const Grid grid = resampled ? makeCenteredGrid({24, 24, 10}, {0.01, 0.01, 20.0})
                              : makeCenteredGrid({24, 24, 2}, {0.01, 0.01, 100.0});
  return makeVolume(grid, [&](const Vec3& p) { return value(p, (grid.indexToWorld * p).z()); });
}

TestScene makeNeedleScene(bool resampled, const Rgb& albedo) {
  TestScene scene{
      makeNeedles(resampled), makeLinearTransfer(0.01, albedo), {EnvironmentLight{}}, {}, 12, 12};
  scene.pose.position = {0.0, 0.0, 200.0};
  scene.pose.target = {0.02, 0.01, 0.0}; // nearly along the needles
  scene.pose.up = Vec3::UnitY();
  scene.pose.scale = 0.13;
  return scene;
}

TEST(NeedleVoxels, ImageEqualsResampledField) {
  const int samples = scaleSamples(1000);
  const Rgb albedo = Rgb::Constant(0.5);
  expectSameImage(renderScene(makeNeedleScene(false, albedo), samples, 1).film,
                  renderScene(makeNeedleScene(true, albedo), samples, 2).film);
}

TEST(NeedleVoxels, FurnaceIsOne) {
  expectRadianceOne(renderScene(makeNeedleScene(false, Rgb::Ones()), scaleSamples(100)));
}

TEST(NeedleVoxels, DiagonalTransmittanceEqualsExpOfIntegral) {
  const Volume volume = makeNeedles(false);
  constexpr double sigma = 0.01;
  const RayProbe<> probe(volume, makeLinearTransfer(sigma, Rgb::Zero()));
  for (int i = 0; i < 4; ++i) {
    const Vec3 from = volume.grid.worldCorner(i);
    const Vec3 to = volume.grid.worldCorner(7 - i);
    const Ray ray{from, (to - from).normalized()};
    const double length = (to - from).norm();
    // Reference: midpoint rule on the interpolated voxels.
    constexpr int steps = 20000;
    double depth = 0.0;
    const auto& voxels = std::get<LargeArray<float>>(volume.voxels);
    for (int k = 0; k < steps; ++k) {
      const Vec3 p = from + (to - from) * ((k + 0.5) / steps);
      const double x = std::clamp(p.x() / 0.01 + 11.5, 0.0, 23.0);
      const double y = std::clamp(p.y() / 0.01 + 11.5, 0.0, 23.0);
      const double f = std::clamp((p.z() + 50.0) / 100.0, 0.0, 1.0);
      const int a = std::min(static_cast<int>(x), 22), b = std::min(static_cast<int>(y), 22);
      const auto at = [&](int ia, int jb, int slice) {
        return static_cast<double>(voxels[static_cast<std::size_t>(ia + 24 * (jb + 24 * slice))]);
      };
      const auto across = [&](int slice) {
        const double low = at(a, b, slice) * (1.0 - x + a) + at(a + 1, b, slice) * (x - a);
        const double high = at(a, b + 1, slice) * (1.0 - x + a) + at(a + 1, b + 1, slice) * (x - a);
        return low * (1.0 - y + b) + high * (y - b);
      };
      depth += sigma * ((1.0 - f) * across(0) + f * across(1)) * length / steps;
    }
    probe.expectTransmittance(ray, {}, std::exp(-depth), scaleSamples(20000));
  }
}

} // namespace
} // namespace fenestra::core::testing::GeometryStressTests
