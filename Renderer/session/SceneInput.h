#pragma once
// Contents of a request's files: a volume, a DICOM folder, or a Slicer scene with its settings.
// Three parts, so that a changed request reads only the changed parts; each throws Error.

#include "files/segments/SegmentationReader.h"
#include "model/camera/Camera.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Domain.h"
#include "model/volume/Mask.h"
#include "model/volume/Volume.h"
#include "session/RenderRequest.h"

#include <optional>
#include <string>
#include <vector>

namespace fenestra {

struct VolumeInput {
  Volume volume;
  std::vector<std::string> files = {}; ///< files read
};
VolumeInput loadVolume(const SceneRequest& request);

/// Settings of a Slicer scene. Nothing: not set in the scene, or overridden by the request.
struct SceneSettings {
  std::optional<TransferFunction> transfer = {};
  std::string transferName = {};
  std::optional<CropBox> crop = {};
  std::optional<CameraPose> camera = {};
  std::optional<Background> background = {};

  std::vector<std::string> warnings = {};
  std::vector<std::string> files = {}; ///< files read
};
SceneSettings loadSettings(const SceneRequest& request, const Volume& volume);
/// True if loadSettings reads equal settings for both requests, from one scene.
bool sameSettings(const SceneRequest& a, const SceneRequest& b);

struct FocusInput {
  Mask mask;
  std::vector<std::string> files; ///< files read
};
/// Names of all segments that would be searched for a focus, without labels.
struct SegmentNames {
  std::string source;                ///< names the segmentation in messages
  std::vector<SegmentInfo> segments; ///< empty: segments have no names
};
/// Names of the segments; nothing without a segmentation. Reads only request.input, .volume and
/// .segmentation.
std::optional<SegmentNames> loadSegmentNames(const SceneRequest& request);

/// Mask of the requested segments; nothing if none are requested.
std::optional<FocusInput> loadFocus(const SceneRequest& request, const Grid& volume);

} // namespace fenestra
