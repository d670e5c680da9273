#pragma once
// What a request's files hold, whatever they are: a volume, a DICOM folder, or a Slicer scene with
// all that was set up in it.

#include "camera/Camera.h"
#include "medium/TransferFunction.h"
#include "scene/RenderRequest.h"
#include "volume/Domain.h"
#include "volume/Mask.h"
#include "volume/Volume.h"

#include <optional>
#include <string>
#include <vector>

namespace fenestra {

struct SceneInput {
  Volume volume;
  std::optional<Mask> focus = {};

  // Of a Slicer scene; each is nothing where the scene does not say, or the request says otherwise.
  std::optional<TransferFunction> transfer = {};
  std::string transferName = {};
  std::optional<CropBox> crop = {};
  std::optional<CameraPose> camera = {};
  std::optional<Background> background = {};

  std::vector<std::string> warnings = {};
};

/// Reads what the request needs. Throws Error.
SceneInput loadInput(const SceneRequest& request);

} // namespace fenestra
