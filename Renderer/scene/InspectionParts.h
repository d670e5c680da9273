#pragma once
// Functions shared by the inspection of scenes and of plain files; private to this folder.

#include "base/Error.h"
#include "files/segments/SegmentationReader.h"
#include "scene/Inspection.h"
#include "scene/PreparedScene.h"

#include <filesystem>
#include <map>

namespace fenestra::core {

using Json = nlohmann::ordered_json; ///< a report, or part of it

/// Returns the result of `read`. On Error, stores its message in `problem` and returns nothing.
template <typename Read>
auto tryRead(Read&& read, Json& problem) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const Error& error) {
    problem = error.message();
    return std::nullopt;
  }
}

Json nullIfEmpty(const std::string& text);

/// An empty report, and an empty member `render`.
Inspection makeReport(const RenderRequest& request, const char* kind);
Json makeRenderReport();

Json volumeJson(const Volume& volume, const std::string& id = "");
Json transferJson(const char* source, const std::string& id, const std::string& name);
/// Default transfer function of a volume without segments.
Json defaultTransferJson(const Volume& volume);
Json poseJson(const CameraPose& pose, const std::string& id = "", const std::string& name = "");
/// Adds a POSE.
void addPose(const CameraPose& pose, Json& camera);

/// NODE without files, unused, without a problem.
Json nodeJson(const std::string& id, const std::string& name);
/// Additional members of a segmentation, before it is read.
Json segmentationMembers(const char* kind, bool shown);
/// Adds size, spacing and segments. A segment without an entry in `shown` counts as shown.
void addSegments(const Segmentation& segmentation, const std::map<std::string, bool>& shown,
                 Json& json);
/// Inspects a segmentation file. `volume`: grid on which closed surfaces are voxelized; null: none.
/// `labels`: RenderRequest::labels. Appends to `warnings`.
Json inspectSegmentationFile(const std::filesystem::path& path, const Grid* volume,
                             const std::optional<std::string>& labels, Json& warnings);

/// Adds a render of the first visible segment with voxels to the examples of `whole`. `choice`:
/// --volume, `segmentation`: --segmentation; null: neither is needed. `report`: of the
/// segmentation.
void addExample(const std::string& volume, const Json& choice, const Json& segmentation,
                const Json& report, Json& whole);

Inspection inspectScene(const RenderRequest& request, const Input& input);

} // namespace fenestra::core
