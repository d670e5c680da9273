#pragma once
// Which nodes of a Slicer scene a picture shows: as Slicer shows them, or as the user chooses.

#include "files/slicer/MrmlScene.h"

#include <optional>
#include <string>
#include <vector>

namespace fenestra {

/// What the user says; names or ids.
struct SceneChoice {
  std::optional<std::string> volume = {};
  std::optional<std::string> segmentation = {};
  bool needsSegmentation = false; ///< there is a focus to find in it
};

/// Nodes are the document's; null where there is none.
struct ScenePlan {
  const MrmlNode* volume = nullptr;       ///< always there
  const MrmlNode* rendering = nullptr;    ///< the volume's volume rendering display
  const MrmlNode* property = nullptr;     ///< of the rendering
  const MrmlNode* followed = nullptr;     ///< the slice display whose window the rendering follows
  const MrmlNode* roi = nullptr;          ///< that crops the rendering
  const MrmlNode* segmentation = nullptr; ///< or label map
  const MrmlNode* view = nullptr;
  const MrmlNode* camera = nullptr;       ///< of the view
  std::vector<std::string> warnings = {}; ///< "what: why": the picture differs from Slicer's
  std::vector<std::string> ignored = {};  ///< "what: why", of what else the scene holds
};

/// Throws Error (input) where the choice is open (it lists what there is), names nothing, or the
/// view's technique is none that a path tracer has.
ScenePlan planRender(const MrmlDocument& document, const SceneChoice& choice);

} // namespace fenestra
