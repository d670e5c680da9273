#include "cli/TurntableRecord.h"

#include "cli/Version.h"
#include "core/Error.h"
#include "io/AtomicFile.h"
#include "io/JsonNode.h"

#include <algorithm>

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

json inputStates(const std::vector<std::filesystem::path>& inputs) {
  json states = json::array();
  for (const std::filesystem::path& input : inputs)
    if (std::filesystem::is_regular_file(input))
      states.push_back(fileState(input));
  return states;
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
  if (there["inputs"] != here["inputs"])
    return elementsBeyond(here["inputs"], there["inputs"]) + " has changed since";
  return "made by fenestra " + there["version"].dump();
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
      m_request{{"version", versionText},
                {"arguments", requestedArguments(flags)},
                {"inputs", inputStates(options.render.inputs)}},
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
  const json& request = document["request"];
  if (request != m_request)
    throw usageError(name + ": is of another turntable (" + difference(request, m_request) +
                     "); choose another --output, or add --restart to replace its frames");
  for (const JsonNode& finished : root.at("finished").elements()) {
    const auto frame = static_cast<int>(finished.at("frame").numberIn(0, options.frames - 1));
    const std::vector<std::filesystem::path> files = frameFiles(options, frame);
    m_finished[static_cast<std::size_t>(frame)] = std::all_of(
        files.begin(), files.end(), [](const auto& file) { return std::filesystem::exists(file); });
    if (const auto change = finished.find("surfaceChange"))
      m_changes[frame] = changeIn(*change);
  }
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
