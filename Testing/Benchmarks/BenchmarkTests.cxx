// Tests of the benchmark: its baselines, its statistics, and a run of the complete program on small
// images. No test measures time.

#include "Benchmarks/Baselines.h"
#include "Benchmarks/Curve.h"
#include "Support.h"
#include "TemporaryFolder.h"

#include "Agreement.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace fenestra::core::benchmarks {
namespace {

constexpr const char* samples = FENESTRA_SAMPLES; // small phantoms
constexpr const char* foot = " {phantoms}/foot/foot.mrml --size 32x32 --background 0,0,0\n";
constexpr const char* knee =
    " {phantoms}/knee/knee.mrml --focus FemoralCartilage --materials none --size 32x32 "
    "--context-saturation 1 --background 0,0,0\n";

SceneCase makeCase(const std::string& line) {
  const TemporaryFolder folder;
  return readScenes(folder.write("table.txt", line), {"", "", samples}).front();
}

Image renderMode(const char* mode, const PreparedScene& scene, const RenderOptions& options,
                 std::uint64_t count, std::uint64_t seed) {
  RenderSettings settings = makeSettings(options, scene.background());
  settings.samples = count;
  settings.seed = seed;
  return toImage(findMode(mode).render(scene.view(), settings), scene);
}

class UnbiasedMode : public ::testing::TestWithParam<const char*> {};

TEST_P(UnbiasedMode, ImageAgreesWithScalarMode) {
  const RenderOptions options = makeCase(std::string("knee product") + knee).options();
  const PreparedScene scene(options.scene);
  const Image image = renderMode(GetParam(), scene, options, 96, 1);
  const Image reference = renderMode("scalar", scene, options, 96, 2);
  for (const int tile : {8, 32})
    EXPECT_GT(computeAgreement(computeTileMeans(image, tile), computeTileMeans(reference, tile)),
              1e-4);
}

INSTANTIATE_TEST_SUITE_P(Modes, UnbiasedMode, ::testing::Values("product", "adaptive", "global"),
                         [](const auto& info) { return std::string(info.param); });

/// Mean of R over the image, relative to that of another image, minus 1; and its standard error.
std::pair<double, double> measureBias(const Image& image, const Image& reference) {
  const Image a = computeTileMeans(image, image.width),
              b = computeTileMeans(reference, reference.width);
  const double mean = b.find("R")->front();
  return {a.find("R")->front() / mean - 1.0,
          std::hypot(a.find("error.R")->front(), b.find("error.R")->front()) / mean};
}

/// The foot has voxels of 6 mm, so steps of one voxel miss its skin.
TEST(Marching, BiasShrinksWithShorterSteps) {
  const RenderOptions options = makeCase(std::string("foot product") + foot).options();
  const PreparedScene scene(options.scene);
  const Image reference = renderMode("scalar", scene, options, 128, 1);
  const auto [full, error] = measureBias(renderMode("marching", scene, options, 128, 2), reference);
  const auto [half, halfError] =
      measureBias(renderMode("marching-half", scene, options, 128, 3), reference);
  EXPECT_GT(std::abs(full), 4.0 * error) << full;
  EXPECT_LT(std::abs(half), std::abs(full)) << half << " ± " << halfError;
}

/// A ray across a homogeneous wall that is a quarter of a voxel thick (voxels of 1 mm). Returns the
/// mean transmittance of a tracker, and the fraction of its rays that pass without a collision.
class Wall {
public:
  static constexpr double sigma_t = 3.0;
  static constexpr int trials = 20000;
  static constexpr double tolerance =
      4.0 * 0.5 / 141.0; ///< 4 standard errors <= 0.5 / sqrt(trials)

  template <typename MakeTracker>
  std::pair<double, double> cross(MakeTracker&& makeTracker) const {
    const auto tracker = makeTracker(m_scene, m_medium);
    const Ray ray{{0.3, -0.2, -10.0}, Vec3::UnitZ()};
    Counters counters;
    double light = 0.0, passing = 0.0;
    for (std::uint64_t i = 0; i < trials; ++i) {
      Random random(1, 2, i);
      light += tracker.transmittance(ray, {}, random, counters) / trials;
      passing +=
          (tracker.sampleCollision(ray, {}, random.uniform2(), random, counters) == infinity) *
          (1.0 / trials);
    }
    return {light, passing};
  }

private:
  Volume m_volume = testing::makeVolume(testing::makeCenteredGrid({8, 8, 8}, Vec3::Ones()),
                                        [](const Vec3&) { return 1; });
  TransferFunction m_transfer = testing::makeLinearTransfer(sigma_t, Rgb::Ones());
  Camera m_camera{{}, 1, 1};
  Clip m_clip;
  LightSet m_lights{{}, m_volume.grid, m_camera};
  MajorantGrid m_majorants{m_volume.grid, MinMaxGrid(m_volume, 0), m_transfer, m_clip};
  SceneView m_scene{m_volume,
                    m_transfer,
                    m_majorants,
                    m_lights,
                    m_camera,
                    m_clip,
                    CropBox(Affine(makeScaling({4.0, 4.0, 0.125})))};
  Medium<float> m_medium{m_volume.grid, std::get<LargeArray<float>>(m_volume.voxels), m_transfer};
};

TEST(GlobalTracker, ThinWallTransmittanceIsExponential) {
  const auto [light, passing] = Wall().cross(
      [](const auto& scene, const auto& medium) { return GlobalTracker<float>(scene, medium); });
  const double expected = std::exp(-Wall::sigma_t / 4.0);
  EXPECT_NEAR(light, expected, Wall::tolerance);
  EXPECT_NEAR(passing, expected, Wall::tolerance);
}

/// One ray march in four has a sample in the wall. The mean transmittance is 3/4 + exp(-sigma_t
/// step) / 4, not exp(-sigma_t step / 4).
TEST(Marching, ThreeMarchesInFourMissAThinWall) {
  const auto [light, passing] = Wall().cross([](const auto& scene, const auto& medium) {
    return MarchingTracker<float>(scene, medium, 1.0);
  });
  const double expected = 0.75 + 0.25 * std::exp(-Wall::sigma_t);
  EXPECT_NEAR(light, expected, Wall::tolerance);
  EXPECT_NEAR(passing, expected, Wall::tolerance);
}

/// Curve with relMSE = 1 / (20 seconds), so that its efficiency is 20.
std::vector<Point> idealCurve(std::initializer_list<double> seconds) {
  std::vector<Point> curve;
  for (const double s : seconds)
    curve.push_back({.samples = 4, .seeds = 2, .cpuSeconds = s, .relMse = 1.0 / (20.0 * s)});
  return curve;
}

TEST(Efficiency, TargetWithinTheCurveIsInterpolated) {
  const auto efficiency = findEfficiency(idealCurve({2.0, 16.0, 70.0, 300.0}), 1e-3);
  ASSERT_TRUE(efficiency);
  EXPECT_NEAR(efficiency->value, 20.0, 1e-9);
  EXPECT_EQ(efficiency->relMse, 1e-3);
}

TEST(Efficiency, TargetBeyondTheCurveTakesTheNearestPoint) {
  std::vector<Point> curve = idealCurve({2.0, 16.0});
  curve.push_back({.samples = 16, .seeds = 1, .cpuSeconds = 40.0, .relMse = -1e-6});
  const auto efficiency = findEfficiency(curve, 1e-3);
  ASSERT_TRUE(efficiency);
  EXPECT_NEAR(efficiency->value, 20.0, 1e-9);
  EXPECT_NEAR(efficiency->relMse, 1.0 / 320.0, 1e-12);
  EXPECT_FALSE(findEfficiency({curve.back()}, 1e-3));
}

/// Runs the program on three scenes, one of which is missing.
class CompleteRun : public ::testing::Test {
protected:
  static int runProgram(const TemporaryFolder& folder) {
    const auto table =
        folder.write("table.txt", std::string("foot oracle") + foot + "knee product" + knee +
                                      "absent product {phantoms}/absent.nrrd\n");
    const std::string command = std::string(FENESTRA_EFFICIENCY_BENCHMARK) +
                                " --budget 0.3 --seeds 2 --noise 0.3 --table " + table.string() +
                                " --phantoms " + samples + " --references " +
                                (folder / "references").string() + " >" +
                                (folder / "curves.csv").string() + " 2>/dev/null";
    return std::system(command.c_str());
  }
};

/// Cells of a line of CSV.
std::vector<std::string> splitCells(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');)
    cells.push_back(cell);
  return cells;
}

TEST_F(CompleteRun, PrintsARowForEverySceneAndMode) {
  const TemporaryFolder folder;
  ASSERT_EQ(runProgram(folder), 0);
  std::ifstream file(folder / "curves.csv");
  std::string line;
  std::getline(file, line);
  const std::size_t columns = splitCells(line).size();
  for (const char* const scene : {"foot", "knee"})
    for (const Mode& mode : modes()) {
      ASSERT_TRUE(std::getline(file, line));
      const std::vector<std::string> cells = splitCells(line);
      ASSERT_EQ(cells.size(), columns) << line;
      EXPECT_EQ(cells[0], scene);
      EXPECT_EQ(cells[1], mode.name);
      EXPECT_EQ(cells[2], cells[0] == "foot" ? "oracle" : "product");
      for (const std::size_t column : {3U, 6U, 7U, 8U})
        EXPECT_TRUE(std::isfinite(std::stod(cells[column]))) << line;
      if (!cells[4].empty()) { // empty without a measurable error
        EXPECT_GT(std::stod(cells[4]) * std::stod(cells[5]), 0.0) << line;
      }
    }
  EXPECT_FALSE(std::getline(file, line)) << line;
  EXPECT_TRUE(std::filesystem::exists(folder / "references" / "foot.exr"));
}

} // namespace
} // namespace fenestra::core::benchmarks
