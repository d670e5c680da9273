// Every planted error (Faults/README.md) must be found by the suite of MatrixTests.

#include "Comparison.h"
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
  Transport transport; ///< transport in which it shows
  int foundIn = -1;    ///< first combination in which it shows
  double probability = 1.0;
};

std::vector<Fault> readFaults() {
  std::ifstream file(FENESTRA_FAULTS);
  std::vector<Fault> faults;
  for (const auto& entry : nlohmann::json::parse(file))
    faults.push_back(
        {entry.at("name"), entry.at("why"),
         entry.value("transport", "fast") == "fast" ? Transport::fast : Transport::readable});
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
        "matrix, one combination after the other, until one disagrees with the oracle.\n\n"
        "| planted | found in combination | probability there |\n|---|---|---|\n";
  for (const Fault& fault : faults)
    md << "| **" << fault.name << "**: " << fault.why << " | " << fault.foundIn << " | "
       << fault.probability << " |\n";
}

TEST(PlantedErrors, EveryErrorIsFound) {
  constexpr int count = 240; // combinations in the suite; sets the bound for a single one
  MatrixSettings settings;
  std::vector<Fault> faults = readFaults();
  ASSERT_GE(faults.size(), 12U);
  for (const Combination& c : combinations(count)) {
    if (std::ranges::all_of(faults, [](const Fault& fault) { return fault.foundIn >= 0; }))
      break;
    const Truth truth = renderTruth(c, settings);
    for (const Transport transport : {Transport::fast, Transport::readable}) {
      settings.transport = transport;
      EXPECT_GT(compareWithOracle(c, settings, truth).probability(), leastProbability(count))
          << "without an error planted: " << describe(c);
    }
    for (Fault& fault : faults) {
      if (fault.foundIn >= 0)
        continue;
      const Planting planting(fault.name);
      settings.transport = fault.transport;
      const double probability = compareWithOracle(c, settings, truth).probability();
      if (probability > leastProbability(count))
        continue;
      fault.foundIn = c.index;
      fault.probability = probability;
      std::cout << fault.name << ": in " << c.index << ", probability " << probability << '\n';
    }
  }
  for (const Fault& fault : faults)
    EXPECT_GE(fault.foundIn, 0) << fault.name << " was not found: " << fault.why;
  record(faults);
}

} // namespace
} // namespace fenestra::testing
