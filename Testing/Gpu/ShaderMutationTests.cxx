// Mutation testing of the GPU's shader: comparison with the oracle must find each error of
// mutations.json. The twin has them, which is the shader's text compiled as C++; the GPU has the
// twin's bits (GpuBits). One build contains all of them (../Statistical/Mutations). Each is
// switched on for one combination of the matrix after another, until the twin's image differs from
// the oracle's as significantly as the suite requires.

#include "Gpu/GpuTesting.h"
#include "RunSettings.h"
#include "Statistical/Comparison.h"
#include "Statistical/Mutations/Mutant.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <iostream>
#include <list>

namespace fenestra::core::testing {
namespace {

struct ShaderMutation {
  std::string name, why;
};

/// All mutations; without the long version, the first three of the list.
std::list<ShaderMutation> readMutations() {
  constexpr std::size_t shortListSize = 3;
  std::ifstream file(FENESTRA_MUTATION_LIST);
  std::list<ShaderMutation> mutations;
  for (const auto& entry : nlohmann::json::parse(file))
    if (isLongRun() || mutations.size() < shortListSize)
      mutations.push_back({entry.at("name"), entry.at("why")});
  return mutations;
}

bool isSupported(const Combination& c) {
  return makeMatrixScene(c).fenestra.visitView(
      [](const SceneView& view) { return canUseSimd(view); });
}

/// p-value of the twin's image.
double compareTwin(const Combination& c, const OracleRender& reference, std::string_view mutation) {
  MatrixSettings settings;
  settings.renderer = [](const TestScene& scene, const RenderSettings& render) {
    return renderTwin(scene, render).film;
  };
  activeMutation = mutation.empty() ? 0 : mutationKey(mutation);
  const double probability = compareWithOracle(c, settings, reference).probability();
  activeMutation = 0;
  return probability;
}

TEST(ShaderMutations, AreAllFound) {
  constexpr int count = shortCount; // sets the bound for a single combination
  std::list<ShaderMutation> pending = readMutations();
  ASSERT_FALSE(pending.empty());
  for (const Combination& c : makeCombinations(count)) {
    if (pending.empty())
      break;
    if (!isSupported(c))
      continue;
    const OracleRender reference = renderOracle(c, {});
    EXPECT_GT(compareTwin(c, reference, ""), significanceLevel(count))
        << "without a mutation: " << describe(c);
    pending.remove_if([&](const ShaderMutation& mutation) {
      const double probability = compareTwin(c, reference, mutation.name);
      const bool isFound = probability <= significanceLevel(count);
      if (isFound)
        std::cout << mutation.name << ": in " << c.index << ", probability " << probability << '\n';
      return isFound;
    });
  }
  for (const ShaderMutation& mutation : pending)
    ADD_FAILURE() << mutation.name << " was not found: " << mutation.why;
}

} // namespace
} // namespace fenestra::core::testing
