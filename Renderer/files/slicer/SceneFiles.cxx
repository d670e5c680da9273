#include "files/slicer/SceneFiles.h"

#include "base/safe/Inputs.h"
#include "base/safe/JsonNode.h"
#include "base/safe/ShownText.h"
#include "base/safe/SystemCalls.h"
#include "files/medical/NamedFiles.h"
#include "files/slicer/SceneArchive.h"

#include <algorithm>
#include <climits>
#include <string_view>

namespace fenestra {
namespace {

constexpr std::uint64_t largestScene = std::uint64_t{64} << 20; ///< bytes of a .mrml

std::ptrdiff_t depth(const std::filesystem::path& file) {
  return std::distance(file.begin(), file.end());
}

/// True for names beyond Linux's limits, which an archive may hold.
bool isTooLong(const std::filesystem::path& path) {
  return path.native().size() >= PATH_MAX ||
         std::any_of(path.begin(), path.end(),
                     [](const auto& part) { return part.native().size() > NAME_MAX; });
}

/// Scene closest to the root, as in Slicer: deeper ones belong to sequences.
std::filesystem::path mainScene(const SceneArchive& archive, const std::filesystem::path& path) {
  std::vector<std::filesystem::path> closest;
  for (const auto& [file, entry] : archive.files()) {
    if (lowerExtension(file) != ".mrml")
      continue;
    if (!closest.empty() && depth(file) < depth(closest.front()))
      closest.clear();
    if (closest.empty() || depth(file) == depth(closest.front()))
      closest.push_back(file);
  }
  if (closest.empty())
    throw inputError(path.string(), "holds no .mrml, so it is no scene; save it again from Slicer");
  if (closest.size() == 1)
    return closest.front();
  std::vector<std::filesystem::path> named;
  std::string listed;
  for (const std::filesystem::path& file : closest) {
    if (file.stem() == path.stem() || file.stem() == file.parent_path().filename())
      named.push_back(file);
    listed += (listed.empty() ? "" : ", ") + oneLine(file.string());
  }
  if (named.size() == 1)
    return named.front();
  throw inputError(path.string(), "holds several scenes (" + listed.substr(0, 300) +
                                      "); unpack it and name one of them");
}

} // namespace

std::string decodedUrl(std::string text) {
  // Order matters: % was escaped first, so its escape is undone last.
  constexpr std::pair<std::string_view, std::string_view> escapes[] = {
      {"%22", "\""}, {"%3C", "<"}, {"%3E", ">"}, {"%27", "'"}, {"%20", " "}, {"%25", "%"}};
  for (const auto& [escape, character] : escapes)
    text = replacedAll(text, escape, character);
  return text;
}

bool isSceneFile(const std::filesystem::path& path) {
  const std::string extension = lowerExtension(path);
  return extension == ".mrml" || extension == ".mrb";
}

SceneFiles::SceneFiles(const std::filesystem::path& path) : m_source(path.string()) {
  requireFile(path, "name the .mrml or .mrb in it");
  if (lowerExtension(path) == ".mrb") {
    m_archive = std::make_unique<SceneArchive>(path);
    const std::filesystem::path scene = mainScene(*m_archive, path);
    m_sceneText = m_archive->text(scene, largestScene);
    m_folder = scene.parent_path();
  } else {
    m_sceneText = readText(path, largestScene);
    m_folder = path.parent_path();
  }
}

SceneFiles::~SceneFiles() = default;

std::filesystem::path SceneFiles::resolved(const std::string& fileName) const {
  return (m_folder / decodedUrl(fileName)).lexically_normal(); // an absolute name replaces m_folder
}

void SceneFiles::expect(const std::string& fileName) const {
  if (m_archive)
    return;
  const std::filesystem::path file = resolved(fileName);
  expectInput(file);
  for (const std::filesystem::path& part : filesNamedBy(file))
    expectInput(part);
}

bool SceneFiles::holds(const std::string& fileName) const {
  std::error_code failed;
  const std::filesystem::path file = resolved(fileName);
  return m_archive ? m_archive->files().contains(file) : std::filesystem::exists(file, failed);
}

std::filesystem::path SceneFiles::locate(const std::string& fileName) {
  const std::filesystem::path name = decodedUrl(fileName);
  std::filesystem::path file = resolved(fileName);
  if (!m_archive) {
    if (std::error_code failed; !std::filesystem::exists(file, failed))
      throw inputError(
          m_source,
          "names " + oneLine(file.string()) +
              (failed ? ", which cannot be read: " + systemMessage(failed.value()) + "; " +
                            readingMend(failed.value(), "check the permissions of its folder")
                      : ", which is not there; put it back, or save the scene again"));
    m_read.insert(file);
    return file;
  }
  if (name.is_absolute() || *file.begin() == "..")
    throw inputError(m_source, "names " + oneLine(name.string()) +
                                   ", which is outside the archive; save the scene again");
  if (!m_archive->files().contains(file))
    throw inputError(m_source, "names " + oneLine(file.string()) +
                                   ", which it does not hold; save the scene again");
  std::filesystem::path place = unpacked(file);
  const std::filesystem::path root = m_unpacked->path().lexically_normal();
  for (const std::filesystem::path& part : filesNamedBy(place))
    if (const auto beside = part.lexically_normal().lexically_relative(root);
        m_archive->files().contains(beside))
      unpacked(beside);
  return place;
}

std::filesystem::path SceneFiles::unpacked(const std::filesystem::path& file) {
  m_read.insert(file);
  if (const auto known = m_located.find(file); known != m_located.end())
    return known->second;
  if (!m_unpacked)
    m_unpacked.emplace();
  if (isTooLong(m_unpacked->path() / file))
    throw inputError(m_source, "names " + shown(file.string()) +
                                   ", which is too long for a file's name; save the scene again "
                                   "under shorter ones");
  const std::filesystem::path destination = m_unpacked->add(file);
  m_archive->extract(file, destination);
  return m_located[file] = destination;
}

std::vector<std::string> SceneFiles::filesRead() const {
  std::vector<std::string> files = {m_source};
  for (const std::filesystem::path& file : m_read)
    files.push_back(m_archive ? m_source + "/" + file.string() : file.string());
  return files;
}

std::string SceneFiles::asKnown(std::string message) const {
  if (m_unpacked)
    message = replacedAll(message, m_unpacked->path().string(), m_source);
  return oneLine(std::move(message));
}

} // namespace fenestra
