// Table of a batch, or a manifest; the first byte selects which.
#include "Harness.h"

#include "program/BatchTable.h"
#include "program/Manifest.h"

#include <set>

FENESTRA_FUZZ(Batch, input) {
  using namespace fenestra::core;
  const std::string name = fuzzing::chooseName(input, std::array{"t.csv", "record.json"});
  const std::filesystem::path path = fuzzing::writeInput(input, name);
  if (name == "t.csv") {
    std::set<std::string> names;
    for (const BatchRow& row : readBatchTable(path, OptionValues(batchSyntax().options)))
      if (row.name.find('/') != row.name.npos || row.input.empty() ||
          !names.insert(row.name).second)
        throw std::logic_error("a row has no input, or no unique folder");
    return;
  }
  Manifest manifest(path, "row", {"--seed=7"});
  manifest.readRequest(4);
  manifest.addInputs(manifest.recordedInputs());
  manifest.findDifference();
  manifest.readItems(
      3, [&path](int) { return std::vector{path}; },
      [](const JsonNode&) { return nlohmann::json(); });
}
