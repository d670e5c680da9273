// Compares Fenestra with the oracle in all combinations of the matrix.

#include "Comparison.h"
#include "EstimateImages.h"
#include "Gpu/DeviceTesting.h"
#include "RunSettings.h"

#include "WriteResults.h"
#include "image/Compare.h"

#include <gtest/gtest.h>

#include <iostream>
#include <map>

namespace fenestra::core::testing {
namespace {

/// Writes the images that show an error; returns a message that names their folder.
std::string writeErrorImages(const Outcome& c) {
  const std::filesystem::path folder =
      std::filesystem::path(FENESTRA_MATRIX_RESULTS) / std::to_string(c.combination.index);
  std::filesystem::create_directories(folder);
  const Image fenestra = toImage(c.fenestra), reference = toImage(c.reference);
  writeImage(fenestra, {}, folder / "fenestra.exr");
  writeImage(reference, {}, folder / "oracle.exr");
  writeImage(differenceImage(fenestra, reference), {}, folder / "z.png", {DisplayView::standard});
  return "see fenestra.exr, oracle.exr and z.png in " + folder.string();
}

/// Oracle's render of a combination, computed at the first call. Its seed does not depend on the
/// renderer under test's integrator: all integrators are compared with the same render.
const OracleRender& findOracleRender(const Combination& c, const MatrixSettings& settings) {
  static std::map<std::string, OracleRender> renders;
  const std::string key =
      std::to_string(settings.samples) + ' ' + std::to_string(c.index) + ' ' + describe(c);
  const auto found = renders.find(key);
  return found != renders.end() ? found->second
                                : renders.emplace(key, renderOracle(c, settings)).first->second;
}

void testCombinations(const std::vector<Combination>& all, const MatrixSettings& settings) {
  std::vector<Outcome> outcomes;
  for (const Combination& c : all) {
    outcomes.push_back(compareWithOracle(c, settings, findOracleRender(c, settings)));
    const Outcome& result = outcomes.back();
    EXPECT_GT(result.probability(), significanceLevel(all.size()))
        << c.index << ": " << describe(c) << "\n  pixels " << result.pixels << ", tiles "
        << result.tiles << ", image " << result.image << " (" << 100.0 * result.difference
        << " %)\n  " << writeErrorImages(result);
    EXPECT_LT(result.depthDifference, 1e-3) << describe(c);
    EXPECT_EQ(result.depthDisagreements, 0) << describe(c);
  }
  const std::vector<HypothesisTest> results = testHypotheses(outcomes);
  for (const HypothesisTest& test : results) {
    std::cout << test.name << ": probability " << test.probability << " (" << test.count << ")\n";
    EXPECT_GT(test.probability, significanceLevel(results.size())) << test.name;
  }
  std::cout << "combinations: " << all.size() << ", samples per pixel: " << settings.samples
            << ", bound: " << significanceLevel(results.size()) << '\n';
}

class Matrix : public ::testing::TestWithParam<Integrator> {};

TEST_P(Matrix, AgreesWithOracle) {
  const int count = static_cast<int>(readEnvironmentNumber("FENESTRA_COMBINATIONS")
                                         .value_or(isLongRun() ? longCount : shortCount));
  testCombinations(makeCombinations(count), {isLongRun() ? 512U : 128U, seedBase(), GetParam()});
}

INSTANTIATE_TEST_SUITE_P(Integrators, Matrix,
                         ::testing::Values(Integrator::simd, Integrator::scalar),
                         [](const auto& info) {
                           return info.param == Integrator::simd ? "simd" : "scalar";
                         });

/// `c` with the factors of `like` that are constants of the shader, so that both have the same
/// pipeline: compiling one takes as long as many paths.
Combination shareConstants(const Combination& c, const Combination& like) {
  Combination shared = like;
  shared.index = c.index;
  shared.view = c.view;
  shared.g = std::min(c.g, 0.9); // see makeCombination
  shared.albedo = c.albedo;
  if (c.transfer < TransferFactor::gradientOpacity)
    shared.transfer = c.transfer;
  shared.grid = c.grid;
  shared.background = c.background;
  shared.bounces = c.bounces;
  shared.offset = c.offset;
  shared.segments = c.segments;
  shared.hasSoftSegments = c.hasSoftSegments;
  return shared;
}

/// The first combinations that the device renders; `perPipeline` successive ones share constants.
std::vector<Combination> findGpuCombinations(std::size_t count, std::size_t perPipeline) {
  const std::vector<Combination> all = makeCombinations(longCount);
  std::vector<Combination> found;
  for (std::size_t i = 0; i < all.size() && found.size() < count; ++i) {
    const Combination c = shareConstants(all[i], all[i - i % perPipeline + perPipeline - 1]);
    const MatrixScene scene = makeMatrixScene(c);
    const std::optional<std::string> obstacle =
        scene.fenestra.visitView([&](const SceneView& view) { return findGpuObstacle(view); });
    if (obstacle)
      std::cout << "not on the GPU: " << c.index << ", " << *obstacle << '\n';
    else
      found.push_back(c);
  }
  return found;
}

TEST(GpuMatrix, AgreesWithOracle) {
  if (const std::string obstacle = findDeviceObstacle(); !obstacle.empty())
    GTEST_SKIP() << obstacle;
  const std::size_t count = isLongRun() ? 120 : 30;
  const std::vector<Combination> all = findGpuCombinations(count, isLongRun() ? 1 : 10);
  ASSERT_EQ(all.size(), count);
  testCombinations(all, {isLongRun() ? 512U : 64U, seedBase(), Integrator::gpu});
}

} // namespace
} // namespace fenestra::core::testing
