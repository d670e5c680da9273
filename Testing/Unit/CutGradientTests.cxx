// Gradient of a soft clip edge: its direction, its length, and its effect on the surface
// probability of a homogeneous medium.

#include "ClippingTesting.h"
#include "clip/surface/ClippingSurface.h"
#include "integrator/scalar/ClippedMedium.h"

#include <gtest/gtest.h>

namespace fenestra::core::CutGradientTests {
using namespace testing_clipping;

namespace {

constexpr ClipEdge edge{0.2, 4.0};

Camera makeObliqueCamera(Projection projection) {
  CameraPose pose;
  pose.projection = projection;
  pose.position = {50.0, -100.0, 30.0};
  pose.target = {1.0, 2.0, -1.0};
  pose.scale = 25.0;
  pose.angle = 25.0;
  return {pose, 24, 24};
}

/// Surface of a bent shell: partly on the shell, partly filled.
Clip makeSoftSurface(Projection projection, Boundary boundary = Boundary::spline) {
  const Grid volume = makeCenteredGrid({40, 36, 30}, {1.0, 1.2, 1.5});
  const Mask focus = makeMask(volume, [](const Vec3& p) {
    return std::abs(p.norm() - 12.0) < 2.0 && p.x() + 2.0 * p.y() < 6.0;
  });
  SurfaceOptions options;
  options.edge = edge;
  options.boundary = boundary;
  return buildClippingSurface(makeObliqueCamera(projection), volume, focus, options).clip;
}

bool isNearCellBorder(const ClipDepth& clip, const Vec3& world) {
  const Vec2 fraction = clip.buffer->cell(toBuffer(clip.camera, world).head<2>()).fraction;
  return (fraction.array() - 0.5).abs().maxCoeff() > 0.49;
}

/// Gradient of the clip weight by central differences, mm^-1.
Vec3 estimateGradient(const Clip& clip, const Vec3& world) {
  constexpr double step = 1e-4;
  Vec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 to = step * Vec3::Unit(axis);
    gradient[axis] = (clipWeight(clip, world + to) - clipWeight(clip, world - to)) / (2.0 * step);
  }
  return gradient;
}

bool isInRamp(const Clip& clip, const Vec3& world) {
  const double weight = clipWeight(clip, world);
  return weight > edge.ghost + 1e-3 && weight < 1.0 - 1e-3;
}

TEST(CutGradient, PointsAlongTheGradientOfTheClipWeight) {
  const Vec3 normal = Vec3(0.4, -2.0, 0.3).normalized();
  std::vector<Clip> clips;
  for (const Projection projection : {Projection::orthographic, Projection::perspective}) {
    clips.push_back(ClipPlane{makeObliqueCamera(projection), {2.0, -3.0, 1.0}, normal, edge});
    clips.push_back(makeSoftSurface(projection));
  }
  Random random(1, 2, 3);
  for (const Clip& clip : clips) {
    int inside = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec3 point = randomPoint(random, -17.0, 17.0);
      const auto* depth = std::get_if<ClipDepth>(&clip);
      if (!isInRamp(clip, point) || (depth && isNearCellBorder(*depth, point)))
        continue;
      ++inside;
      const Vec3 cut = cutGradient(clip, point);
      ASSERT_NEAR(cut.norm(), cutSlope, 1e-12);
      ASSERT_NEAR(cut.normalized().dot(estimateGradient(clip, point).normalized()), 1.0, 1e-6);
    }
    EXPECT_GT(inside, 200) << clip.index();
  }
}

TEST(CutGradient, UsesTheLinearSurfaceInSilhouetteCells) {
  const Clip exact = makeSoftSurface(Projection::perspective, Boundary::exact);
  ClipDepth linear = std::get<ClipDepth>(exact);
  linear.silhouette = nullptr;
  Random random(4, 5, 6);
  int differing = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 point = randomPoint(random, -17.0, 17.0);
    if (!isInRamp(exact, point) || !isInRamp(linear, point))
      continue;
    differing += clipWeight(exact, point) != clipWeight(linear, point) ? 1 : 0;
    ASSERT_EQ(cutGradient(exact, point), cutGradient(linear, point));
  }
  EXPECT_GT(differing, 20);
}

TEST(CutGradient, IsZeroOutsideTheRamp) {
  const Camera camera = makeAnteriorCamera(Projection::perspective, 100.0, 20.0, 8, 8);
  const auto plane = [&](const ClipEdge& e) {
    return ClipPlane{camera, Vec3::Zero(), -Vec3::UnitY(), e};
  };
  const Vec3 inward = cutSlope * Vec3::UnitY();
  EXPECT_EQ(cutGradient(plane(edge), {1.0, -1e-9, 2.0}), Vec3::Zero()); // the ghost
  EXPECT_LT((cutGradient(plane(edge), {1.0, 0.0, 2.0}) - inward).norm(), 1e-12);
  EXPECT_LT((cutGradient(plane(edge), {1.0, 3.999, 2.0}) - inward).norm(), 1e-12);
  EXPECT_EQ(cutGradient(plane(edge), {1.0, 4.0, 2.0}), Vec3::Zero());
  EXPECT_EQ(cutGradient(plane({}), {1.0, 0.0, 2.0}), Vec3::Zero());
  EXPECT_EQ(cutGradient(ClipNone{}, {1.0, 0.0, 2.0}), Vec3::Zero());
  const ClipPlane flipped{camera, Vec3(0.0, -102.0, 0.0), Vec3::UnitY(), edge};
  EXPECT_EQ(cutGradient(flipped, {0.0, -103.0, 0.0}), Vec3::Zero()); // behind the camera
}

TEST(CutGradient, IsTheViewAxisAtStepsAndZeroWhereNothingIsClipped) {
  const Camera camera = makeAnteriorCamera(Projection::perspective, 100.0, 20.0, 8, 8);
  auto buffer = std::make_shared<DepthBuffer>(camera, makeCenteredGrid({30, 30, 30}));
  for (std::int64_t i = 0; i < buffer->size(); ++i)
    buffer->set(i, i % buffer->columns() < buffer->columns() / 2 ? 95.0 : -infinity);
  const auto pyramid = std::make_shared<const DepthPyramid>(*buffer, nullptr);
  ClipDepth clip{camera, buffer, pyramid, ClipDepth::Lookup::nearest, edge};
  const Vec3 inward = cutSlope * Vec3::UnitY();
  const double side = toBuffer(camera, {5.0, 0.0, 0.0}).x() > 0.0 ? -5.0 : 5.0;
  EXPECT_LT((cutGradient(clip, {side, -3.0, 2.0}) - inward).norm(), 1e-12);
  EXPECT_EQ(cutGradient(clip, {-side, -3.0, 2.0}), Vec3::Zero());
  clip.lookup = ClipDepth::Lookup::linear;
  EXPECT_LT((cutGradient(clip, {side, -3.0, 2.0}) - inward).norm(), 1e-12);
  EXPECT_EQ(cutGradient(clip, {-side, -3.0, 2.0}), Vec3::Zero());
  EXPECT_EQ(cutGradient(clip, {0.0, -3.0, 2.0}), Vec3::Zero()); // between -infinity and a depth
}

/// P = o (1 - exp(-25 gamma^3 m)) with m = 1 mm cutSlope: the medium has no gradient.
TEST(CutGradient, GivesAHomogeneousMediumASurface) {
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 100.0, 20.0, 8, 8);
  const Clip clip = ClipPlane{camera, Vec3::Zero(), -Vec3::UnitY(), edge};
  const Grid grid = makeCenteredGrid({20, 20, 20});
  const std::vector<float> voxels(static_cast<std::size_t>(grid.voxelCount()), 40.0F);
  TransferFunction transfer{
      ScalarFunction({{0.0, ScalarFunction::Value(0.0)}, {100.0, ScalarFunction::Value(2.0)}}),
      ColorFunction({{0.0, Rgb::Constant(0.5)}})};
  transfer.shading = SurfaceShading{0.8, 0.3, 12.0, 0.6};
  const auto sample = [&](double y, bool wantGradient = false) {
    const Vec3 point(1.0, y, 2.0);
    Random random(0);
    return sampleMedium(Medium<float>(grid, voxels, transfer), clip, point,
                        grid.worldToIndex * point, wantGradient, random);
  };
  const double opacity = 1.0 - std::exp(-0.8);
  const double expected = opacity * (1.0 - std::exp(-25.0 * 0.216 * 0.8));
  EXPECT_NEAR(sample(2.0).surfaceProbability, expected, 1e-12);
  EXPECT_LT((sample(2.0).gradient - 100.0 * 0.8 * Vec3::UnitY()).norm(), 1e-12);
  EXPECT_EQ(sample(4.5).surfaceProbability, 0.0);
  EXPECT_EQ(sample(-0.5).surfaceProbability, 0.0);
  transfer.shading.reset();
  EXPECT_EQ(sample(2.0, true).gradient, Vec3::Zero());
}

} // namespace
} // namespace fenestra::core::CutGradientTests
