#include "Scenes.h"

#include "base/Error.h"
#include "program/CommandLine.h"
#include "program/UsageError.h"

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

namespace fenestra::core::benchmarks {
namespace {

using Arguments = std::vector<std::string>;

/// Arguments from a file with one per line. Files in its folder are replaced by their full path.
Arguments readArguments(const std::filesystem::path& path) {
  Arguments words;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);)
    if (!line.empty()) {
      const std::filesystem::path beside = path.parent_path() / line;
      words.push_back(std::filesystem::is_regular_file(beside) ? beside.string() : line);
    }
  return words;
}

class Table {
public:
  Table(std::filesystem::path path, const Folders& folders)
      : m_path(std::move(path)),
        m_folders{{"{reference}", folders.reference},
                  {"{data}", folders.data},
                  {"{phantoms}", folders.phantoms}} {}

  std::vector<SceneCase> read() {
    std::vector<SceneCase> scenes;
    std::ifstream file(m_path);
    for (std::string line; std::getline(file, line);) {
      if (line.empty() || line[0] == '#')
        continue;
      const Arguments words = split(line);
      if (words.size() < 3)
        throw inputError(m_path.string(), "'" + line + "': expected NAME REFERENCE ARGUMENTS");
      if (words[1] == "=")
        m_names[words[0]] = {words.begin() + 2, words.end()};
      else
        scenes.push_back(parseScene(words));
    }
    if (scenes.empty())
      throw inputError(m_path.string(), "has no scenes; expected lines NAME REFERENCE ARGUMENTS");
    return scenes;
  }

private:
  /// Splits a line into words, and replaces each "@name" by its definition.
  Arguments split(const std::string& line) const {
    Arguments words;
    std::istringstream stream(line);
    for (std::string word; stream >> word;) {
      const auto name = m_names.find(word);
      if (name == m_names.end())
        words.push_back(word);
      else
        words.insert(words.end(), name->second.begin(), name->second.end());
    }
    return words;
  }

  ReferenceSource parseSource(const std::string& word) const {
    const std::map<std::string, ReferenceSource> sources = {
        {"independent", ReferenceSource::external},
        {"oracle", ReferenceSource::oracle},
        {"product", ReferenceSource::fenestra}};
    const auto found = sources.find(word);
    if (found == sources.end())
      throw inputError(m_path.string(),
                       "'" + word + "': expected REFERENCE independent, oracle or product");
    return found->second;
  }

  SceneCase parseScene(const Arguments& words) const {
    SceneCase scene;
    scene.name = words[0];
    scene.source = parseSource(words[1]);
    for (std::size_t i = 2; i < words.size(); ++i) {
      const std::string word = resolvePath(words[i], scene);
      const std::filesystem::path path = word;
      if (path.extension() != ".arguments") {
        scene.arguments.push_back(word);
        continue;
      }
      const Arguments read = readArguments(path);
      scene.arguments.insert(scene.arguments.end(), read.begin(), read.end());
      scene.external = std::filesystem::path(path).replace_extension();
    }
    return scene;
  }

  /// Replaces a folder's name by its path. Sets scene.missing if the file does not exist.
  std::string resolvePath(const std::string& word, SceneCase& scene) const {
    for (const auto& [name, folder] : m_folders)
      if (word.starts_with(name)) {
        const std::string path = folder.string() + word.substr(name.size());
        if (scene.missing.empty() && !std::filesystem::exists(path))
          scene.missing = word;
        return path;
      }
    return word;
  }

  std::filesystem::path m_path;
  std::map<std::string, std::filesystem::path> m_folders;
  std::map<std::string, Arguments> m_names;
};

} // namespace

Folders findFolders(const std::optional<std::string>& phantoms) {
  const auto find = [](const char* variable, const char* built) {
    const char* const set = std::getenv(variable);
    return std::filesystem::path(set ? set : built);
  };
  return {find("FENESTRA_REFERENCE", FENESTRA_REFERENCE), find("FENESTRA_DATA", FENESTRA_DATA),
          phantoms.value_or(FENESTRA_BENCHMARK_FOLDER)};
}

RenderOptions parseRenderOptions(const std::vector<std::string>& arguments) {
  Arguments words = {"fenestra"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words)
    argv.push_back(word.data());
  const auto values = parseCommandLine(renderSyntax, static_cast<int>(argv.size()), argv.data(), 1);
  if (!values)
    throw usageError("--help: renders nothing; omit it");
  return makeRenderOptions(*values);
}

std::vector<SceneCase> readScenes(const std::filesystem::path& table, const Folders& folders) {
  return Table(table, folders).read();
}

} // namespace fenestra::core::benchmarks
