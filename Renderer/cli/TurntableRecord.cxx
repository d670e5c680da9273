#include "cli/TurntableRecord.h"

#include "cli/Version.h"
#include "core/Error.h"
#include "io/AtomicFile.h"
#include "io/JsonNode.h"

#include <algorithm>
#include <set>
#include <string_view>

namespace fenestra {
namespace {

using nlohmann::json;

/// turn.png's is turn.turntable.json.
std::filesystem::path recordPath(const TurntableOptions& options) {
  std::filesystem::path path = options.render.outputs.front();
  return path.replace_filename(path.stem().string() + ".turntable.json");
}

/// What the frames' pictures depend on, as arguments.
json requestedArguments(const FlagValues& flags) {
  FlagValues request = flags;
  for (const char* name : {"threads", "progress", "stats", "restart"})
    request.remove(name);
  for (const char* name : {"frames", "degrees"})
    if (!request.has(name))
      request.add(name, findFlag(turntableSyntax().flags, name)->standard);
  return request.arguments();
}

/// A file as it is now, so that another one of its name is noticed.
json fileState(const std::filesystem::path& path) {
  std::error_code none;
  const auto bytes = std::filesystem::file_size(path, none);
  const auto modified = std::filesystem::last_write_time(path, none);
  return {
      {"file", path.string()}, {"bytes", bytes}, {"modified", modified.time_since_epoch().count()}};
}

json inputStates(const TurntableOptions& options, const Scene& scene) {
  std::set<std::filesystem::path> files(options.render.inputs.begin(), options.render.inputs.end());
  for (const std::string& file : scene.files())
    files.insert(file);
  json states = json::array();
  for (const std::filesystem::path& file : files) // what is in an archive changes with it
    if (std::filesystem::is_regular_file(file))
      states.push_back(fileState(file));
  return states;
}

template <typename T>
std::uint64_t digest(const std::vector<T>& voxels) {
  return std::hash<std::string_view>()(
      {reinterpret_cast<const char*>(voxels.data()), voxels.size() * sizeof(T)});
}

/// Of what may lie in files that only a header names.
json voxelDigests(const Scene& scene) {
  json digests = {
      {"volume", std::visit([](const auto& v) { return digest(v); }, scene.volume().voxels)}};
  if (scene.focus())
    digests["focus"] = digest(scene.focus()->voxels);
  return digests;
}

/// Elements of one array that another does not have.
std::string elementsBeyond(const json& some, const json& others) {
  std::string text;
  for (const json& element : some)
    if (std::find(others.begin(), others.end(), element) == others.end())
      text += (text.empty() ? "" : " ") +
              (element.is_string() ? element.get<std::string>() : element.value("file", ""));
  return text;
}

/// In what a record's request is not this one.
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
    : m_path(recordPath(options)),
      m_request{{"version", versionText}, {"arguments", requestedArguments(flags)}},
      m_finished(static_cast<std::size_t>(options.frames), false) {
  if (options.restart)
    return;
  if (std::filesystem::exists(m_path))
    read(options);
  else
    refuseOthers(options);
}

void TurntableRecord::refuseOthers(const TurntableOptions& options) const {
  for (int frame = 0; frame < options.frames; ++frame)
    for (const std::filesystem::path& file : frameFiles(options, frame))
      if (std::filesystem::exists(file))
        throw usageError(file.string() + ": is there, and no " + m_path.string() +
                         " tells what it is of; choose another --output, or add --restart to "
                         "replace it");
}

void TurntableRecord::read(const TurntableOptions& options) {
  const std::string name = m_path.string();
  const json document = parseJson(readText(m_path), name);
  const JsonNode root(document, name);
  for (const char* list : {"arguments", "inputs"})
    root.at("request").at(list).elements(); // throws where it is none
  m_recorded = document["request"];
  json known = m_recorded;
  for (const char* later : {"inputs", "voxels"})
    known.erase(later);
  requireSame(known, m_request, name);
  for (const JsonNode& finished : root.at("finished").elements()) {
    const auto frame = static_cast<int>(finished.at("frame").numberIn(0, options.frames - 1));
    const std::vector<std::filesystem::path> files = frameFiles(options, frame);
    m_finished[static_cast<std::size_t>(frame)] = std::all_of(
        files.begin(), files.end(), [](const auto& file) { return std::filesystem::exists(file); });
    if (const auto change = finished.find("surfaceChange"))
      m_changes[frame] = changeIn(*change);
  }
}

void TurntableRecord::setInputs(const TurntableOptions& options, const Scene& scene) {
  m_request["inputs"] = inputStates(options, scene);
  m_request["voxels"] = voxelDigests(scene);
  if (!m_recorded.is_null())
    requireSame(m_recorded, m_request, m_path.string());
}

int TurntableRecord::finishedCount() const {
  return static_cast<int>(std::count(m_finished.begin(), m_finished.end(), true));
}

void TurntableRecord::write() const {
  nlohmann::ordered_json finished = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < m_finished.size(); ++i) {
    if (!m_finished[i])
      continue;
    const auto frame = static_cast<int>(i);
    finished.push_back({{"frame", frame}});
    if (const auto change = m_changes.find(frame); change != m_changes.end())
      finished.back()["surfaceChange"] = changeJson(change->second);
  }
  const nlohmann::ordered_json record = {{"request", m_request}, {"finished", finished}};
  writeFile(m_path, record.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
}

void TurntableRecord::finish(int frame, const std::optional<SurfaceChange>& change) {
  m_finished[static_cast<std::size_t>(frame)] = true;
  if (change)
    m_changes[frame] = *change;
  write();
}

} // namespace fenestra
