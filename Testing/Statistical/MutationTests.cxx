// Every planted error (Faults/README.md) must be found by the suite of MatrixTests.

#include "Comparison.h"
#include "ErrorRatio.h"
#include "Faults/Planted.h"
#include "RunSettings.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <iostream>

namespace fenestra::testing {
namespace {

struct Fault {
  std::string name, why;
  Integrator transport;     ///< transport in which it shows
  bool inToldError;         ///< shows in the error that pictures tell, in place of the matrix
  std::string foundIn = {}; ///< first combination in which it shows, or the told error
  double probability = 1.0; ///< where it was found, or least so far
  std::vector<std::pair<double, Combination>> hints = {}; ///< probabilities of the matrix

  bool isLookedFor() const { return foundIn.empty() && !inToldError; }
};

/// Transports in which an entry of faults.json shows; without a word, the fast one.
std::vector<Integrator> transportsOf(const nlohmann::json& entry) {
  const std::string named = entry.value("transport", "fast");
  if (named == "both")
    return {Integrator::simd, Integrator::scalar};
  return {named == "fast" ? Integrator::simd : Integrator::scalar};
}

/// FENESTRA_PLANTED, names between commas; unset: all errors are looked for.
bool isWanted(const std::string& name) {
  const char* const wanted = std::getenv("FENESTRA_PLANTED");
  return !wanted || (',' + std::string(wanted) + ',').find(',' + name + ',') != std::string::npos;
}

std::vector<Fault> readFaults() {
  std::ifstream file(FENESTRA_FAULTS);
  std::vector<Fault> faults;
  for (const auto& entry : nlohmann::json::parse(file))
    if (isWanted(entry.at("name")))
      for (const Integrator transport : transportsOf(entry)) {
        std::string why = entry.at("why");
        why += entry.value("transport", "") != "both" ? ""
               : transport == Integrator::simd        ? " (fast transport)"
                                                      : " (readable transport)";
        faults.push_back(
            {entry.at("name"), why, transport, entry.value("shows", "") == "told error"});
      }
  return faults;
}

/// Switches one error on for the object's lifetime.
struct Planting {
  explicit Planting(std::string_view name) { plantedFault = faultKey(name); }
  ~Planting() { plantedFault = 0; }
};

void record(const std::vector<Fault>& faults) {
  const std::optional<std::filesystem::path> folder = reportFolder();
  if (!folder)
    return;
  std::ofstream md(*folder / "faults.md");
  md << "# Planted errors\n\nEach is planted in a copy of the renderer and looked for in the "
        "matrix, one combination after the other, until one disagrees with the oracle; errors that "
        "show in no mean are looked for in the standard errors that pictures tell.\n\n"
        "| planted | found in combination | probability there |\n|---|---|---|\n";
  for (const Fault& fault : faults)
    md << "| **" << fault.name << "**: " << fault.why << " | " << fault.foundIn << " | "
       << fault.probability << " |\n";
}

/// Probability of what pictures of sixteen samples tell of their error, if it is right.
double toldErrorProbability(Integrator transport) {
  RenderSettings settings;
  settings.samples = 16;
  settings.integrator = transport;
  const ErrorRatio told = measureErrorRatio(makeFogScene(), settings, 200);
  return normalTail((told.ratio - 1.0) / told.error);
}

/// Looks for the errors that show in no mean.
void findInToldErrors(std::vector<Fault>& faults, double bound) {
  for (const Integrator transport : {Integrator::simd, Integrator::scalar})
    EXPECT_GT(toldErrorProbability(transport), bound) << "without an error planted";
  for (Fault& fault : faults)
    if (fault.inToldError) {
      const Planting planting(fault.name);
      fault.probability = toldErrorProbability(fault.transport);
      std::cout << fault.name << ": in the told error, probability " << fault.probability << '\n';
      if (fault.probability <= bound)
        fault.foundIn = "the told error";
    }
}

/// Compares one combination without an error, and with each that is still looked for.
void lookIn(const Combination& c, MatrixSettings settings, std::vector<Fault*> faults, double bound,
            const char* how) {
  const OracleRender truth = renderOracle(c, settings);
  for (const Integrator transport : {Integrator::simd, Integrator::scalar}) {
    settings.integrator = transport;
    EXPECT_GT(compareWithOracle(c, settings, truth).probability(), bound)
        << "without an error planted: " << describe(c) << how;
  }
  for (Fault* fault : faults) {
    const Planting planting(fault->name);
    settings.integrator = fault->transport;
    const double probability = compareWithOracle(c, settings, truth).probability();
    fault->hints.emplace_back(probability, c);
    if (probability > bound)
      continue;
    fault->foundIn = std::to_string(c.index) + how;
    fault->probability = probability;
    std::cout << fault->name << ": in " << fault->foundIn << ", probability " << probability
              << '\n';
  }
}

/// Looks again where an error that was not found seemed most likely: other random numbers, and
/// sixteen times as many.
void lookAgain(std::vector<Fault>& faults, double bound) {
  constexpr std::size_t places = 3;
  MatrixSettings settings;
  settings.samples *= 16;
  settings.seed += 1;
  for (Fault& fault : faults) {
    std::ranges::sort(fault.hints, {}, [](const auto& hint) { return hint.first; });
    const auto hints = fault.hints; // which lookIn adds to
    for (std::size_t i = 0; fault.isLookedFor() && i < std::min(places, hints.size()); ++i)
      lookIn(hints[i].second, settings, {&fault}, bound, ", looked at again");
  }
}

TEST(PlantedErrors, EveryErrorIsFound) {
  constexpr int count = shortCount; // sets the bound for a single combination
  std::vector<Fault> faults = readFaults();
  ASSERT_FALSE(faults.empty());
  findInToldErrors(faults, significanceLevel(count));
  for (const Combination& c : makeCombinations(count)) {
    std::vector<Fault*> lookedFor;
    for (Fault& fault : faults)
      if (fault.isLookedFor())
        lookedFor.push_back(&fault);
    if (lookedFor.empty())
      break;
    lookIn(c, {}, lookedFor, significanceLevel(count), "");
  }
  lookAgain(faults, significanceLevel(count));
  for (const Fault& fault : faults)
    EXPECT_FALSE(fault.foundIn.empty()) << fault.name << " was not found: " << fault.why;
  std::cout << "planted errors found: "
            << std::ranges::count_if(faults, [](const Fault& f) { return !f.foundIn.empty(); })
            << " of " << faults.size() << '\n';
  record(faults);
}

} // namespace
} // namespace fenestra::testing
