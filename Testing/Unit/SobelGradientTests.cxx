// Sobel's gradient: scalar code against the oracle, SIMD code against scalar code, on grids with
// few voxels along some axes; and its accuracy on a sphere.

#include "EachInstructionSet.h"
#include "Oracle/Medium.h"
#include "Support.h"
#include "integrator/simd/PathSteps.h"
#include "model/medium/Medium.h"

namespace fenestra::core::testing::SobelGradientTests {
namespace {

constexpr Vec3 spacing(0.5, 2.0, 1.25);

/// Scalars 0 to 200 without correlation.
template <typename Voxel = float>
Volume makeNoise(const Size3& size) {
  Random random(7, 0, 0);
  Affine map = makeRotation(0.4, Vec3(1.0, 2.0, 2.0) / 3.0);
  map.linear() = Mat3(map.linear() * Mat3(Mat3::Diagonal(spacing)));
  return makeVolume<Voxel>(Grid(size, map),
                           [&](const Vec3&) { return std::floor(200.0 * random.uniform()); });
}

/// Volumes of one to five voxels along each axis; along x at least `minColumns`.
std::vector<Size3> listSizes(std::int64_t minColumns) {
  std::vector<Size3> sizes;
  for (std::int64_t x = minColumns; x <= 5; ++x)
    for (std::int64_t y = 1; y <= 5; ++y)
      for (std::int64_t z = 1; z <= 5; ++z)
        sizes.emplace_back(x, y, z);
  return sizes;
}

/// Points of index space, in all parts of the volume's box: also on voxels and in the outer half
/// voxels.
std::vector<Vec3> listPoints(const Size3& size, std::size_t count) {
  Random random(3, 0, 0);
  std::vector<Vec3> points;
  while (points.size() < count) {
    const Vec3 u(random.uniform(), random.uniform(), random.uniform());
    const Vec3 p = u.cwiseProduct(size.cast<double>()) - Vec3::Constant(0.5);
    const bool isRounded = points.size() % 8 == 0;
    points.push_back(isRounded ? Vec3(std::round(p.x()), std::round(p.y()), std::round(p.z())) : p);
  }
  return points;
}

TransferFunction makeSobelTransfer() {
  TransferFunction transfer = makeLinearTransfer(0.5, Rgb::Constant(0.5));
  transfer.gradient = GradientKind::sobel;
  return transfer;
}

TEST(SobelGradient, EqualsTheOracleNearBordersAndOnShortAxes) {
  const TransferFunction transfer = makeSobelTransfer(); // its span is 1
  for (const Size3& size : listSizes(1)) {
    const Volume volume = makeNoise(size);
    const Field field(volume.grid, std::get<LargeArray<float>>(volume.voxels));
    const oracle::Medium reference(volume, transfer, {});
    for (const Vec3& p : listPoints(size, 100)) {
      const Vec3 expected = reference.spansPerMm(volume.grid.indexToWorld * p);
      ASSERT_LT((field.sobelGradient(p) - expected).norm(), 1e-9) << size << " at " << p;
    }
  }
}

TEST(SobelGradient, OfALinearFunctionIsItsSlope) {
  const Vec3 slope(0.25, -1.5, 3.0);
  const Grid grid = makeCenteredGrid({6, 5, 4}, spacing);
  const Volume volume =
      makeVolume<float>(grid, [&](const Vec3& p) { return slope.dot(grid.indexToWorld * p); });
  const Field field(grid, std::get<LargeArray<float>>(volume.voxels));
  for (const Vec3& p : {Vec3(1.0, 1.0, 1.0), Vec3(2.3, 2.9, 1.6), Vec3(4.0, 3.0, 2.0)})
    EXPECT_LT((field.sobelGradient(p) - slope).norm(), 1e-5);
}

TEST(SobelGradient, OfAConstantIsExactlyZero) {
  const Volume volume =
      makeVolume<float>(makeCenteredGrid({5, 4, 6}, spacing), [](const Vec3&) { return 0.1; });
  const Field field(volume.grid, std::get<LargeArray<float>>(volume.voxels));
  for (const Vec3& p : listPoints(volume.grid.size, 200))
    ASSERT_EQ(field.sobelGradient(p), Vec3::Zero());
}

TEST(SobelGradient, DoesNotAffectGradientOpacity) {
  const Volume volume = makeNoise({6, 5, 7});
  const auto& voxels = std::get<LargeArray<float>>(volume.voxels);
  TransferFunction sobel = makeSobelTransfer();
  sobel.gradientOpacity = ScalarFunction({makeKnot(0.0, 0.0), makeKnot(300.0, 1.0)});
  sobel.shading = SurfaceShading{};
  TransferFunction central = sobel;
  central.gradient = GradientKind::central;
  const Field field(volume.grid, voxels);
  const Medium ofSobel(volume.grid, voxels, sobel), ofCentral(volume.grid, voxels, central);
  for (const Vec3& p : listPoints(volume.grid.size, 100)) {
    ASSERT_EQ(ofSobel.extinction(p), ofCentral.extinction(p));
    const MediumSample sample = ofSobel.evaluate(p, false);
    ASSERT_EQ(sample.gradient, field.sobelGradient(p));
    ASSERT_EQ(ofCentral.evaluate(p, false).gradient, field.gradient(p));
    const double opacity = -std::expm1(-ofCentral.extinction(p));
    const double cube = std::pow(sobel.shading->gamma, 3.0);
    ASSERT_NEAR(sample.surfaceProbability,
                opacity * -std::expm1(-25.0 * cube * sample.gradient.norm()), 1e-12);
  }
}

/// Normals of the SIMD integrator at collisions with these points, in index space.
std::vector<Vec3> findSimdNormals(const SceneView& scene, const std::vector<Vec3>& points) {
  const SimdTracker tracker(scene.volume, Domain(scene.volume.grid), scene.transfer,
                            scene.majorants, scene.clip);
  const SimdShading shading(scene.volume.grid, scene.transfer, scene.lights, 1, true);
  const auto paths = std::make_unique<PathBatch>();
  const auto shadowRays = std::make_unique<ShadowBatch>();
  paths->rays.size = points.size();
  for (std::size_t i = 0; i < points.size(); ++i) {
    paths->rays.set(i, {points[i], Vec3::UnitX()}, 0.0);
    paths->rays.result[i] = paths->rays.scalar[i] = 0.0F;
    paths->bounces[i] = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      paths->direction[axis][i] = axis == 0 ? 1.0F : 0.0F;
      paths->throughput[axis][i] = 1.0F;
    }
  }
  Counters counters;
  scatterPaths(tracker.medium(), shading, *paths, *shadowRays, counters);
  std::vector<Vec3> normals;
  for (std::size_t i = 0; i < points.size(); ++i)
    normals.emplace_back(paths->firstNormal[0][i], paths->firstNormal[1][i],
                         paths->firstNormal[2][i]);
  return normals;
}

class SimdSobelGradient : public InstructionSetTest {};

template <typename Voxel>
void compareNormals(const Size3& size) {
  const TestScene test{makeNoise<Voxel>(size), makeSobelTransfer(), {}, {}};
  const Field field(test.volume.grid, std::get<LargeArray<Voxel>>(test.volume.voxels));
  std::vector<Vec3> points = listPoints(size, 64);
  for (Vec3& p : points) // as the integrator
    p = Vec3(double{narrow(p.x())}, double{narrow(p.y())}, double{narrow(p.z())});
  const std::vector<Vec3> normals =
      test.visitView([&](const SceneView& scene) { return findSimdNormals(scene, points); });
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 gradient = field.sobelGradient(points[i]);
    const Vec3 expected = gradient.x() < 0.0 ? gradient : Vec3(-gradient);
    ASSERT_LT((normals[i] * gradient.norm() - expected).norm(), 2e-3)
        << size << " at " << points[i];
  }
}

TEST_P(SimdSobelGradient, EqualsScalarCodeForEveryVoxelType) {
  for (const Size3& size : listSizes(4)) {
    compareNormals<std::uint8_t>(size);
    compareNormals<std::int16_t>(size);
    compareNormals<std::uint16_t>(size);
    compareNormals<float>(size);
  }
}

TEST_P(SimdSobelGradient, OfAConstantIsExactlyZeroAndANanIsInTheVolume) {
  TestScene test{
      makeVolume<float>(makeCenteredGrid({5, 4, 6}, spacing), [](const Vec3&) { return 0.1; }),
      makeSobelTransfer(),
      {},
      {}};
  std::vector<Vec3> points = listPoints(test.volume.grid.size, 64);
  points[5].y() = std::numeric_limits<double>::quiet_NaN();
  for (const Vec3& normal :
       test.visitView([&](const SceneView& scene) { return findSimdNormals(scene, points); }))
    ASSERT_EQ(normal, Vec3::Zero());
}

INSTANTIATE_TEST_SUITE_P(All, SimdSobelGradient, allInstructionSets);

TEST(SobelGradient, NeedsFourColumnsInSimd) {
  TransferFunction transfer = makeSobelTransfer();
  EXPECT_FALSE(SimdTracker::isSupported(makeNoise({3, 5, 5}), transfer));
  EXPECT_TRUE(SimdTracker::isSupported(makeNoise({4, 5, 5}), transfer));
  transfer.gradient = GradientKind::central;
  EXPECT_TRUE(SimdTracker::isSupported(makeNoise({3, 5, 5}), transfer));
}

/// Sphere of skin in air, radius 60 mm, as CT with slices of 2.5 mm shows it: blurred by the
/// scanner, averaged over each slice, and without noise.
Volume makeBall() {
  constexpr double radius = 60.0, blur = 0.42; // mm
  const Vec3 voxel(0.9355, 0.9355, 2.5);
  Grid grid = makeCenteredGrid({140, 140, 52}, voxel);
  grid = Grid(grid.size, makeTranslation(0.3 * voxel) * grid.indexToWorld);
  return makeVolume<std::int16_t>(grid, [&](const Vec3& index) {
    const Vec3 p = grid.indexToWorld * index;
    if (std::abs(p.norm() - radius) > 8.0)
      return p.norm() < radius ? 20.0 : -1000.0;
    double inside = 0.0;
    for (int part = -4; part <= 4; ++part) {
      const double distance = (p + Vec3(0.0, 0.0, part / 9.0 * voxel.z())).norm() - radius;
      inside += 1.0 / 9.0 / (1.0 + std::exp(distance / blur));
    }
    return std::round(-1000.0 + 1020.0 * inside);
  });
}

TEST(SobelGradient, NormalsOfASphereOfSkinAreWithinTwoDegrees) {
  const Volume ball = makeBall();
  const Field field(ball.grid, std::get<LargeArray<std::int16_t>>(ball.voxels));
  Random random(9, 0, 0);
  double ofSobel = 0.0, ofCentral = 0.0; // sums of squared angles
  constexpr int count = 2000;
  for (int i = 0; i < count; ++i) {
    const Vec3 outward = sampleUniformSphere(random.uniform2());
    const auto indexAt = [&](double radius) {
      return Vec3(ball.grid.worldToIndex * Vec3(radius * outward));
    };
    double inside = 55.0, outside = 65.0;
    while (outside - inside > 1e-4) {
      const double middle = 0.5 * (inside + outside);
      (field.value(indexAt(middle)) > -400.0 ? inside : outside) = middle;
    }
    const auto squaredAngle = [&](const Vec3& gradient) {
      return std::pow(std::acos(std::min(-gradient.normalized().dot(outward), 1.0)), 2.0);
    };
    ofSobel += squaredAngle(field.sobelGradient(indexAt(inside)));
    ofCentral += squaredAngle(field.gradient(indexAt(inside)));
  }
  const double degrees = 180.0 / pi;
  RecordProperty("sobel", std::to_string(degrees * std::sqrt(ofSobel / count)));
  RecordProperty("central", std::to_string(degrees * std::sqrt(ofCentral / count)));
  EXPECT_LT(degrees * std::sqrt(ofSobel / count), 2.0);
  EXPECT_GT(degrees * std::sqrt(ofCentral / count), 4.5);
}

} // namespace
} // namespace fenestra::core::testing::SobelGradientTests
