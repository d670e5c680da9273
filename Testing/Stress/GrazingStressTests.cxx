// Rays along faces, edges and diagonals, and through corners, exactly and within rounding.

#include "StressSupport.h"

namespace fenestra::core::testing::GrazingStressTests {
namespace {

constexpr double sigma = 0.2;

struct GrazedGrid {
  const char* name;
  Grid grid;
};

std::vector<GrazedGrid> makeGrids() {
  const auto rotate = [](const Grid& grid) {
    const Affine rotation(makeTranslation({5.0, -3.0, 2.0}) *
                          makeRotation(0.7, Vec3(1.0, 2.0, -0.5).normalized()));
    return Grid(grid.size, rotation * grid.indexToWorld);
  };
  const Grid unit = makeCenteredGrid({6, 5, 4}, Vec3::Ones());
  return {{"unit", unit},
          {"uneven", makeCenteredGrid({6, 5, 4}, {0.3, 0.7, 1.1})},
          {"rotated", rotate(unit)},
          {"far", Grid(unit.size, Affine(makeTranslation({1e6, 1e6, 1e6})) * unit.indexToWorld)}};
}

Volume makeUniformVolume(const Grid& grid) {
  return makeVolume(grid, [](const Vec3&) { return 1.0; });
}

/// World ray of a ray given in index space.
Ray toWorld(const Grid& grid, const Vec3& origin, const Vec3& direction) {
  return {grid.indexToWorld * origin, (grid.indexToWorld.linear() * direction).normalized()};
}

class Grazing : public ::testing::TestWithParam<int> {
protected:
  Grazing()
      : m_grid(makeGrids()[static_cast<std::size_t>(GetParam())].grid),
        m_volume(makeUniformVolume(m_grid)) {}

  /// Bound of a world coordinate's rounding error and of its effect on a chord, mm.
  double rounding() const {
    return 64.0 * 0x1p-53 * (20.0 + m_grid.indexToWorld.translation().cwiseAbs().maxCoeff());
  }

  bool isRotated() const {
    int zeros = 0;
    for (int axis = 0; axis < 3; ++axis)
      zeros += static_cast<int>(std::ranges::count(m_grid.indexToWorld.linear().col(axis), 0.0));
    return zeros < 6;
  }

  Grid m_grid;
  Volume m_volume;
};

/// Off-axis components of an axis-parallel direction.
constexpr double slopes[] = {0.0, -0.0, 5e-324, -5e-324, 1e-300, -1e-300, 1e-17, -1e-17};

TEST_P(Grazing, RayAlongFaceOrEdgeWalksAllOrNothing) {
  const RayProbe<> probe(m_volume, makeLinearTransfer(sigma, Rgb::Zero()));
  const Box box = m_grid.indexBox();
  int inside = 0, outside = 0;
  for (int along = 0; along < 3; ++along)
    for (int corner = 0; corner < 4; ++corner) // selects the edge
      for (const bool edge : {false, true})
        for (const int ulps : {-1, 0, 1})
          for (const double slope : slopes) {
            const int a = (along + 1) % 3, b = (along + 2) % 3;
            Vec3 origin, direction = Vec3::Zero();
            origin[along] = -3.0;
            origin[a] = corner & 1 ? box.upper[a] : box.lower[a];
            origin[a] = ulps == 0 ? origin[a] : std::nextafter(origin[a], ulps * 1e9);
            origin[b] = edge ? (corner & 2 ? box.upper[b] : box.lower[b]) : 1.25;
            direction[along] = 1.0;
            direction[a] = slope;
            const Ray ray = toWorld(m_grid, origin, direction);
            const double full = m_grid.spacing()[along] * static_cast<double>(m_grid.size[along]);
            const double walked = probe.measureWalk(ray);
            (walked > 0.5 * full ? inside : outside) += 1;
            EXPECT_LT(walked, full + rounding());
            // The rounded slope of a rotated ray may leave the face.
            EXPECT_TRUE(isRotated() || walked > full - rounding() || walked == 0.0)
                << walked << " of " << full;
          }
  EXPECT_GT(inside, 0);
}

TEST_P(Grazing, RayNextToFaceWalksChord) {
  const RayProbe<> probe(m_volume, makeLinearTransfer(sigma, Rgb::Zero()));
  const Box box = m_grid.indexBox();
  for (int along = 0; along < 3; ++along)
    for (const bool upper : {false, true})
      for (const double side : {-1e-6, 1e-6, 0.3, 0.5})
        for (const double slope : {0.0, -0.0, 1e-300, -1e-17, 1e-9, -1e-9}) {
          const int a = (along + 1) % 3;
          Vec3 origin = Vec3::Constant(1.0), direction = Vec3::Zero();
          origin[along] = -3.0;
          origin[a] = upper ? box.upper[a] - side : box.lower[a] + side;
          direction[along] = 1.0;
          direction[a] = slope;
          const Ray ray = toWorld(m_grid, origin, direction);
          EXPECT_NEAR(probe.measureWalk(ray), chord(m_grid, ray), rounding())
              << side << " " << slope;
        }
}

/// Directions through corners of voxels: to voxels at index offsets of up to 2.
std::vector<Vec3> makeLatticeDirections() {
  std::vector<Vec3> directions;
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y)
      for (int z = -2; z <= 2; ++z)
        if (x != 0 || y != 0 || z != 0)
          directions.emplace_back(x, y, z);
  return directions;
}

TEST_P(Grazing, RayThroughVoxelCentersAndCornersWalksChord) {
  const RayProbe<> probe(m_volume, makeLinearTransfer(sigma, Rgb::Zero()));
  double greatest = 0.0;
  for (const Vec3& offset : {Vec3(0, 0, 0), Vec3(0.5, 0, 0), Vec3(0.5, 0.5, 0), Vec3(0.5, 0.5, 0.5),
                             Vec3(0.5, std::nextafter(0.5, 1.0), std::nextafter(0.5, 0.0))})
    for (const Vec3& direction : makeLatticeDirections())
      for (const double back : {0.0, 8.0}) { // from inside and from outside
        const Vec3 start = Vec3(2, 2, 1) + offset;
        const Ray ray = toWorld(m_grid, start - back * direction, direction);
        const double expected = chord(m_grid, ray);
        EXPECT_NEAR(probe.measureWalk(ray), expected, rounding()) << start << " | " << direction;
        greatest = std::max(greatest, expected);
        if (back == 0.0 && offset.y() == 0.5 && direction.cwiseAbs().maxCoeff() == 1.0)
          probe.expectTransmittance(ray, {}, std::exp(-sigma * expected), scaleSamples(1000));
      }
  EXPECT_GT(greatest, 2.0);
}

TEST_P(Grazing, RayFromCornerWalksChordInwardAndNothingOutward) {
  const RayProbe<> probe(m_volume, makeLinearTransfer(sigma, Rgb::Zero()));
  const Box box = m_grid.indexBox();
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 at = box.corner(corner);
    const Vec3 inward =
        (box.center() - at).unaryExpr([](double x) { return std::copysign(1.0, x); });
    EXPECT_NEAR(probe.measureWalk(toWorld(m_grid, at, inward)),
                chord(m_grid, toWorld(m_grid, at, inward)), rounding());
    EXPECT_LT(probe.measureWalk(toWorld(m_grid, at, -inward)), rounding());
  }
}

INSTANTIATE_TEST_SUITE_P(Grids, Grazing, ::testing::Range(0, 4), [](const auto& info) {
  return std::string(makeGrids()[static_cast<std::size_t>(info.param)].name);
});

// Faces that are exact in binary: a ray that lies in such a face counts as inside (Box::clip).
TEST(ExactFaces, RayInFaceCountsAsInside) {
  const Grid grid = makeCenteredGrid({6, 4, 2}, Vec3::Ones());
  const Volume volume = makeUniformVolume(grid);
  const RayProbe<> probe(volume, makeLinearTransfer(sigma, Rgb::Zero()));
  for (const double zero : {0.0, -0.0}) {
    EXPECT_EQ(probe.measureWalk({{-9.0, 2.0, 1.0}, {1.0, zero, zero}}), 6.0);
    EXPECT_EQ(probe.measureWalk({{-9.0, -2.0, -1.0}, {1.0, zero, zero}}), 6.0);
    EXPECT_EQ(probe.measureWalk({{-9.0, std::nextafter(2.0, 3.0), 0.0}, {1.0, zero, zero}}), 0.0);
    EXPECT_EQ(probe.measureWalk({{3.0, 0.0, 9.0}, {zero, zero, -1.0}}), 2.0);
  }
  const Ray inFace{{-9.0, 2.0, 1.0}, Vec3::UnitX()};
  probe.expectTransmittance(inFace, {}, std::exp(-sigma * 6.0), scaleSamples(10000));
}

} // namespace
} // namespace fenestra::core::testing::GrazingStressTests
