// `--version` and `fenestra describe`: version, libraries and manual page. completions.sh tests the
// completions in the shells themselves.

#include "CommandTesting.h"
#include "base/Text.h"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <regex>

namespace fenestra::core::DescribeCommandTests {
namespace {

using Json = nlohmann::ordered_json;

const std::set<std::string> libraries = {
    "Eigen",   "FreeType",      "GDCM",   "HDF5",        "Highway", "ITK",
    "OpenEXR", "glibc",         "libpng", "libtiff",     "libzip",  "oneTBB",
    "pugixml", "nlohmann-json", "zlib",   "OpenColorIO", "volk"};

class VersionCommand : public ::testing::Test {
protected:
  Json readVersion() const {
    const Outcome outcome = run({"--version", "--json"}, folder.path());
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    return Json::parse(outcome.out);
  }

  TemporaryFolder folder;
};

TEST_F(VersionCommand, JsonHasTheDocumentedKeysAndForms) {
  const Json all = readVersion();
  std::vector<std::string> keys;
  for (const auto& [key, value] : all.items())
    keys.push_back(key);
  EXPECT_EQ(keys, (std::vector<std::string>{"name", "version", "commit", "date", "license",
                                            "system", "compiler", "instructions", "instructionSets",
                                            "data", "slicerPresets", "libraries"}));
  EXPECT_EQ(all["name"], "fenestra");
  EXPECT_EQ(all["license"], "Apache-2.0");
  EXPECT_TRUE(all["data"].is_null());
  for (const auto& [key, form] : std::initializer_list<std::pair<const char*, const char*>>{
           {"version", "[0-9]+\\.[0-9]+\\.[0-9]+"},
           {"commit", "unknown|[0-9a-f]{40}(-dirty)?"},
           {"date", "20[0-9]{2}-[01][0-9]-[0-3][0-9]"},
           {"system", "[A-Za-z]+ [a-z0-9_]+"},
           {"compiler", "[A-Za-z]+ [0-9]+(\\.[0-9]+)+"}})
    EXPECT_TRUE(std::regex_match(all[key].get<std::string>(), std::regex(form))) << all[key];
}

TEST_F(VersionCommand, JsonHasAVersionOfEachLibrary) {
  std::set<std::string> names;
  const Json all = readVersion();
  for (const auto& [name, version] : all["libraries"].items()) {
    names.insert(name);
    EXPECT_TRUE(std::regex_match(version.get<std::string>(), std::regex("[0-9]+(\\.[0-9]+)+.*")))
        << name << version;
  }
  EXPECT_EQ(names, libraries);
}

TEST_F(VersionCommand, InstructionSetIsThatOfARender) {
  const std::vector<std::string> sets = readVersion()["instructionSets"];
  const char* const pinned = std::getenv("FENESTRA_INSTRUCTIONS");
  EXPECT_EQ(readVersion()["instructions"], pinned ? pinned : sets.front());
  const std::string before = pinned ? pinned : "";
  ::setenv("FENESTRA_INSTRUCTIONS", sets.back().c_str(), 1);
  EXPECT_EQ(readVersion()["instructions"], sets.back());
  ::setenv("FENESTRA_INSTRUCTIONS", "ABACUS", 1);
  expectErrors({{"unknown set", {"--version"}, 2, "FENESTRA_INSTRUCTIONS: | ABACUS"}},
               folder.path());
  pinned ? ::setenv("FENESTRA_INSTRUCTIONS", before.c_str(), 1)
         : ::unsetenv("FENESTRA_INSTRUCTIONS");
}

TEST_F(VersionCommand, TextHasTheFactsOfTheJson) {
  const Json all = readVersion();
  const std::string text = run({"--version"}, folder.path()).out;
  EXPECT_TRUE(text.starts_with("fenestra " + all["version"].get<std::string>() + "\n")) << text;
  for (const char* key : {"commit", "date", "compiler", "system", "instructions", "license"})
    EXPECT_NE(text.find(all[key].get<std::string>()), std::string::npos) << key << text;
  for (const auto& [name, version] : all["libraries"].items())
    EXPECT_NE(text.find(name + " " + version.get<std::string>()), std::string::npos) << text;
}

class DescribeCommand : public VersionCommand {};

TEST_F(DescribeCommand, ManualPageHasAllSectionsAndOptions) {
  const Outcome outcome = run({"describe", "man"}, folder.path());
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "");
  std::size_t place = 0;
  for (const char* section : {"NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "ENVIRONMENT",
                              "EXIT STATUS", "EXAMPLES", "SEE ALSO"}) {
    const std::size_t found = outcome.out.find(std::string("\n.Sh ") + section + "\n");
    EXPECT_TRUE(found != std::string::npos && found >= place) << section;
    place = found;
  }
  for (const char* command :
       {"render", "inspect", "turntable", "serve", "compare", "phantom", "describe"}) {
    EXPECT_NE(outcome.out.find(std::string("\n.It Nm Cm ") + command + " Ar "), std::string::npos);
    const std::string help = run({command, "--help"}, folder.path()).out;
    static const std::regex option("\n  (?:-([a-z]), |    )--([a-z-]+)");
    for (std::sregex_iterator it(help.begin(), help.end(), option), end; it != end; ++it) {
      const std::string letter = it->str(1).empty() ? "" : "Fl " + it->str(1) + " , ";
      EXPECT_TRUE(std::regex_search(
          outcome.out, std::regex("\n.It " + letter + "Fl Fl " + it->str(2) + "[ \n]")))
          << command << " " << it->str(2);
    }
  }
}

TEST_F(DescribeCommand, HelpOmitsUnsupportedOptions) {
  using Pair = std::pair<const char*, const char*>;
  for (const auto& [command, option] :
       {Pair("serve", "--stats-json"), Pair("serve", "--checkpoint"),
        Pair("turntable", "--surface"), Pair("turntable", "--checkpoint")}) {
    expectErrors(
        {{option, {command, "volume.nrrd", option, "a.json"}, 2, std::string(option) + ":"}},
        folder.path());
    EXPECT_EQ(run({command, "--help"}, folder.path()).out.find(concat("\n      ", option, " ")),
              std::string::npos);
  }
  EXPECT_NE(run({"render", "--help"}, folder.path()).out.find("\n      --checkpoint "),
            std::string::npos);
}

TEST_F(DescribeCommand, UnknownKindIsRejected) {
  expectErrors({{"shell", {"describe", "csh"}, 2, "KIND:"},
                {"none", {"describe"}, 2, "KIND:"},
                {"two", {"describe", "man", "bash"}, 2, "'bash':"}},
               folder.path());
}

} // namespace
} // namespace fenestra::core::DescribeCommandTests
