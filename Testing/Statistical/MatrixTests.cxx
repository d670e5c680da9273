// Compares Fenestra with the oracle in all combinations of the matrix.

#include "Comparison.h"
#include "EstimateImages.h"
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
/// renderer under test's integrator: both integrators are compared with the same render.
const OracleRender& findOracleRender(const Combination& c, const MatrixSettings& settings) {
  static std::map<int, OracleRender> renders;
  const auto found = renders.find(c.index);
  return found != renders.end() ? found->second
                                : renders.emplace(c.index, renderOracle(c, settings)).first->second;
}

class Matrix : public ::testing::TestWithParam<Integrator> {};

TEST_P(Matrix, AgreesWithOracle) {
  const MatrixSettings settings{isLongRun() ? 512U : 128U, seedBase(), GetParam()};
  const std::vector<Combination> all =
      makeCombinations(static_cast<int>(readEnvironmentNumber("FENESTRA_COMBINATIONS")
                                            .value_or(isLongRun() ? longCount : shortCount)));
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

INSTANTIATE_TEST_SUITE_P(Integrators, Matrix,
                         ::testing::Values(Integrator::simd, Integrator::scalar),
                         [](const auto& info) {
                           return info.param == Integrator::simd ? "simd" : "scalar";
                         });

} // namespace
} // namespace fenestra::core::testing
