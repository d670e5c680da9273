// Mesh of the clipping surface. Its points are buffer samples, on their camera rays at their
// depths. Its triangles face the camera, share complete edges, and deviate from the samples by at
// most the tolerance.

#include "Approx.h"
#include "ClippingTesting.h"
#include "clip/mesh/SurfaceMesh.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <set>

namespace fenestra::core::SurfaceMeshTests {
using namespace testing_clipping;

namespace {

constexpr std::array projections{Projection::orthographic, Projection::perspective};

/// Clip with a buffer of the depths depth(x, y).
template <typename Depth>
ClipDepth makeClip(const Camera& camera, const Grid& volume, const Depth& depth) {
  DepthBuffer buffer(camera, volume);
  for (std::int64_t row = 0; row < buffer.rows(); ++row)
    for (std::int64_t column = 0; column < buffer.columns(); ++column)
      buffer.set(buffer.sample(column, row), depth(buffer.position(column, row)));
  auto pyramid = std::make_shared<const DepthPyramid>(buffer);
  return {camera, std::make_shared<const DepthBuffer>(std::move(buffer)), std::move(pyramid)};
}

/// Camera with an oblique view of the origin.
Camera makeSlantedCamera(Projection projection, int width = 48, int height = 36) {
  CameraPose pose;
  pose.projection = projection;
  pose.position = {130.0, -240.0, 70.0};
  pose.target = {3.0, 2.0, -1.0};
  pose.up = {0.1, 0.2, 1.0};
  pose.scale = 25.0;
  pose.angle = 11.0;
  return {pose, width, height};
}

double computeWaveDepth(const Camera& camera, const Vec2& p) {
  return camera.targetDepth() + 5.0 * std::sin(0.1 * p.x()) - 3.0 * std::cos(0.2 * p.y());
}

/// Surfaces that are difficult to mesh, by name.
using Shape = std::function<double(const Vec2&)>;
std::map<std::string, Shape> makeShapes(const Camera& camera) {
  const double at = camera.targetDepth(), pitch = camera.pixelPitch();
  const auto random = [](const Vec2& p) {
    return Random(7, static_cast<std::uint64_t>(std::llround(1e3 * p.x()) + 1000000),
                  static_cast<std::uint64_t>(std::llround(1e3 * p.y()) + 1000000))
        .uniform();
  };
  return {
      {"waves", [=](const Vec2& p) { return computeWaveDepth(camera, p); }},
      {"a slanted step", [=](const Vec2& p) { return p.x() < 0.37 * p.y() ? at : at + 15.0; }},
      {"a thin wall", [=](const Vec2& p) { return std::abs(p.x()) < 0.6 * pitch ? at - 9.0 : at; }},
      {"a spike", [=](const Vec2& p) { return p.norm() < pitch ? at - 20.0 : at; }},
      {"noise", [=](const Vec2& p) { return at + 20.0 * random(p); }},
      {"a little noise", [=](const Vec2& p) { return at + 0.2 * random(p); }},
      {"a disk",
       [=](const Vec2& p) { return p.norm() < 8.3 ? computeWaveDepth(camera, p) : -infinity; }},
      {"torn",
       [=](const Vec2& p) { return random(p) < 0.6 ? computeWaveDepth(camera, p) : -infinity; }},
  };
}

/// Signed area on the plane through the target, mm^2; positive if counter-clockwise.
double computeSignedArea(const Vec2& a, const Vec2& b, const Vec2& c) {
  return 0.5 * ((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
}

Vec3 computeNormal(const SurfaceMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  return (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]);
}

/// Expects finite points that are all used, and triangles that face the camera.
void expectValidMesh(const SurfaceMesh& mesh, const Camera& camera) {
  ASSERT_FALSE(mesh.triangles.empty());
  ASSERT_EQ(mesh.points.size(), mesh.depths.size());
  std::set<std::uint32_t> used;
  for (const auto& triangle : mesh.triangles) {
    used.insert(triangle.begin(), triangle.end());
    ASSERT_LT(*used.rbegin(), mesh.points.size());
    const Vec3 corner = mesh.points[triangle[0]];
    const Vec3 toCamera = camera.pose().projection == Projection::perspective
                              ? Vec3(camera.pose().position - corner)
                              : Vec3(-camera.forward());
    ASSERT_GT(computeNormal(mesh, triangle).dot(toCamera), 0.0);
  }
  EXPECT_EQ(used.size(), mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    ASSERT_TRUE(allFinite(mesh.points[i]) && std::isfinite(mesh.depths[i]));
}

TEST(SurfaceMesh, PlaneHasCorrectPositions) {
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 300.0, 8.0, 24, 16);
  const Grid volume =
      makeCenteredGrid({20, 30, 10}); // along R, A and S; narrower than the viewport
  const auto plane = [](const Vec2& p) { return 290.0 + 0.25 * p.x() - 0.5 * p.y(); };
  const SurfaceMesh mesh = buildSurfaceMesh(makeClip(camera, volume, plane), volume, 0.0);
  expectValidMesh(mesh, camera);
  Vec3 lower = Vec3::Constant(infinity), upper = -lower;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const Vec3& p = mesh.points[i]; // x is R, y is S, and depth increases along A
    EXPECT_NEAR(p.y(), -10.0 + 0.25 * p.x() - 0.5 * p.z(), 1e-6);
    EXPECT_NEAR(std::abs(p.x() - std::round(p.x())), 0.5, 1e-6) << "a pixel center";
    EXPECT_NEAR(mesh.depths[i], p.y() + 300.0, 1e-4);
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  const Vec2 pixel(1.0, 1.0);
  for (const auto& [extent, halfSize] : {std::pair{Vec2(lower.x(), lower.z()), Vec2(-10.0, -5.0)},
                                         {Vec2(upper.x(), upper.z()), Vec2(10.0, 5.0)}}) {
    EXPECT_GE((extent.cwiseAbs() - halfSize.cwiseAbs()).minCoeff(), -1e-9) << "covers the volume";
    EXPECT_LE((extent.cwiseAbs() - halfSize.cwiseAbs() - pixel).maxCoeff(), 1e-9) << "and not more";
  }
}

TEST(SurfaceMesh, PointsProjectToSamplesAndHaveTheirDepths) {
  for (const Projection projection : projections) {
    const Camera camera = makeSlantedCamera(projection);
    const Grid volume = makeCenteredGrid({60, 50, 40});
    const ClipDepth clip =
        makeClip(camera, volume, [&](const Vec2& p) { return computeWaveDepth(camera, p); });
    const SurfaceMesh mesh = buildSurfaceMesh(clip, volume, 1e-3);
    expectValidMesh(mesh, camera);
    std::set<std::pair<long, long>> samples;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      const Vec3 at = toBuffer(camera, mesh.points[i]);
      const double column = clip.buffer->xAxis().index(at.x());
      const double row = clip.buffer->yAxis().index(at.y());
      ASSERT_NEAR(column, std::round(column), 1e-9);
      ASSERT_NEAR(row, std::round(row), 1e-9);
      ASSERT_NEAR(at.z(), clip.buffer->nearestDepth(at.head<2>()), 1e-9);
      ASSERT_NEAR(mesh.depths[i], at.z(), 1e-4);
      EXPECT_TRUE(samples.emplace(std::lround(column), std::lround(row)).second);
    }
  }
}

TEST(SurfaceMesh, CoversTheVolumesProjection) {
  for (const Projection projection : projections) {
    const Camera camera = makeSlantedCamera(projection);
    const Grid volume = makeCenteredGrid({60, 50, 40});
    const ClipDepth clip =
        makeClip(camera, volume, [&](const Vec2&) { return camera.targetDepth(); });
    const SurfaceMesh mesh = buildSurfaceMesh(clip, volume, 1e-3);
    double area = 0.0;
    for (const auto& triangle : mesh.triangles)
      area += 0.5 * computeNormal(mesh, triangle).norm();
    std::vector<Vec2> corners;
    for (int i = 0; i < 8; ++i)
      corners.push_back(toBuffer(camera, volume.worldCorner(i)).head<2>());
    double hull = 0.0; // area of the projection, summed over edges with all corners on their left
    for (const Vec2& a : corners)
      for (const Vec2& b : corners) {
        const Vec2 edge = b - a;
        const bool isOuter = std::ranges::all_of(corners, [&](const Vec2& c) {
          return edge.x() * (c - a).y() - edge.y() * (c - a).x() >= -1e-9;
        });
        if (isOuter && edge.norm() > 0.0)
          hull += 0.5 * (a.x() * b.y() - a.y() * b.x());
      }
    const double sample = camera.pixelPitch() * clip.buffer->xAxis().factor;
    EXPECT_GT(area, hull);
    EXPECT_LT(area, hull + 4.0 * sample * 2.0 * std::sqrt(pi * hull)) << "the steps at its edge";
  }
}

TEST(SurfaceMesh, OmitsSamplesWithoutDepthOrBehindTheCamera) {
  const Grid volume = makeCenteredGrid({40, 40, 40});
  const Camera parallel = makeAnteriorCamera(Projection::orthographic, 300.0, 10.0, 40, 40);
  const auto disk = [](const Vec2& p) { return p.norm() < 6.0 ? 290.0 : -infinity; };
  const SurfaceMesh cutaway = buildSurfaceMesh(makeClip(parallel, volume, disk), volume, 1e-3);
  expectValidMesh(cutaway, parallel);
  double area = 0.0;
  for (const auto& triangle : cutaway.triangles)
    area += 0.5 * computeNormal(cutaway, triangle).norm();
  EXPECT_LT(area, pi * 36.0);
  EXPECT_GT(area, pi * 36.0 - 2.0 * pi * 6.0 * parallel.pixelPitch()) << "except half edge cells";

  const Camera inside = makeAnteriorCamera(Projection::perspective, 10.0, 10.0, 40, 40);
  const auto ramp = [](const Vec2& p) { return 3.0 + 0.5 * p.x(); };
  const SurfaceMesh mesh = buildSurfaceMesh(makeClip(inside, volume, ramp), volume, 1e-3);
  expectValidMesh(mesh, inside);
  for (const float depth : mesh.depths)
    EXPECT_GT(depth, 0.0f);

  const auto dot = [](const Vec2& p) {
    return (p - Vec2(0.25, 0.25)).norm() < 0.1 ? 290.0 : -infinity;
  };
  EXPECT_TRUE(buildSurfaceMesh(makeClip(parallel, volume, dot), volume, 1e-3).points.empty());
  const auto none = [](const Vec2&) { return -infinity; };
  EXPECT_TRUE(buildSurfaceMesh(makeClip(parallel, volume, none), volume, 1e-3).points.empty());
}

/// Errors of a mesh, computed from its triangles in world space only.
struct MeshError {
  double maximum = 0.0; ///< largest depth difference between samples and mesh
  /// Number of triangles over each sample (column, row); not counted on their edges.
  std::map<std::pair<std::int64_t, std::int64_t>, int> coverage;
};

MeshError measureError(const SurfaceMesh& mesh, const ClipDepth& clip) {
  const DepthBuffer& buffer = *clip.buffer;
  MeshError error;
  for (const auto& triangle : mesh.triangles) {
    std::array<Vec2, 3> at;
    Vec2 lower = Vec2::Constant(infinity), upper = -lower; // columns and rows
    for (std::size_t i = 0; i < 3; ++i) {
      at[i] = toBuffer(clip.camera, mesh.points[triangle[i]]).head<2>();
      const Vec2 index(buffer.xAxis().index(at[i].x()), buffer.yAxis().index(at[i].y()));
      lower = lower.cwiseMin(index);
      upper = upper.cwiseMax(index);
    }
    const double area = computeSignedArea(at[0], at[1], at[2]);
    const Vec3 normal = computeNormal(mesh, triangle);
    for (std::int64_t row = std::lround(lower.y()); row <= std::lround(upper.y()); ++row)
      for (std::int64_t column = std::lround(lower.x()); column <= std::lround(upper.x());
           ++column) {
        const Vec2 p = buffer.position(column, row);
        const double inside =
            std::min({computeSignedArea(at[0], at[1], p), computeSignedArea(at[1], at[2], p),
                      computeSignedArea(at[2], at[0], p)}) /
            area;
        if (inside < -1e-7)
          continue;
        const Ray ray = clip.camera.makePlaneRay(p);
        const double t =
            (mesh.points[triangle[0]] - ray.origin).dot(normal) / ray.direction.dot(normal);
        const double depth = t * clip.camera.depthPerLength(ray);
        error.maximum =
            std::max(error.maximum, std::abs(depth - buffer.at(buffer.sample(column, row))));
        error.coverage[{column, row}] += inside > 1e-7 ? 1 : 0;
      }
  }
  return error;
}

/// Expects each edge to have one triangle per side or to belong to the outline, and no point inside
/// an outline edge, which would be a T-junction.
void expectNoCracks(const SurfaceMesh& mesh, const Camera& camera) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& [a, b, c] : mesh.triangles)
    for (const auto& edge : {std::pair{a, b}, {b, c}, {c, a}})
      ASSERT_TRUE(edges.insert(edge).second) << "two triangles on one side of an edge";
  std::vector<Vec2> at;
  std::multimap<double, std::size_t> byX, byY;
  for (const Vec3& point : mesh.points) {
    at.push_back(toBuffer(camera, point).head<2>());
    byX.emplace(at.back().x(), at.size() - 1);
    byY.emplace(at.back().y(), at.size() - 1);
  }
  const double pitch = camera.pixelPitch();
  for (const auto& [from, to] : edges) {
    if (edges.contains({to, from}))
      continue;
    const Vec2 a = at[from], b = at[to], direction = (b - a).normalized();
    const bool isUpright = std::abs(direction.y()) > std::abs(direction.x());
    const auto& sorted = isUpright ? byY : byX;
    const auto [low, high] = isUpright ? std::minmax(a.y(), b.y()) : std::minmax(a.x(), b.x());
    for (auto point = sorted.upper_bound(low + 1e-6 * pitch);
         point != sorted.end() && point->first < high - 1e-6 * pitch; ++point) {
      const Vec2 d = at[point->second] - a;
      ASSERT_GT(std::abs(d.x() * direction.y() - d.y() * direction.x()), 1e-3 * pitch)
          << "a point inside an outline edge";
    }
  }
}

TEST(SurfaceMesh, ErrorAtSamplesIsWithinTheTolerance) {
  for (const Projection projection : projections)
    for (const auto& [width, height] : {std::pair{48, 36}, {33, 65}, {17, 90}}) {
      const Camera camera = makeSlantedCamera(projection, width, height);
      const Grid volume = makeCenteredGrid({30, 50, 40});
      for (const auto& [name, shape] : makeShapes(camera)) {
        const ClipDepth clip = makeClip(camera, volume, shape);
        std::size_t before = 0;
        for (const double tolerance : {1.0, 0.1, 0.01}) {
          SCOPED_TRACE(name + " to " + std::to_string(tolerance) + " mm");
          const SurfaceMesh mesh = buildSurfaceMesh(clip, volume, tolerance);
          expectValidMesh(mesh, camera);
          expectNoCracks(mesh, camera);
          const MeshError error = measureError(mesh, clip);
          EXPECT_LE(error.maximum, tolerance + 1e-9);
          for (const auto& [sample, triangles] : error.coverage)
            ASSERT_LE(triangles, 1);
          EXPECT_GE(mesh.triangles.size(), before);
          before = mesh.triangles.size();
        }
      }
    }
}

TEST(SurfaceMesh, CoversEveryCellWithAtLeastThreeDepths) {
  const Camera camera = makeAnteriorCamera(Projection::orthographic, 300.0, 10.0, 37, 50);
  const Grid volume =
      makeCenteredGrid({60, 60, 60}); // exceeds the viewport; coarser samples outside it
  for (const auto& [name, shape] : makeShapes(camera)) {
    const ClipDepth clip = makeClip(camera, volume, shape);
    const DepthBuffer& buffer = *clip.buffer;
    double cells = 0.0;
    for (std::int64_t row = 0; row + 1 < buffer.rows(); ++row)
      for (std::int64_t column = 0; column + 1 < buffer.columns(); ++column) {
        int corners = 0;
        for (const auto& [right, down] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}})
          corners += std::isfinite(buffer.at(buffer.sample(column + right, row + down))) ? 1 : 0;
        const Vec2 edges = buffer.position(column + 1, row + 1) - buffer.position(column, row);
        cells += 0.5 * std::max(0, corners - 2) * std::abs(edges.x() * edges.y());
      }
    const SurfaceMesh mesh = buildSurfaceMesh(clip, volume, 0.05);
    double area = 0.0;
    for (const auto& [a, b, c] : mesh.triangles)
      area += computeSignedArea(toBuffer(camera, mesh.points[a]).head<2>(),
                                toBuffer(camera, mesh.points[b]).head<2>(),
                                toBuffer(camera, mesh.points[c]).head<2>());
    EXPECT_NEAR(area, cells, 1e-9 * cells) << name;
  }
}

TEST(SurfaceMesh, PlaneNeedsTwoTrianglesAndNoiseAllSamples) {
  const Grid volume = makeCenteredGrid({30, 30, 30});
  for (const Projection projection : projections) {
    const Camera camera = makeAnteriorCamera(projection, 300.0, 15.0, 200, 200);
    // In perspective, the depth of a plane is not linear in the image.
    const auto plane = [&](const Vec2& p) {
      const Vec3 normal(0.3, 1.0, -0.2);
      const Ray ray = camera.makePlaneRay(p);
      const double t = (Vec3(0, -12, 0) - ray.origin).dot(normal) / ray.direction.dot(normal);
      return t * camera.depthPerLength(ray);
    };
    const ClipDepth flat = makeClip(camera, volume, plane);
    const double tolerance = surfaceTolerance(camera);
    EXPECT_DOUBLE_EQ(tolerance, 0.015);
    const SurfaceMesh flatMesh = buildSurfaceMesh(flat, volume, tolerance);
    EXPECT_EQ(flatMesh.triangles.size(), 2u);
    EXPECT_EQ(flatMesh.points.size(), 4u);
    EXPECT_LE(measureError(flatMesh, flat).maximum, tolerance);

    // A step costs triangles in proportion to the length of its edge; noise needs every sample.
    const auto step = [&](const Vec2& p) { return plane(p) + (p.x() < 0.31 * p.y() ? 0.0 : 9.0); };
    const auto columns = static_cast<std::size_t>(flat.buffer->columns());
    EXPECT_LT(buildSurfaceMesh(makeClip(camera, volume, step), volume, tolerance).triangles.size(),
              14 * columns);
    const ClipDepth noise = makeClip(camera, volume, makeShapes(camera).at("noise"));
    const std::size_t maxTriangles = buildSurfaceMesh(noise, volume, 0.0).triangles.size();
    EXPECT_GT(buildSurfaceMesh(noise, volume, tolerance).triangles.size(), maxTriangles * 95 / 100);
    EXPECT_LE(maxTriangles, 2 * static_cast<std::size_t>(flat.buffer->size()));
  }
}

TEST(SurfaceMesh, TriangleCountDoesNotDependOnTheSizeOfTheSubject) {
  std::vector<std::size_t> triangles;
  for (const double size : {1.0, 512.0}) {
    const Camera camera =
        makeAnteriorCamera(Projection::orthographic, 5.0 * size, 0.6 * size, 100, 100);
    const Grid volume = makeCenteredGrid({16, 16, 16}, Vec3::Constant(size / 16.0));
    const auto bump = [&](const Vec2& p) {
      return 5.0 * size - 0.3 * size * std::exp(-9.0 * p.squaredNorm() / (size * size));
    };
    triangles.push_back(
        buildSurfaceMesh(makeClip(camera, volume, bump), volume, surfaceTolerance(camera))
            .triangles.size());
  }
  EXPECT_NEAR(static_cast<double>(triangles[0]), static_cast<double>(triangles[1]), 8.0);
  EXPECT_GT(triangles[0], 100u);
  EXPECT_LT(triangles[0], 5000u);
}

} // namespace
} // namespace fenestra::core::SurfaceMeshTests
