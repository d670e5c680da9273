#include "program/Manifest.h"

#include "base/Error.h"
#include "io/Digest.h"
#include "io/InputRegistry.h"
#include "program/FileNames.h"
#include "program/RenderOptions.h"
#include "program/UsageError.h"
#include "program/about/Version.h"

#include <algorithm>
#include <fstream>

namespace fenestra::core {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// Name, size and modification time of each file, in the order of names.
json listFileStates(const std::set<fs::path>& files, const fs::path& folder) {
  std::map<std::string, json> states; // one per file, even if `files` has several names of it
  std::error_code failed;
  for (const fs::path& file : files) // a member of an archive changes with the archive
    if (fs::is_regular_file(file, failed)) {
      const std::string name = toRelativeName(file.string(), folder);
      states[name] = {{"file", name},
                      {"bytes", fs::file_size(file, failed)},
                      {"modified", fs::last_write_time(file, failed).time_since_epoch().count()}};
    }
  json list = json::array();
  for (const auto& [name, state] : states)
    list.push_back(state);
  return list;
}

/// True if an item's file is unchanged; false if it is missing or empty, to be rendered again.
/// Throws Error (usage) for any other file: since items appear by renaming, it is not a partial
/// item but was replaced or edited.
bool isAsRecorded(const fs::path& path, const JsonNode& recorded, const std::string& itemKey) {
  std::error_code failed;
  const std::uintmax_t bytes = fs::file_size(path, failed);
  if (failed || bytes == 0)
    return false;
  if (recorded.at("bytes").json() == std::to_string(bytes) &&
      recorded.at("digest").json() == std::to_string(computeDigest(path)))
    return true;
  throw usageError(path, ": differs from the recorded ", itemKey,
                   "; move it away, and the same command renders it again");
}

/// True for the manifest of any task, written by any version of Fenestra.
bool isManifest(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const json document = json::parse(file, nullptr, false);
  return document.contains("/finished"_json_pointer) &&
         document.contains("/request/arguments"_json_pointer) &&
         document.contains("/request/version"_json_pointer);
}

/// Elements of `some` missing from `others`, separated by blanks: arguments, or names of inputs.
std::string listMissing(const json& some, const json& others) {
  std::vector<std::string> names;
  for (const json& element : some)
    if (std::ranges::find(others, element) == others.end())
      names.push_back(element.is_string() ? element.get<std::string>() : element.value("file", ""));
  return join(names, " ");
}

/// Text of the difference between the values of `key` in two requests.
std::string describeDifference(const std::string& key, const json& stored, const json& current) {
  if (key == "version")
    return "written by fenestra " + stored.dump();
  const std::string now = key == "voxels" ? "" : listMissing(current, stored);
  if (key != "arguments")
    return (now.empty() ? "the volume or the focus" : now) + " has changed";
  const std::string before = listMissing(stored, current);
  return before + (before.empty() || now.empty() ? "" : " before, ") + now +
         (now.empty() ? " before" : " now");
}

/// Throws Error (input), naming file and field, unless a stored request has the structure that
/// `describeDifference` relies on.
void checkRequest(const JsonNode& request) {
  request.allowOnly({"version", "arguments", "inputs", "voxels"});
  request.at("version").text();
  for (const JsonNode& argument : request.at("arguments").elements())
    argument.text();
  for (const JsonNode& input : request.at("inputs").elements())
    input.at("file").text();
}

} // namespace

Manifest::Manifest(fs::path path, std::string itemKey, const std::vector<std::string>& arguments)
    : m_path(std::move(path)),
      m_itemKey(std::move(itemKey)),
      m_request{{"version", samplingVersionText}, {"arguments", arguments}} {}

void Manifest::addInputs(const std::set<fs::path>& files) {
  addRequest("inputs", listFileStates(files, folder()));
}

void Manifest::readRequest(int mostFiles) {
  // Maxima per file: JSON values and keys of the file and its item; bytes, with an escaped name of
  // 255 characters.
  constexpr int parts = 23, bytes = 2100;
  const std::string text =
      readText(m_path, maxTextBytes + std::uint64_t{bytes} * static_cast<unsigned>(mostFiles));
  m_document = parseJson(text, m_path.string(), maxJsonNodes + parts * mostFiles);
  const JsonNode request = JsonNode(m_document, m_path.string()).at("request");
  checkRequest(request);
  m_recorded = request.value();
  for (json& argument : m_recorded.at("arguments")) // may have names from version 0.1
    argument = toCanonicalArgument(argument.get<std::string>(), renderSyntax.options);
}

std::set<fs::path> Manifest::recordedInputs() const {
  std::set<fs::path> files;
  if (hasRequest())
    for (const json& input : m_recorded.at("inputs"))
      files.insert(folder() / input.at("file").get<std::string>());
  return files;
}

std::optional<std::string> Manifest::findDifference() const {
  if (hasRequest())
    for (const auto& [key, current] : m_request.items())
      if (const json stored = m_recorded.value(key, json()); stored != current)
        return describeDifference(key, stored, current);
  return std::nullopt;
}

void Manifest::readItems(int count, const ListFiles& listFiles,
                         const std::function<json(const JsonNode&)>& readExtra) {
  const JsonNode root(m_document, m_path.string());
  for (const JsonNode& entry : root.at("finished").elements()) {
    const auto item = static_cast<int>(entry.at(m_itemKey).number(0, count - 1));
    const auto files = entry.find("files"); // missing in manifests of older versions
    const auto isUnchanged = [this](const fs::path& path, const JsonNode& recorded) {
      return isAsRecorded(path, recorded, m_itemKey);
    };
    if (files && std::ranges::equal(listFiles(item), files->elements(), isUnchanged))
      m_finished[item] = {files->value(), readExtra(entry)};
  }
}

std::set<fs::path> Manifest::recordedFiles() const {
  std::set<fs::path> unchanged;
  const JsonNode root(m_document, m_path.string());
  for (const JsonNode& entry : root.at("finished").elements())
    for (const JsonNode& file : entry.at("files").elements()) {
      const fs::path path = folder() / fs::path(file.at("file").text()).filename();
      std::error_code failed;
      const std::uintmax_t bytes = fs::file_size(path, failed);
      if (!failed && file.at("bytes").json() == std::to_string(bytes))
        unchanged.insert(path);
    }
  return unchanged;
}

void Manifest::declare(Outputs& outputs) const {
  outputs.add(m_path, isManifest);
}

void Manifest::write(Outputs& outputs) const {
  nlohmann::ordered_json finished = nlohmann::ordered_json::array();
  for (const auto& [number, item] : m_finished) {
    finished.push_back({{m_itemKey, number}, {"files", item.files}});
    if (!item.extra.is_null())
      finished.back().update(item.extra);
  }
  outputs.write(m_path, dumpJson({{"request", m_request}, {"finished", finished}}, 1));
  outputs.commit();
}

void Manifest::finish(int item, const WrittenFiles& files, const json& extra, Outputs& outputs) {
  Item& finished = m_finished[item] = {json::array(), extra};
  for (const auto& [file, state] : files)
    finished.files.push_back({{"file", file.filename().string()}, // in the manifest's folder
                              {"bytes", state.bytes},
                              {"digest", state.digest}});
  write(outputs);
}

} // namespace fenestra::core
