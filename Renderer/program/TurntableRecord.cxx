#include "program/TurntableRecord.h"

#include "base/Error.h"
#include "base/safe/Inputs.h"
#include "program/FileNames.h"

#include <algorithm>

namespace fenestra {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// Arguments on which the pictures of the frames depend.
std::vector<std::string> requestedArguments(const OptionValues& flags, const fs::path& folder) {
  OptionValues request = flags;
  for (const char* name : {"threads", "progress", "stats", "restart"})
    request.remove(name);
  for (const char* name : {"frames", "degrees"})
    if (!request.has(name))
      request.add(name, findOption(turntableSyntax().options, name)->spec.defaultValue);
  return relativeArguments(request.arguments(), turntableSyntax().options, folder);
}

std::uint64_t digest(const auto& voxels) {
  return stateOf(asBytes(voxels)).digest;
}

constexpr const char* changeKey = "surfaceChange";

SurfaceChange changeIn(const JsonNode& node) {
  const auto number = [&](const char* name) { return node.at(name).numberIn(0.0, 1e30); };
  return {number("mean"), number("p95"), number("max"), number("focus")};
}

} // namespace

nlohmann::ordered_json changeJson(const SurfaceChange& change) {
  return {{"mean", change.mean}, {"p95", change.p95}, {"max", change.max}, {"focus", change.focus}};
}

TurntableRecord::TurntableRecord(const TurntableOptions& options, const OptionValues& flags)
    : m_options(options),
      m_record(recordPath(options.render.outputs.front(), options.shard), "frame",
               requestedArguments(flags, options.render.outputs.front().parent_path())) {
  const std::optional<FileId> there = fileId(m_record.path());
  if (options.restart && there)
    m_warning = warningBeyond();
  else if (there)
    read();
  else if (!options.restart)
    refuseFramesWithoutRecord();
  if (there)
    forgetInput(*there); // the record is rewritten, so it is no input
}

int TurntableRecord::mostFiles() const {
  return mostFrames * static_cast<int>(std::min<std::size_t>(m_options.files(0).size(), 100));
}

void TurntableRecord::refuseFramesWithoutRecord() const {
  for (int frame = m_options.first(); frame < m_options.end(); ++frame)
    for (const fs::path& file : m_options.files(frame))
      if (const auto id = fileId(file); id && !inputNamed(*id)) // inputs have their own refusal
        throw usageError(file, ": is there, and no ", m_record.path(),
                         " tells what it is of; choose another --output, or add --restart to "
                         "replace it");
}

void TurntableRecord::read() {
  m_record.readRequest(mostFiles());
  requireSame();
  m_record.readPieces(
      m_options.frames, [this](int frame) { return m_options.files(frame); },
      [](const JsonNode& entry) {
        const auto change = entry.find(changeKey);
        return change ? json{{changeKey, changeJson(changeIn(*change))}} : json();
      });
}

/// Empty if there are none, or the record cannot be read: it is about to be replaced.
std::string TurntableRecord::warningBeyond() {
  std::set<fs::path> beyond;
  try {
    Record previous(m_record.path(), "frame", {});
    previous.readRequest(mostFiles());
    beyond = previous.recordedFiles();
  } catch (const Error&) {
    return {};
  }
  for (int frame = 0; frame < m_options.frames; ++frame)
    for (const fs::path& file : m_options.files(frame))
      beyond.erase(file);
  if (beyond.empty())
    return {};
  constexpr const char* whose = " of the turntable that was there before; remove ";
  if (beyond.size() == 1)
    return concat(*beyond.begin(), ": is", whose, "it");
  return concat(*beyond.begin(), " to ", beyond.rbegin()->filename(), ": ", beyond.size(),
                " files are", whose, "them");
}

void TurntableRecord::setInputs(const PreparedScene& scene) {
  const std::vector<std::string> referred = scene.files();
  std::set<fs::path> files(referred.begin(), referred.end());
  files.insert(m_options.render.inputs.begin(), m_options.render.inputs.end());
  m_record.requireInputs(files);
  json voxels = {
      {"volume", std::visit([](const auto& v) { return digest(v); }, scene.volume().voxels)}};
  if (scene.focus())
    voxels["focus"] = digest(scene.focus()->voxels);
  m_record.require("voxels", voxels); // which may lie in files that only a header names
  requireSame();
}

void TurntableRecord::requireSame() const {
  if (const auto difference = m_record.difference())
    throw usageError(m_record.path(), ": is of another turntable (", *difference,
                     "); choose another --output, or add --restart to replace its frames");
}

std::vector<SurfaceChange> TurntableRecord::changes() const {
  std::vector<SurfaceChange> changes;
  for (const auto& [number, frame] : finished())
    if (!frame.more.is_null())
      changes.push_back(changeIn(JsonNode(frame.more, m_record.path().string()).at(changeKey)));
  return changes;
}

void TurntableRecord::finish(int frame, const std::optional<SurfaceChange>& change,
                             Outputs& outputs) {
  Record::WrittenFiles files;
  for (const fs::path& file : m_options.files(frame))
    if (const auto state = outputs.written(file))
      files.emplace_back(file, *state);
  m_record.finish(frame, files, change ? json{{changeKey, changeJson(*change)}} : json(), outputs);
}

} // namespace fenestra
