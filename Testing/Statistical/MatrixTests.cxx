// Product against oracle over the whole matrix.

#include "Comparison.h"
#include "MatrixRecord.h"
#include "Pictures.h"
#include "RunSettings.h"

#include "WriteResults.h"
#include "image/Compare.h"

#include <gtest/gtest.h>

#include <iostream>
#include <map>

namespace fenestra::testing {
namespace {

/// Writes the pictures needed to see an error; returns a text that names their folder.
std::string errorImages(const Outcome& c) {
  const std::filesystem::path folder =
      std::filesystem::path(FENESTRA_MATRIX_RESULTS) / std::to_string(c.combination.index);
  std::filesystem::create_directories(folder);
  const Image product = imageOf(c.product), truth = imageOf(c.truth);
  writeImage(product, {}, folder / "product.exr");
  writeImage(truth, {}, folder / "oracle.exr");
  writeImage(differenceImage(product, truth), {}, folder / "z.png", {DisplayView::standard});
  return "see product.exr, oracle.exr and z.png in " + folder.string();
}

/// Oracle's picture of a combination, rendered at the first call. Its seed does not depend on the
/// product's transport: both transports are compared with the same picture.
const Truth& truthOf(const Combination& c, const MatrixSettings& settings) {
  static std::map<int, Truth> truths;
  const auto found = truths.find(c.index);
  return found != truths.end() ? found->second
                               : truths.emplace(c.index, renderTruth(c, settings)).first->second;
}

class Matrix : public ::testing::TestWithParam<Integrator> {};

TEST_P(Matrix, AgreesWithTheOracle) {
  const MatrixSettings settings{isLongRun() ? 512U : 128U, seedBase(), GetParam()};
  const std::vector<Combination> all =
      combinations(static_cast<int>(readEnvironmentNumber("FENESTRA_COMBINATIONS")
                                        .value_or(isLongRun() ? longCount : shortCount)));
  std::vector<Outcome> outcomes;
  for (const Combination& c : all) {
    outcomes.push_back(compareWithOracle(c, settings, truthOf(c, settings)));
    const Outcome& result = outcomes.back();
    EXPECT_GT(result.probability(), leastProbability(all.size()))
        << c.index << ": " << describe(c) << "\n  pixels " << result.pixels << ", tiles "
        << result.tiles << ", picture " << result.picture << " (" << 100.0 * result.difference
        << " %)\n  " << errorImages(result);
    EXPECT_LT(result.depthDifference, 1e-3) << describe(c);
    EXPECT_EQ(result.depthDisagreements, 0) << describe(c);
  }
  const std::vector<Verdict> results = verdicts(outcomes);
  for (const Verdict& verdict : results) {
    std::cout << verdict.name << ": probability " << verdict.probability << " (" << verdict.count
              << ")\n";
    EXPECT_GT(test.probability, leastProbability(results.size())) << verdict.name;
  }
  if (GetParam() == Integrator::simd)
    recordMatrix(outcomes, results, settings);
}

INSTANTIATE_TEST_SUITE_P(Transports, Matrix,
                         ::testing::Values(Integrator::simd, Integrator::scalar),
                         [](const auto& info) {
                           return info.param == Integrator::simd ? "fast" : "readable";
                         });

} // namespace
} // namespace fenestra::testing
