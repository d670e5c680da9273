#pragma once
// Nodes of a Slicer scene that a picture shows: as in Slicer, or as the user chooses.

#include "files/slicer/MrmlScene.h"

#include <optional>
#include <string>
#include <vector>

namespace fenestra {

/// Nodes that the user chooses, by id or name; nullopt: no choice.
struct SceneSelection {
  std::optional<std::string> volume = {};
  std::optional<std::string> segmentation = {};
  bool needsSegmentation = false; ///< a focus must be found
};

/// Chosen nodes, owned by the document; null: none.
struct ScenePlan {
  const MrmlNode* volume = nullptr;       ///< never null
  const MrmlNode* rendering = nullptr;    ///< volume rendering display of the volume
  const MrmlNode* property = nullptr;     ///< volume property of the rendering
  const MrmlNode* sliceDisplay = nullptr; ///< slice display whose window the rendering follows
  const MrmlNode* roi = nullptr;          ///< box that crops the rendering
  const MrmlNode* segmentation = nullptr; ///< segmentation or label map
  const MrmlNode* view = nullptr;
  const MrmlNode* camera = nullptr;       ///< camera of the view
  std::vector<std::string> warnings = {}; ///< "node: reason", unlike in Slicer
  std::vector<std::string> ignored = {};  ///< "node: reason", for nodes and settings left out
};

/// Throws Error (input) where the choice is ambiguous (the message lists the candidates), names no
/// volume, or a technique has no equivalent in path tracing.
ScenePlan planRender(const MrmlDocument& document, const SceneSelection& choice);

} // namespace fenestra
