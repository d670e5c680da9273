#include "program/TurntableRecord.h"

#include "base/Error.h"
#include "base/safe/Inputs.h"
#include "base/safe/JsonNode.h"
#include "program/FileNames.h"
#include "program/Version.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <string_view>

namespace fenestra {
namespace {

using nlohmann::json;

/// Arguments on which the pictures of the frames depend.
json requestedArguments(const FlagValues& flags, const std::filesystem::path& folder) {
  FlagValues request = flags;
  for (const char* name : {"threads", "progress", "stats", "restart"})
    request.remove(name);
  for (const char* name : {"frames", "degrees"})
    if (!request.has(name))
      request.add(name, findFlag(turntableSyntax().flags, name)->takes.standard);
  return relativeArguments(request.arguments(), turntableSyntax().flags, folder);
}

template <typename T>
std::uint64_t digest(const std::vector<T>& voxels) {
  return stateOf({reinterpret_cast<const char*>(voxels.data()), voxels.size() * sizeof(T)}).digest;
}

/// Name, size and time of a file, so that a replaced file is noticed.
json fileState(const std::filesystem::path& path, const std::filesystem::path& folder) {
  std::error_code none;
  const auto bytes = std::filesystem::file_size(path, none);
  const auto modified = std::filesystem::last_write_time(path, none);
  return {{"file", relativeName(path.string(), folder)},
          {"bytes", bytes},
          {"modified", modified.time_since_epoch().count()}};
}

json inputStates(const TurntableOptions& options, const Scene& scene,
                 const std::filesystem::path& folder) {
  std::set<std::filesystem::path> files(options.render.inputs.begin(), options.render.inputs.end());
  for (const std::string& file : scene.files())
    files.insert(file);
  json states = json::array();
  for (const std::filesystem::path& file : files) // a member of an archive changes with the archive
    if (std::error_code failed; std::filesystem::is_regular_file(file, failed))
      states.push_back(fileState(file, folder));
  return states;
}

ContentState contentAt(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return stateOf(std::string(std::istreambuf_iterator<char>(file), {}));
}

/// True if a frame's file is as recorded; false if missing or empty: to be rendered again. Throws
/// Error (usage) for any other file: frames are placed whole, so a shorter one is no torn frame but
/// somebody's work.
bool isAsRecorded(const std::filesystem::path& path, const JsonNode& recorded) {
  std::error_code failed;
  const std::uintmax_t bytes = std::filesystem::file_size(path, failed);
  const double recordedBytes = recorded.at("bytes").numberIn(0.0, 1e15);
  if (failed || bytes == 0)
    return false;
  if (static_cast<double>(bytes) == recordedBytes &&
      json(contentAt(path).digest).dump() == recorded.at("digest").json())
    return true;
  throw usageError(path.string() +
                   ": is not the frame that was recorded; move it away, and the same "
                   "command renders it again");
}

/// Reads a record file. Limits its untrusted size to that of a record of `mostFrames` frames with
/// `filesOfFrame` files each. Throws Error (input) if it is no JSON.
json readRecord(const std::filesystem::path& path, std::size_t filesOfFrame) {
  constexpr int partsOfFrame = 16, partsOfFile = 7;     // values and keys that write() makes
  constexpr int bytesOfFrame = 400, bytesOfFile = 1700; // with a name of 255 letters, all escaped
  const int files = static_cast<int>(std::min<std::size_t>(filesOfFrame, 100));
  const std::string text =
      readText(path, largestText + std::uint64_t{mostFrames} *
                                       static_cast<unsigned>(bytesOfFrame + files * bytesOfFile));
  return parseJson(text, path.string(),
                   mostJsonParts + mostFrames * (partsOfFrame + files * partsOfFile));
}

/// True for the record of any turntable of any version of Fenestra.
bool isRecord(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const json document = json::parse(file, nullptr, false);
  return document.is_object() && document.contains("finished") && document.contains("request") &&
         document["request"].is_object() && document["request"].contains("arguments") &&
         document["request"].contains("version");
}

/// Digests of the voxels, which may lie in files that only a header names.
json voxelDigests(const Scene& scene) {
  json digests = {
      {"volume", std::visit([](const auto& v) { return digest(v); }, scene.volume().voxels)}};
  if (scene.focus())
    digests["focus"] = digest(scene.focus()->voxels);
  return digests;
}

/// Existing files of the turntable in `record` that are no frames of these options. Empty if the
/// record cannot be read: it is about to be replaced.
std::vector<std::filesystem::path> filesBeyond(const TurntableOptions& options,
                                               const std::filesystem::path& record) {
  std::set<std::filesystem::path> beyond;
  try {
    const json document = readRecord(record, frameFiles(options, 0).size());
    for (const JsonNode& finished : JsonNode(document, "").at("finished").elements())
      for (const JsonNode& file : finished.at("files").elements()) {
        std::filesystem::path path = record;
        path.replace_filename(std::filesystem::path(file.at("file").text()).filename());
        std::error_code failed;
        const std::uintmax_t bytes = std::filesystem::file_size(path, failed);
        if (!failed && static_cast<double>(bytes) == file.at("bytes").number())
          beyond.insert(path);
      }
  } catch (const Error&) {
    return {};
  }
  for (int frame = 0; frame < options.frames; ++frame)
    for (const std::filesystem::path& file : frameFiles(options, frame))
      beyond.erase(file);
  return {beyond.begin(), beyond.end()};
}

/// Elements of `some` missing from `others`, separated by blanks.
std::string elementsBeyond(const json& some, const json& others) {
  const std::set<json> known(others.begin(), others.end());
  std::string text;
  for (const json& element : some)
    if (!known.contains(element))
      text += (text.empty() ? "" : " ") +
              (element.is_string() ? element.get<std::string>() : element.value("file", ""));
  return text;
}

/// Throws Error (input), naming file and field, unless a record's request has the structure that
/// `difference` and other readers rely on.
void checkRequest(const JsonNode& request) {
  request.allowOnly({"version", "arguments", "inputs", "voxels"});
  request.at("version").text();
  for (const JsonNode& argument : request.at("arguments").elements())
    argument.text();
  for (const JsonNode& input : request.at("inputs").elements())
    input.at("file").text();
}

/// Text of the first difference between a record's request and the current one.
std::string difference(const json& there, const json& here) {
  if (there["arguments"] != here["arguments"]) {
    const std::string before = elementsBeyond(there["arguments"], here["arguments"]);
    const std::string now = elementsBeyond(here["arguments"], there["arguments"]);
    return before + (before.empty() || now.empty() ? "" : " there, ") + now +
           (now.empty() ? " there" : " here");
  }
  if (there["version"] != here["version"])
    return "made by fenestra " + there["version"].dump();
  const std::string changed = elementsBeyond(here["inputs"], there["inputs"]);
  return (changed.empty() ? "the volume or the focus" : changed) + " has changed since";
}

void requireSame(const json& there, const json& here, const std::string& record) {
  if (there != here)
    throw usageError(record + ": is of another turntable (" + difference(there, here) +
                     "); choose another --output, or add --restart to replace its frames");
}

SurfaceChange changeIn(const JsonNode& node) {
  const auto number = [&](const char* name) { return node.at(name).numberIn(0.0, 1e30); };
  return {number("mean"), number("p95"), number("max"), number("focus")};
}

} // namespace

nlohmann::ordered_json changeJson(const SurfaceChange& change) {
  return {{"mean", change.mean}, {"p95", change.p95}, {"max", change.max}, {"focus", change.focus}};
}

TurntableRecord::TurntableRecord(const TurntableOptions& options, const FlagValues& flags)
    : m_path(recordPath(options.render.outputs.front())),
      m_request{{"version", versionText},
                {"arguments", requestedArguments(flags, m_path.parent_path())}},
      m_finished(static_cast<std::size_t>(options.frames), false) {
  std::error_code failed;
  const bool isThere = std::filesystem::exists(m_path, failed);
  if (options.restart && isThere)
    m_beyond = filesBeyond(options, m_path);
  else if (isThere)
    read(options);
  else if (!options.restart)
    refuseOthers(options);
  if (const auto file = isThere ? fileId(m_path) : std::nullopt)
    forgetInput(*file); // the record is rewritten, so it is no input
}

std::optional<std::string> TurntableRecord::warning() const {
  if (m_beyond.empty())
    return std::nullopt;
  const bool isOne = m_beyond.size() == 1;
  return m_beyond.front().string() + (isOne ? "" : " to " + m_beyond.back().filename().string()) +
         (isOne ? ": is" : ": " + std::to_string(m_beyond.size()) + " files are") +
         " of the turntable that was there before; remove " + (isOne ? "it" : "them");
}

void TurntableRecord::refuseOthers(const TurntableOptions& options) const {
  for (int frame = 0; frame < options.frames; ++frame)
    for (const std::filesystem::path& file : frameFiles(options, frame))
      if (const auto id = fileId(file); id && !inputNamed(*id)) // inputs have their own refusal
        throw usageError(file.string() + ": is there, and no " + m_path.string() +
                         " tells what it is of; choose another --output, or add --restart to "
                         "replace it");
}

void TurntableRecord::read(const TurntableOptions& options) {
  const std::string name = m_path.string();
  const json document = readRecord(m_path, frameFiles(options, 0).size());
  const JsonNode root(document, name);
  checkRequest(root.at("request"));
  m_recorded = document["request"];
  json known = m_recorded;
  for (const char* later : {"inputs", "voxels"})
    known.erase(later);
  requireSame(known, m_request, name);
  std::size_t at = 0;
  for (const JsonNode& finished : root.at("finished").elements()) {
    const auto frame = static_cast<int>(finished.at("frame").numberIn(0, options.frames - 1));
    const std::vector<std::filesystem::path> files = frameFiles(options, frame);
    const auto recorded = finished.find("files"); // absent in files of older versions
    const auto states = recorded ? recorded->elements() : std::vector<JsonNode>();
    bool isWhole = states.size() == files.size();
    for (std::size_t i = 0; isWhole && i < files.size(); ++i)
      isWhole = isAsRecorded(files[i], states[i]);
    m_finished[static_cast<std::size_t>(frame)] = isWhole;
    if (isWhole)
      m_files[frame] = document["finished"][at]["files"];
    ++at;
    if (const auto change = finished.find("surfaceChange"))
      m_changes[frame] = changeIn(*change);
  }
}

void TurntableRecord::setInputs(const TurntableOptions& options, const Scene& scene) {
  m_request["inputs"] = inputStates(options, scene, m_path.parent_path());
  m_request["voxels"] = voxelDigests(scene);
  if (!m_recorded.is_null())
    requireSame(m_recorded, m_request, m_path.string());
}

int TurntableRecord::finishedCount() const {
  return static_cast<int>(std::count(m_finished.begin(), m_finished.end(), true));
}

void TurntableRecord::declare(Outputs& outputs) const {
  outputs.addUnnamed(m_path, isRecord);
}

void TurntableRecord::write(Outputs& outputs) const {
  nlohmann::ordered_json finished = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < m_finished.size(); ++i) {
    if (!m_finished[i])
      continue;
    const auto frame = static_cast<int>(i);
    finished.push_back({{"frame", frame}, {"files", m_files.at(frame)}});
    if (const auto change = m_changes.find(frame); change != m_changes.end())
      finished.back()["surfaceChange"] = changeJson(change->second);
  }
  const nlohmann::ordered_json record = {{"request", m_request}, {"finished", finished}};
  outputs.write(m_path, record.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
  outputs.commit();
}

void TurntableRecord::finish(int frame, const std::vector<std::filesystem::path>& files,
                             const std::optional<SurfaceChange>& change, Outputs& outputs) {
  m_finished[static_cast<std::size_t>(frame)] = true;
  m_files[frame] = json::array();
  for (const std::filesystem::path& file : files)
    if (const auto state = outputs.written(file)) // a picture without depth has one file less
      m_files[frame].push_back({{"file", file.filename().string()}, // beside the record
                                {"bytes", state->bytes},
                                {"digest", state->digest}});
  if (change)
    m_changes[frame] = *change;
  write(outputs);
}

} // namespace fenestra
