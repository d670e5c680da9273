#pragma once
// Parts shared by the inspections of scenes and of plain files. For session's own sources.

#include "base/Error.h"
#include "files/segments/SegmentationReader.h"
#include "scene/Inspection.h"
#include "scene/PreparedScene.h"

#include <filesystem>
#include <map>

namespace fenestra {

using Json = nlohmann::ordered_json; ///< a report, or a part of it

/// Result of `read`; nothing: `line` holds the line of the Error thrown.
template <typename Read>
auto tryRead(Read&& read, Json& line) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const Error& error) {
    line = error.what();
    return std::nullopt;
  }
}

/// Null for the empty text.
Json nullIfEmpty(const std::string& text);

/// Report with nothing found, and its member `render` with nothing used.
Inspection makeReport(const RenderRequest& request, const char* kind);
Json makeRenderReport();

Json volumeJson(const Volume& volume, const std::string& id = "");
Json transferJson(const char* source, const std::string& id, const std::string& name);
/// Look of a volume without settings, by modality and range.
Json defaultTransferJson(const Volume& volume);
Json poseJson(const CameraPose& pose, const std::string& id = "", const std::string& name = "");
/// Adds a POSE.
void addPose(const CameraPose& pose, Json& camera);

/// NODE without files, unused, without a problem.
Json nodeJson(const std::string& id, const std::string& name);
/// Members that a segmentation has beyond NODE, before it is read.
Json segmentationMembers(const char* kind, bool shown);
/// Adds size, spacing and segments; segments without an entry in `shown` are shown.
void addSegments(const Segmentation& segmentation, const std::map<std::string, bool>& shown,
                 Json& json);
/// Segmentation of a file. `volume`: grid that closed surfaces become labels on; null: none.
/// `labels`: RenderRequest's.
Json inspectSegmentationFile(const std::filesystem::path& path, const Grid* volume,
                             const std::optional<std::string>& labels);

Inspection inspectScene(const RenderRequest& request, const Input& input);

} // namespace fenestra
