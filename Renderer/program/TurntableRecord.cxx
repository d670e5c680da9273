#include "program/TurntableRecord.h"

#include "base/Error.h"
#include "base/safe/Inputs.h"
#include "base/safe/JsonNode.h"
#include "program/FileNames.h"
#include "program/Version.h"

#include <algorithm>
#include <fstream>
#include <set>

namespace fenestra {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// Arguments on which the pictures of the frames depend.
json requestedArguments(const FlagValues& flags, const fs::path& folder) {
  FlagValues request = flags;
  for (const char* name : {"threads", "progress", "stats", "restart"})
    request.remove(name);
  for (const char* name : {"frames", "degrees"})
    if (!request.has(name))
      request.add(name, findFlag(turntableSyntax().flags, name)->takes.standard);
  return relativeArguments(request.arguments(), turntableSyntax().flags, folder);
}

std::uint64_t digest(const auto& voxels) {
  return stateOf(memoryOf(voxels)).digest;
}

/// Name, size and time of each file, by which a replaced file is noticed.
json fileStates(const std::set<fs::path>& files, const fs::path& folder) {
  json states = json::array();
  std::error_code failed;
  for (const fs::path& file : files) // a member of an archive changes with the archive
    if (fs::is_regular_file(file, failed))
      states.push_back(
          {{"file", relativeName(file.string(), folder)},
           {"bytes", fs::file_size(file, failed)},
           {"modified", fs::last_write_time(file, failed).time_since_epoch().count()}});
  return states;
}

/// True if a frame's file is as recorded; false if missing or empty: to be rendered again. Throws
/// Error (usage) for any other file: frames are placed whole, so a shorter one is no torn frame but
/// somebody's work.
bool isAsRecorded(const fs::path& path, const JsonNode& recorded) {
  std::error_code failed;
  const std::uintmax_t bytes = fs::file_size(path, failed);
  if (failed || bytes == 0)
    return false;
  if (recorded.at("bytes").json() == std::to_string(bytes)) {
    std::ifstream file(path, std::ios::binary);
    const std::string content(std::istreambuf_iterator<char>(file), {});
    if (recorded.at("digest").json() == std::to_string(stateOf(content).digest))
      return true;
  }
  throw usageError(path, ": is not the frame that was recorded; move it away, and the same "
                         "command renders it again");
}

/// Reads a record file, of untrusted size: at most a record of `mostFrames` frames. Throws Error
/// (input) if it is no JSON.
json readRecord(const fs::path& path, const TurntableOptions& options) {
  // Values and keys of a file and its frame; bytes, with a name of 255 letters, all escaped.
  constexpr int parts = 23, bytes = 2100;
  const int files =
      mostFrames * static_cast<int>(std::min<std::size_t>(options.files(0).size(), 100));
  const std::string text =
      readText(path, largestText + std::uint64_t{bytes} * static_cast<unsigned>(files));
  return parseJson(text, path.string(), mostJsonParts + parts * files);
}

/// True for the record of any turntable of any version of Fenestra.
bool isRecord(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const json document = json::parse(file, nullptr, false);
  return document.contains("/finished"_json_pointer) &&
         document.contains("/request/arguments"_json_pointer) &&
         document.contains("/request/version"_json_pointer);
}

/// Warning about existing files of the turntable in `record` that are no frames of these options.
/// Empty if there are none, or the record cannot be read: it is about to be replaced.
std::string warningBeyond(const TurntableOptions& options, const fs::path& record) {
  std::set<fs::path> beyond;
  try {
    const json document = readRecord(record, options);
    for (const JsonNode& frame : JsonNode(document, "").at("finished").elements())
      for (const JsonNode& file : frame.at("files").elements()) {
        const fs::path path = record.parent_path() / fs::path(file.at("file").text()).filename();
        std::error_code failed;
        const std::uintmax_t bytes = fs::file_size(path, failed);
        if (!failed && file.at("bytes").json() == std::to_string(bytes))
          beyond.insert(path);
      }
  } catch (const Error&) {
    return {};
  }
  for (int frame = 0; frame < options.frames; ++frame)
    for (const fs::path& file : options.files(frame))
      beyond.erase(file);
  if (beyond.empty())
    return {};
  constexpr const char* whose = " of the turntable that was there before; remove ";
  if (beyond.size() == 1)
    return textOf(*beyond.begin(), ": is", whose, "it");
  return textOf(*beyond.begin(), " to ", beyond.rbegin()->filename(), ": ", beyond.size(),
                " files are", whose, "them");
}

/// Elements of `some` missing from `others`, separated by blanks: arguments, or names of inputs.
std::string elementsBeyond(const json& some, const json& others) {
  std::string text;
  for (const json& element : some)
    if (std::ranges::find(others, element) == others.end())
      text += (text.empty() ? "" : " ") +
              (element.is_string() ? element.get<std::string>() : element.value("file", ""));
  return text;
}

/// Text of the difference between two requests in the value of `key`.
std::string difference(const std::string& key, const json& there, const json& here) {
  if (key == "version")
    return "made by fenestra " + there.dump();
  const std::string now = key == "voxels" ? "" : elementsBeyond(here, there);
  if (key != "arguments")
    return (now.empty() ? "the volume or the focus" : now) + " has changed since";
  const std::string before = elementsBeyond(there, here);
  return before + (before.empty() || now.empty() ? "" : " there, ") + now +
         (now.empty() ? " there" : " here");
}

/// Throws Error (input), naming file and field, unless a record's request has the structure that
/// `difference` relies on.
void checkRequest(const JsonNode& request) {
  request.allowOnly({"version", "arguments", "inputs", "voxels"});
  request.at("version").text();
  for (const JsonNode& argument : request.at("arguments").elements())
    argument.text();
  for (const JsonNode& input : request.at("inputs").elements())
    input.at("file").text();
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
    : m_options(options),
      m_path(recordPath(options.render.outputs.front(), options.shard)),
      m_request{{"version", versionText},
                {"arguments", requestedArguments(flags, m_path.parent_path())}} {
  const std::optional<FileId> there = fileId(m_path);
  if (options.restart && there)
    m_warning = warningBeyond(options, m_path);
  else if (there)
    read();
  else if (!options.restart)
    refuseFramesWithoutRecord();
  if (there)
    forgetInput(*there); // the record is rewritten, so it is no input
}

void TurntableRecord::refuseFramesWithoutRecord() const {
  for (int frame = m_options.first(); frame < m_options.end(); ++frame)
    for (const fs::path& file : m_options.files(frame))
      if (const auto id = fileId(file); id && !inputNamed(*id)) // inputs have their own refusal
        throw usageError(file, ": is there, and no ", m_path,
                         " tells what it is of; choose another --output, or add --restart to "
                         "replace it");
}

void TurntableRecord::read() {
  const json document = readRecord(m_path, m_options);
  const JsonNode root(document, m_path.string());
  checkRequest(root.at("request"));
  m_recorded = root.at("request").value();
  requireSame();
  for (const JsonNode& finished : root.at("finished").elements()) {
    const auto frame = static_cast<int>(finished.at("frame").numberIn(0, m_options.frames - 1));
    const auto files = finished.find("files"); // absent in files of older versions
    if (!files || !std::ranges::equal(m_options.files(frame), files->elements(), isAsRecorded))
      continue;
    m_finished[frame].files = files->value();
    if (const auto change = finished.find("surfaceChange"))
      m_finished[frame].change = changeIn(*change);
  }
}

void TurntableRecord::setInputs(const Scene& scene) {
  const std::vector<std::string> referred = scene.files();
  std::set<fs::path> files(referred.begin(), referred.end());
  files.insert(m_options.render.inputs.begin(), m_options.render.inputs.end());
  m_request["inputs"] = fileStates(files, m_path.parent_path());
  json& voxels = m_request["voxels"]; // which may lie in files that only a header names
  voxels["volume"] = std::visit([](const auto& v) { return digest(v); }, scene.volume().voxels);
  if (scene.focus())
    voxels["focus"] = digest(scene.focus()->voxels);
  if (!m_recorded.is_null())
    requireSame();
}

void TurntableRecord::requireSame() const {
  for (const auto& [key, here] : m_request.items())
    if (const json there = m_recorded.value(key, json()); there != here)
      throw usageError(m_path, ": is of another turntable (", difference(key, there, here),
                       "); choose another --output, or add --restart to replace its frames");
}

void TurntableRecord::declare(Outputs& outputs) const {
  outputs.add(m_path, isRecord);
}

void TurntableRecord::write(Outputs& outputs) const {
  nlohmann::ordered_json finished = nlohmann::ordered_json::array();
  for (const auto& [number, frame] : m_finished) {
    finished.push_back({{"frame", number}, {"files", frame.files}});
    if (frame.change)
      finished.back()["surfaceChange"] = changeJson(*frame.change);
  }
  outputs.write(m_path, jsonText({{"request", m_request}, {"finished", finished}}, 1));
  outputs.commit();
}

void TurntableRecord::finish(int frame, const std::optional<SurfaceChange>& change,
                             Outputs& outputs) {
  Frame& finished = m_finished[frame] = {json::array(), change};
  for (const fs::path& file : m_options.files(frame))
    if (const auto state = outputs.written(file))
      finished.files.push_back({{"file", file.filename().string()}, // beside the record
                                {"bytes", state->bytes},
                                {"digest", state->digest}});
  write(outputs);
}

} // namespace fenestra
