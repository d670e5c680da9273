// Checks by Slicer's ExtensionsIndex (scripts/check_description_files.py), most of which read the
// top-level CMakeLists.txt as text, and names of the extension's modules.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

namespace {

const std::filesystem::path project = FENESTRA_PROJECT;

std::string readText(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(project / file, std::ios::binary).rdbuf();
  return text.str();
}

/// First group of a pattern's first match; empty: no match.
std::string findMatch(const std::string& text, const std::string& pattern) {
  std::smatch match;
  return std::regex_search(text, match, std::regex(pattern, std::regex::icase)) ? match[1].str()
                                                                                : std::string();
}

/// Value of `set(NAME "value")`.
std::string setting(const std::string& name) {
  return findMatch(readText("CMakeLists.txt"), "set\\s*\\(" + name + "\\s*\"([^\"]+)\"\\s*\\)");
}

TEST(Extension, TopLevelListFileSetsWhatTheIndexReads) {
  const std::string list = readText("CMakeLists.txt");
  EXPECT_EQ(findMatch(list, R"(project\s*\(\s*([^\s\)]+))"), "Fenestra");
  for (const char* name : {"EXTENSION_HOMEPAGE", "EXTENSION_CONTRIBUTORS", "EXTENSION_DESCRIPTION",
                           "EXTENSION_ICONURL", "EXTENSION_SCREENSHOTURLS", "EXTENSION_CATEGORY"})
    EXPECT_NE(setting(name), "") << name;
  for (const char* name : {"EXTENSION_ICONURL", "EXTENSION_SCREENSHOTURLS"}) {
    // A file of this repository as raw.githubusercontent.com serves it.
    const std::string path = findMatch(
        setting(name), "^https://raw\\.githubusercontent\\.com/[^/]+/[^/]+/main/(.+\\.(png|jpg))$");
    EXPECT_TRUE(!path.empty() && std::filesystem::is_regular_file(project / path)) << name;
  }
  EXPECT_EQ(list.find('\r'), std::string::npos);
}

TEST(Extension, DescriptionNamesRepositoryAndCategory) {
  const std::string entry = readText("SlicerModule/Fenestra.json");
  const std::string url = findMatch(entry, "\"scm_url\"\\s*:\\s*\"([^\"]+)\"");
  EXPECT_TRUE(std::regex_match(url, std::regex("https://[^/]+/[^/]+/Slicer\\w+\\.git"))) << url;
  EXPECT_EQ(findMatch(entry, "\"category\"\\s*:\\s*\"([^\"]+)\""), setting("EXTENSION_CATEGORY"));
  EXPECT_EQ(setting("EXTENSION_CATEGORY"), "Rendering"); // from the index's list
  EXPECT_NE(readText("LICENSE"), "");
  EXPECT_EQ(setting("EXTENSION_HOMEPAGE").rfind(url.substr(0, url.size() - 4), 0), 0u);
}

/// Slicer makes each module an attribute of slicer.modules, in lower case; a second module of the
/// same name would replace the first.
TEST(Extension, NamesOfModulesDifferInLowerCase) {
  const std::string loadable =
      findMatch(readText("SlicerModule/Extension.cmake"), "set\\(MODULE_NAME (\\w+)\\)");
  const std::string command =
      findMatch(readText("SlicerModule/Extension.cmake"), "set\\(COMMAND_MODULE_NAME (\\w+)\\)");
  const std::string tour = findMatch(readText("SlicerModule/Testing/Tour/CMakeLists.txt"),
                                     "set\\(MODULE_NAME (\\w+)\\)");
  std::set<std::string> names;
  for (std::string name : {loadable, command, tour}) {
    EXPECT_NE(name, "");
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    EXPECT_TRUE(names.insert(name).second) << name;
  }
}

} // namespace
