// Mutation testing: the suite of MatrixTests must find each error of Mutations/mutations.json. One
// build contains all of them (Mutations/ApplyMutations.cmake). Each is switched on for one
// combination after another, until Fenestra's image differs from the oracle's as significantly
// as the suite requires. An entry's "integrator" is the one in which it shows: "simd" (the
// default), "scalar" or "both". Entries with "shows" affect no mean of these images; they must show
// elsewhere: "estimated error", in the images' standard errors (ErrorRatio.h); "labels", in
// smoothed labels (LabelChecks.h); "request", in which volume a request renders; "margin", in
// voxels that an organ gains (OrganMargin.h).

#include "Comparison.h"
#include "ErrorRatio.h"
#include "LabelChecks.h"
#include "Mutations/Mutant.h"
#include "RunSettings.h"
#include "model/filtering/SmoothingRequest.h"
#include "model/masks/OrganMargin.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <iostream>

namespace fenestra::core::testing {
namespace {

struct Mutation {
  std::string name, why;
  Integrator integrator;    ///< in which it shows
  std::string shows;        ///< where, if not in the matrix
  std::string foundIn = {}; ///< first combination in which it shows, or "the estimated error"
  double probability = 1.0; ///< where it was found, or minimum so far
  std::vector<std::pair<double, Combination>> candidates = {}; ///< probabilities in the matrix

  bool isPending() const { return foundIn.empty() && shows.empty(); }
};

/// Integrators in which an entry of mutations.json shows.
std::vector<Integrator> parseIntegrators(const nlohmann::json& entry) {
  const std::string named = entry.value("integrator", "simd");
  if (named == "both")
    return {Integrator::simd, Integrator::scalar};
  return {named == "simd" ? Integrator::simd : Integrator::scalar};
}

/// FENESTRA_MUTATIONS: comma-separated names; unset: all mutations are tested.
bool isSelected(const std::string& name) {
  const char* const names = std::getenv("FENESTRA_MUTATIONS");
  return !names || (',' + std::string(names) + ',').find(',' + name + ',') != std::string::npos;
}

std::vector<Mutation> readMutations() {
  const char* const list = std::getenv("FENESTRA_MUTATION_LIST");
  std::ifstream file(list ? list : FENESTRA_MUTATION_LIST);
  std::vector<Mutation> mutations;
  for (const auto& entry : nlohmann::json::parse(file))
    if (isSelected(entry.at("name")))
      for (const Integrator integrator : parseIntegrators(entry)) {
        std::string why = entry.at("why");
        why += entry.value("integrator", "") != "both" ? ""
               : integrator == Integrator::simd        ? " (SIMD integrator)"
                                                       : " (scalar integrator)";
        mutations.push_back(
            {entry.at("name"), why, integrator, entry.value("shows", std::string())});
      }
  return mutations;
}

/// Activates one mutation for the object's lifetime.
struct ActiveMutation {
  explicit ActiveMutation(std::string_view name) { activeMutation = mutationKey(name); }
  ~ActiveMutation() { activeMutation = 0; }
};

/// p-value of the standard errors estimated by images of sixteen samples per pixel.
double computeErrorProbability(Integrator integrator) {
  RenderSettings settings;
  settings.samples = 16;
  settings.integrator = integrator;
  const ErrorRatio measured = measureErrorRatio(makeFogScene(), settings, 200);
  return normalTail((measured.ratio - 1.0) / measured.error);
}

/// Tests the mutations that affect no mean.
void testEstimatedErrors(std::vector<Mutation>& mutations, double bound) {
  for (const Integrator integrator : {Integrator::simd, Integrator::scalar})
    EXPECT_GT(computeErrorProbability(integrator), bound) << "without a mutation";
  for (Mutation& mutation : mutations)
    if (mutation.shows == "estimated error") {
      const ActiveMutation active(mutation.name);
      mutation.probability = computeErrorProbability(mutation.integrator);
      std::cout << mutation.name << ": in the estimated error, probability " << mutation.probability
                << '\n';
      if (mutation.probability <= bound)
        mutation.foundIn = mutation.shows;
    }
}

/// True if every purpose gets the volume that it should.
bool areRequestsRight() {
  using Kind = SmoothingRequest::Kind;
  const SmoothingRequest automatic{Kind::automatic}, given{Kind::given, 20.0};
  const SmoothingPurpose measurement, shown{.hasDisplayImage = true}, server{.isServer = true},
      shard{.hasDisplayImage = true, .isShard = true};
  return isSmoothed(automatic, shown) && isSmoothed(automatic, server) &&
         !isSmoothed(automatic, measurement) && !isSmoothed(automatic, shard) &&
         isSmoothed(given, measurement) && !isSmoothed({}, shown);
}

/// True if the margin of a ball that reaches into air contains no voxel outside the ball.
bool doesMarginOnlyRemove() {
  constexpr std::int64_t edge = 44;
  Affine toCenter = Affine::Identity();
  toCenter.translate(Vec3::Constant(-0.5 * (edge - 1)));
  const Grid grid(Size3::Constant(edge), toCenter);
  Mask ball;
  ball.grid = grid;
  LargeArray<std::int16_t> voxels;
  for (std::int64_t i = 0; i < grid.voxelCount(); ++i) {
    const Size3 voxel(i % edge, i / edge % edge, i / (edge * edge));
    const double radius = (grid.indexToWorld * Vec3(voxel.cast<double>())).norm();
    ball.voxels.push_back(radius < 18.0 ? 1 : 0);
    voxels.push_back(static_cast<std::int16_t>(radius < 16.0 ? 60 : -900));
  }
  ball.count = std::ranges::count(ball.voxels, std::uint8_t{1});
  const OrganMargin margin =
      findOrganMargin(ball, {.grid = grid, .voxels = voxels, .name = "", .warnings = {}});
  EXPECT_TRUE(margin.isApplied);
  return std::ranges::equal(margin.kept.voxels, ball.voxels, std::less_equal());
}

/// Tests the mutations that show in a property of a function, which `holds` without them.
void testProperty(std::vector<Mutation>& mutations, const std::string& shows, bool (*holds)()) {
  EXPECT_TRUE(holds()) << shows << ", without a mutation";
  for (Mutation& mutation : mutations)
    if (mutation.shows == shows) {
      const ActiveMutation active(mutation.name);
      mutation.foundIn = holds() ? "" : "the " + shows;
    }
}

/// Compares one combination without a mutation, and with each of `mutations`.
void testCombination(const Combination& c, MatrixSettings settings,
                     std::vector<Mutation*> mutations, double bound, const char* suffix) {
  const OracleRender reference = renderOracle(c, settings);
  for (const Integrator integrator : {Integrator::simd, Integrator::scalar}) {
    settings.integrator = integrator;
    EXPECT_GT(compareWithOracle(c, settings, reference).probability(), bound)
        << "without a mutation: " << describe(c) << suffix;
  }
  for (Mutation* mutation : mutations) {
    const ActiveMutation active(mutation->name);
    settings.integrator = mutation->integrator;
    const double probability = compareWithOracle(c, settings, reference).probability();
    mutation->candidates.emplace_back(probability, c);
    if (probability > bound)
      continue;
    mutation->foundIn = std::to_string(c.index) + suffix;
    mutation->probability = probability;
    std::cout << mutation->name << ": in " << mutation->foundIn << ", probability " << probability
              << '\n';
  }
}

/// Repeats the three most promising combinations of each mutation that was not found, with another
/// seed and sixteen times the samples.
void retest(std::vector<Mutation>& mutations, double bound) {
  constexpr std::size_t maxCombinations = 3;
  MatrixSettings settings;
  settings.samples *= 16;
  settings.seed += 1;
  for (Mutation& mutation : mutations) {
    std::ranges::sort(mutation.candidates, {}, [](const auto& c) { return c.first; });
    const auto candidates = mutation.candidates; // a copy, because testCombination appends
    for (std::size_t i = 0;
         mutation.isPending() && i < std::min(maxCombinations, candidates.size()); ++i)
      testCombination(candidates[i].second, settings, {&mutation}, bound, ", retested");
  }
}

TEST(Mutations, AreAllFound) {
  constexpr int count = shortCount; // sets the bound for a single combination
  std::vector<Mutation> mutations = readMutations();
  ASSERT_FALSE(mutations.empty());
  testEstimatedErrors(mutations, significanceLevel(count));
  testProperty(mutations, "labels", areLabelsValid);
  testProperty(mutations, "request", areRequestsRight);
  testProperty(mutations, "margin", doesMarginOnlyRemove);
  for (const Combination& c : makeCombinations(count)) {
    std::vector<Mutation*> pending;
    for (Mutation& mutation : mutations)
      if (mutation.isPending())
        pending.push_back(&mutation);
    if (pending.empty())
      break;
    testCombination(c, {}, pending, significanceLevel(count), "");
  }
  retest(mutations, significanceLevel(count));
  for (const Mutation& mutation : mutations)
    EXPECT_FALSE(mutation.foundIn.empty()) << mutation.name << " was not found: " << mutation.why;
  std::cout << "mutations found: "
            << std::ranges::count_if(mutations,
                                     [](const Mutation& m) { return !m.foundIn.empty(); })
            << " of " << mutations.size() << '\n';
}

} // namespace
} // namespace fenestra::core::testing
