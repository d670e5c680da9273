#include "program/about/About.h"

#include "base/InstructionSets.h"
#include "files/slicer/SlicerPresets.h"
#include "io/JsonNode.h"
#include "program/about/Commit.h"
#include "program/about/Version.h"

namespace fenestra::core {
namespace {

nlohmann::ordered_json collectFacts() {
  nlohmann::ordered_json all = {
      {"name", "fenestra"},
      {"version", versionText},
      {"commit", commitText},
      {"date", commitDate},
      {"license", "Apache-2.0"},
      {"system", systemText},
      {"compiler", compilerText},
      {"instructions", instructionSet()},
      {"instructionSets", instructionSets()},
      {"data", nullptr}, // compiled in
      {"slicerPresets", nullptr},
  };
  if (const auto presets = findSlicerPresets())
    all["slicerPresets"] = presets->string();
  for (const auto& [name, version] : libraryVersions())
    all["libraries"][name] = version;
  return all;
}

} // namespace

std::string aboutText() {
  const nlohmann::ordered_json all = collectFacts();
  const auto fact = [&all](const char* key) { return all[key].get<std::string>(); };
  const auto library = [](const auto& named) { return named.first + " " + named.second; };
  return concat("fenestra ", versionText,                                //
                "\ncommit: ", fact("commit"), ", ", fact("date"),        //
                "\nbuild: ", fact("compiler"), ", ", fact("system"),     //
                "\ninstruction set: ", fact("instructions"),             //
                "\nlibraries: ", join(libraryVersions(), ", ", library), //
                "\nlicense: ", fact("license"), "\n");
}

std::string aboutJson() {
  return dumpJson(collectFacts());
}

} // namespace fenestra::core
