#include "program/TurntableManifest.h"

#include "base/Error.h"
#include "io/InputRegistry.h"
#include "program/FileNames.h"
#include "program/UsageError.h"

#include <algorithm>

namespace fenestra::core {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// Arguments that the images of the frames depend on.
std::vector<std::string> listArguments(const OptionValues& values, const fs::path& folder) {
  OptionValues request = values;
  for (const char* name : {"threads", "progress", "quiet", "verbose", "stats-json", "restart"})
    request.remove(name);
  for (const char* name : {"frames", "degrees"})
    if (!request.has(name))
      request.add(name, findOption(turntableSyntax().options, name)->spec.defaultValue);
  return toRelativeArguments(request.arguments(), turntableSyntax().options, folder);
}

std::uint64_t computeVoxelDigest(const auto& voxels) {
  return digestContent(asBytes(voxels)).digest;
}

constexpr const char* changeKey = "surfaceChange";

SurfaceChange readChange(const JsonNode& node) {
  const auto number = [&](const char* name) { return node.at(name).number(0.0, 1e30); };
  return {number("mean"), number("p95"), number("max"), number("focus")};
}

} // namespace

nlohmann::ordered_json toJson(const SurfaceChange& change) {
  return {{"mean", change.mean}, {"p95", change.p95}, {"max", change.max}, {"focus", change.focus}};
}

TurntableManifest::TurntableManifest(const TurntableOptions& options, const OptionValues& values)
    : m_options(options),
      m_manifest(manifestPath(options.render.outputs.front(), options.shard), "frame",
                 listArguments(values, options.render.outputs.front().parent_path())) {
  const std::optional<FileId> there = fileId(m_manifest.path());
  if (options.restart && there)
    m_warning = makeStaleWarning();
  else if (there)
    read();
  else if (!options.restart)
    rejectUnknownFrames();
  if (there)
    unregisterInput(*there); // since the manifest is also an output
}

int TurntableManifest::maxFiles() const {
  return maxFrames * static_cast<int>(std::min<std::size_t>(m_options.files(0).size(), 100));
}

void TurntableManifest::rejectUnknownFrames() const {
  for (int frame = m_options.first(); frame < m_options.end(); ++frame)
    for (const fs::path& file : m_options.files(frame))
      if (const auto id = fileId(file); id && !findInput(*id)) // inputs have their own message
        throw usageError(file, ": already exists, and no ", m_manifest.path(),
                         " describes it; use another --output, or add --restart to replace "
                         "it");
}

void TurntableManifest::read() {
  m_manifest.readRequest(maxFiles());
  requireSame();
  m_manifest.readItems(
      m_options.frames, [this](int frame) { return m_options.files(frame); },
      [](const JsonNode& entry) {
        const auto change = entry.find(changeKey);
        return change ? json{{changeKey, toJson(readChange(*change))}} : json();
      });
}

/// Empty if there are none, or the manifest cannot be read, since it is about to be replaced.
std::string TurntableManifest::makeStaleWarning() {
  std::set<fs::path> stale;
  try {
    Manifest previous(m_manifest.path(), "frame", {});
    previous.readRequest(maxFiles());
    stale = previous.recordedFiles();
  } catch (const Error&) {
    return {};
  }
  for (int frame = 0; frame < m_options.frames; ++frame)
    for (const fs::path& file : m_options.files(frame))
      stale.erase(file);
  if (stale.empty())
    return {};
  constexpr const char* whose = " from the previous turntable of that name; remove ";
  if (stale.size() == 1)
    return concat(*stale.begin(), ": is", whose, "it");
  return concat(*stale.begin(), " to ", stale.rbegin()->filename(), ": ", stale.size(),
                " files are", whose, "them");
}

void TurntableManifest::setInputs(const PreparedScene& scene) {
  const std::vector<std::string> referred = scene.files();
  std::set<fs::path> files(referred.begin(), referred.end());
  files.insert(m_options.render.inputs.begin(), m_options.render.inputs.end());
  m_manifest.addInputs(files);
  json voxels = {{"volume", std::visit([](const auto& v) { return computeVoxelDigest(v); },
                                       scene.volume().voxels)}};
  if (scene.focus())
    voxels["focus"] = computeVoxelDigest(scene.focus()->voxels);
  m_manifest.addRequest("voxels", voxels); // which may be in files that only a header names
  requireSame();
}

void TurntableManifest::requireSame() const {
  if (const auto difference = m_manifest.findDifference())
    throw usageError(m_manifest.path(), ": belongs to another turntable (", *difference,
                     "); use another --output, or add --restart to replace its frames");
}

std::vector<SurfaceChange> TurntableManifest::changes() const {
  std::vector<SurfaceChange> changes;
  for (const auto& [number, frame] : finished())
    if (!frame.extra.is_null())
      changes.push_back(
          readChange(JsonNode(frame.extra, m_manifest.path().string()).at(changeKey)));
  return changes;
}

void TurntableManifest::finish(int frame, const std::optional<SurfaceChange>& change,
                               Outputs& outputs) {
  Manifest::WrittenFiles files;
  for (const fs::path& file : m_options.files(frame))
    if (const auto state = outputs.writtenDigest(file))
      files.emplace_back(file, *state);
  m_manifest.finish(frame, files, change ? json{{changeKey, toJson(*change)}} : json(), outputs);
}

} // namespace fenestra::core
