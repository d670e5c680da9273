// The clipping surface's mesh: its points are samples of the buffer, on their rays, at their
// depths; its triangles face the eye.

#include "ClippingTesting.h"
#include "clipping/SurfaceMesh.h"

#include <gtest/gtest.h>

#include <set>

using namespace fenestra;
using namespace fenestra::testing_clipping;

namespace {

constexpr std::array projections{Projection::orthographic, Projection::perspective};

/// The clip of a buffer with depths by (x, y).
template <typename Depth>
ClipDepth clipOf(const Camera& camera, const Grid& volume, const Depth& depth) {
  DepthBuffer buffer(camera, volume);
  for (std::int64_t row = 0; row < buffer.rows(); ++row)
    for (std::int64_t column = 0; column < buffer.columns(); ++column)
      buffer.set(buffer.sample(column, row), depth(buffer.position(column, row)));
  auto pyramid = std::make_shared<const DepthPyramid>(buffer);
  return {camera, std::make_shared<const DepthBuffer>(std::move(buffer)), std::move(pyramid)};
}

/// Looks aslant at the origin.
Camera slantedCamera(Projection projection, int width = 48, int height = 36) {
  CameraPose pose;
  pose.projection = projection;
  pose.position = {130.0, -240.0, 70.0};
  pose.target = {3.0, 2.0, -1.0};
  pose.up = {0.1, 0.2, 1.0};
  pose.scale = 25.0;
  pose.angle = 11.0;
  return {pose, width, height};
}

double waves(const Camera& camera, const Vec2& p) {
  return camera.targetDepth() + 5.0 * std::sin(0.1 * p.x()) - 3.0 * std::cos(0.2 * p.y());
}

Vec3 normalOf(const SurfaceMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  return (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]);
}

/// What holds for any mesh: finite points, all of them used, whose triangles face the eye.
void expectWellMade(const SurfaceMesh& mesh, const Camera& camera) {
  ASSERT_FALSE(mesh.triangles.empty());
  ASSERT_EQ(mesh.points.size(), mesh.depths.size());
  std::set<std::uint32_t> used;
  for (const auto& triangle : mesh.triangles) {
    used.insert(triangle.begin(), triangle.end());
    ASSERT_LT(*used.rbegin(), mesh.points.size());
    const Vec3 corner = mesh.points[triangle[0]];
    const Vec3 toEye = camera.pose().projection == Projection::perspective
                           ? Vec3(camera.pose().position - corner)
                           : Vec3(-camera.forward());
    ASSERT_GT(normalOf(mesh, triangle).dot(toEye), 0.0);
  }
  EXPECT_EQ(used.size(), mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    ASSERT_TRUE(mesh.points[i].allFinite() && std::isfinite(mesh.depths[i]));
}

TEST(SurfaceMesh, APlaneSeenAlongAnAxisLiesWhereItIs) {
  const Camera camera = anteriorCamera(Projection::orthographic, 300.0, 8.0, 24, 16);
  const Grid volume = centredGrid({20, 30, 10}); // in R, A and S: narrower than the viewport
  const auto plane = [](const Vec2& p) { return 290.0 + 0.25 * p.x() - 0.5 * p.y(); };
  const SurfaceMesh mesh = surfaceMesh(clipOf(camera, volume, plane), volume);
  expectWellMade(mesh, camera);
  Vec3 lower = Vec3::Constant(infinity), upper = -lower;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const Vec3& p = mesh.points[i]; // x is R, y is S, and depth grows along A
    EXPECT_NEAR(p.y(), -10.0 + 0.25 * p.x() - 0.5 * p.z(), 1e-6);
    EXPECT_NEAR(std::abs(p.x() - std::round(p.x())), 0.5, 1e-6) << "a pixel's centre";
    EXPECT_NEAR(mesh.depths[i], p.y() + 300.0, 1e-4);
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  const Vec2 pixel(1.0, 1.0);
  for (const auto& [seen, half] : {std::pair{Vec2(lower.x(), lower.z()), Vec2(-10.0, -5.0)},
                                   {Vec2(upper.x(), upper.z()), Vec2(10.0, 5.0)}}) {
    EXPECT_GE((seen.cwiseAbs() - half.cwiseAbs()).minCoeff(), -1e-9) << "all of the volume";
    EXPECT_LE((seen.cwiseAbs() - half.cwiseAbs() - pixel).maxCoeff(), 1e-9) << "and no more";
  }
}

TEST(SurfaceMesh, PointsProjectToTheirSamplesAndHaveTheirDepths) {
  for (const Projection projection : projections) {
    const Camera camera = slantedCamera(projection);
    const Grid volume = centredGrid({60, 50, 40});
    const ClipDepth clip = clipOf(camera, volume, [&](const Vec2& p) { return waves(camera, p); });
    const SurfaceMesh mesh = surfaceMesh(clip, volume);
    expectWellMade(mesh, camera);
    std::set<std::pair<long, long>> samples;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      const Vec3 at = toBuffer(camera, mesh.points[i]);
      const double column = clip.buffer->xAxis().index(at.x());
      const double row = clip.buffer->yAxis().index(at.y());
      ASSERT_NEAR(column, std::round(column), 1e-9);
      ASSERT_NEAR(row, std::round(row), 1e-9);
      ASSERT_NEAR(at.z(), clip.buffer->nearest(at.head<2>()), 1e-9);
      ASSERT_NEAR(mesh.depths[i], at.z(), 1e-4);
      EXPECT_TRUE(samples.emplace(std::lround(column), std::lround(row)).second);
    }
  }
}

TEST(SurfaceMesh, CoversTheVolumesProjection) {
  for (const Projection projection : projections) {
    const Camera camera = slantedCamera(projection);
    const Grid volume = centredGrid({60, 50, 40});
    const ClipDepth clip =
        clipOf(camera, volume, [&](const Vec2&) { return camera.targetDepth(); });
    const SurfaceMesh mesh = surfaceMesh(clip, volume);
    double area = 0.0;
    for (const auto& triangle : mesh.triangles)
      area += 0.5 * normalOf(mesh, triangle).norm();
    std::vector<Vec2> corners;
    for (int i = 0; i < 8; ++i)
      corners.push_back(toBuffer(camera, volume.worldCorner(i)).head<2>());
    double hull = 0.0; // the area of the projection, by edges with all corners to their left
    for (const Vec2& a : corners)
      for (const Vec2& b : corners) {
        const Vec2 edge = b - a;
        const bool outer = std::ranges::all_of(corners, [&](const Vec2& c) {
          return edge.x() * (c - a).y() - edge.y() * (c - a).x() >= -1e-9;
        });
        if (outer && edge.norm() > 0.0)
          hull += 0.5 * (a.x() * b.y() - a.y() * b.x());
      }
    const double sample = camera.pixelPitch() * clip.buffer->xAxis().factor;
    EXPECT_GT(area, hull);
    EXPECT_LT(area, hull + 4.0 * sample * 2.0 * std::sqrt(pi * hull)) << "its edge's steps";
  }
}

TEST(SurfaceMesh, LeavesOutWhatHasNoDepthOrIsBehindTheEye) {
  const Grid volume = centredGrid({40, 40, 40});
  const Camera parallel = anteriorCamera(Projection::orthographic, 300.0, 10.0, 40, 40);
  const auto disk = [](const Vec2& p) { return p.norm() < 6.0 ? 290.0 : -infinity; };
  const SurfaceMesh cutaway = surfaceMesh(clipOf(parallel, volume, disk), volume);
  expectWellMade(cutaway, parallel);
  double area = 0.0;
  for (const auto& triangle : cutaway.triangles)
    area += 0.5 * normalOf(cutaway, triangle).norm();
  EXPECT_LT(area, pi * 36.0);
  EXPECT_GT(area, pi * 36.0 - 2.0 * pi * 6.0 * parallel.pixelPitch()) << "but its edge's halves";

  const Camera inside = anteriorCamera(Projection::perspective, 10.0, 10.0, 40, 40);
  const auto ramp = [](const Vec2& p) { return 3.0 + 0.5 * p.x(); };
  const SurfaceMesh mesh = surfaceMesh(clipOf(inside, volume, ramp), volume);
  expectWellMade(mesh, inside);
  for (const float depth : mesh.depths)
    EXPECT_GT(depth, 0.0f);

  const auto dot = [](const Vec2& p) {
    return (p - Vec2(0.25, 0.25)).norm() < 0.1 ? 290.0 : -infinity;
  };
  EXPECT_TRUE(surfaceMesh(clipOf(parallel, volume, dot), volume).points.empty());
  const auto none = [](const Vec2&) { return -infinity; };
  EXPECT_TRUE(surfaceMesh(clipOf(parallel, volume, none), volume).points.empty());
}

TEST(SurfaceMesh, TakesEveryNthSampleOfALargeBufferAndTheEdges) {
  const Grid volume = centredGrid({200, 200, 150});
  const Camera camera = anteriorCamera(Projection::orthographic, 300.0, 20.0, 300, 300);
  const auto flat = [](const Vec2&) { return 290.0; };
  const ClipDepth clip = clipOf(camera, volume, flat);
  ASSERT_GT(clip.buffer->size(), 5 * mostSurfacePoints);
  const SurfaceMesh mesh = surfaceMesh(clip, volume);
  expectWellMade(mesh, camera);
  EXPECT_LE(static_cast<std::int64_t>(mesh.points.size()), mostSurfacePoints);
  EXPECT_GT(static_cast<std::int64_t>(mesh.points.size()), mostSurfacePoints / 3);
  double area = 0.0;
  for (const auto& triangle : mesh.triangles)
    area += 0.5 * normalOf(mesh, triangle).norm();
  EXPECT_GE(area, 200.0 * 150.0);
  EXPECT_LT(area, 202.0 * 152.0);

  // A small focus loses nothing to a large volume.
  const auto small = [](const Vec2& p) { return p.norm() < 3.0 ? 290.0 : -infinity; };
  const SurfaceMesh fine = surfaceMesh(clipOf(camera, volume, small), volume);
  const double pitch = camera.pixelPitch();
  EXPECT_NEAR(static_cast<double>(fine.triangles.size()), 2.0 * pi * 9.0 / (pitch * pitch),
              0.1 * static_cast<double>(fine.triangles.size()));
}

} // namespace
