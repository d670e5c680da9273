#pragma once
// What a request's files hold, whatever they are: a volume, a DICOM folder, or a Slicer scene with
// all that was set up in it. Three parts, so that a changed request reads only what it changes;
// each throws Error.

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
  std::vector<std::string> files = {}; ///< that were read
};
VolumeInput loadVolume(const SceneRequest& request);

/// Of a Slicer scene, beside its volume; each is nothing where the scene does not say, or the
/// request says otherwise.
struct SceneSettings {
  std::optional<TransferFunction> transfer = {};
  std::string transferName = {};
  std::optional<CropBox> crop = {};
  std::optional<CameraPose> camera = {};
  std::optional<Background> background = {};

  std::vector<std::string> warnings = {};
  std::vector<std::string> files = {}; ///< that were read
};
SceneSettings loadSettings(const SceneRequest& request, const Volume& volume);
/// Whether loadSettings reads the same for both, of one scene.
bool sameSettings(const SceneRequest& a, const SceneRequest& b);

struct FocusInput {
  Mask mask;
  std::vector<std::string> files; ///< that were read
};
/// The names of all segments among which a focus would be looked for, without their labels.
struct SegmentNames {
  std::string source;                ///< names the segmentation in messages
  std::vector<SegmentInfo> segments; ///< empty where they have no names
};
/// Nothing where there is no segmentation. Of the request the input, the volume and the
/// segmentation count.
std::optional<SegmentNames> loadSegmentNames(const SceneRequest& request);

/// The segments that the request asks for; nothing where it asks for none.
std::optional<FocusInput> loadFocus(const SceneRequest& request, const Grid& volume);

} // namespace fenestra
