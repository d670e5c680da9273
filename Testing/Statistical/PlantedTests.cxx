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
  Transport transport;      ///< transport in which it shows
  bool inToldError;         ///< shows in the error that pictures tell, in place of the matrix
  std::string foundIn = {}; ///< first combination in which it shows, or the told error
  double probability = 1.0;
};

std::vector<Fault> readFaults() {
  std::ifstream file(FENESTRA_FAULTS);
  std::vector<Fault> faults;
  for (const auto& entry : nlohmann::json::parse(file))
    faults.push_back(
        {entry.at("name"), entry.at("why"),
         entry.value("transport", "fast") == "fast" ? Transport::fast : Transport::readable,
         entry.value("shows", "") == "told error"});
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
double toldErrorProbability(Transport transport) {
  RenderSettings settings;
  settings.samples = 16;
  settings.transport = transport;
  const ErrorRatio told = errorRatio(fogScene(), settings, 200);
  return normalTail((told.ratio - 1.0) / told.error);
}

/// Looks for the errors that show in no mean.
void findInToldErrors(std::vector<Fault>& faults, double bound) {
  for (const Transport transport : {Transport::fast, Transport::readable})
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

TEST(PlantedErrors, EveryErrorIsFound) {
  constexpr int count = 240; // combinations in the suite; sets the bound for a single one
  MatrixSettings settings;
  std::vector<Fault> faults = readFaults();
  ASSERT_GE(faults.size(), 12U);
  findInToldErrors(faults, leastProbability(count));
  for (const Combination& c : combinations(count)) {
    if (std::ranges::all_of(faults,
                            [](const Fault& f) { return f.inToldError || !f.foundIn.empty(); }))
      break;
    const Truth truth = renderTruth(c, settings);
    for (const Transport transport : {Transport::fast, Transport::readable}) {
      settings.transport = transport;
      EXPECT_GT(compareWithOracle(c, settings, truth).probability(), leastProbability(count))
          << "without an error planted: " << describe(c);
    }
    for (Fault& fault : faults) {
      if (!fault.foundIn.empty() || fault.inToldError)
        continue;
      const Planting planting(fault.name);
      settings.transport = fault.transport;
      const double probability = compareWithOracle(c, settings, truth).probability();
      if (probability > leastProbability(count))
        continue;
      fault.foundIn = std::to_string(c.index);
      fault.probability = probability;
      std::cout << fault.name << ": in " << c.index << ", probability " << probability << '\n';
    }
  }
  for (const Fault& fault : faults)
    EXPECT_FALSE(fault.foundIn.empty()) << fault.name << " was not found: " << fault.why;
  record(faults);
}

} // namespace
} // namespace fenestra::testing
