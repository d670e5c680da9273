#pragma once
// Chooses the nodes of a Slicer scene to render: as visible in Slicer, or as the user selects.
// `fenestra inspect` prints the same plan.

#include "files/slicer/MrmlScene.h"

#include <optional>
#include <string>
#include <vector>

namespace fenestra::core {

/// Nodes that the user selects, by id or name; nullopt: not selected.
struct SceneSelection {
  std::optional<std::string> volume = {};
  std::optional<std::string> segmentation = {};
  bool needsSegmentation = false; ///< the request has a focus
};

/// Chosen nodes, owned by the document; null: none.
struct ScenePlan {
  const MrmlNode* volume = nullptr;       ///< never null
  const MrmlNode* rendering = nullptr;    ///< the volume's volume rendering display
  const MrmlNode* property = nullptr;     ///< the rendering's volume property
  const MrmlNode* sliceDisplay = nullptr; ///< slice display whose window the rendering follows
  const MrmlNode* roi = nullptr;          ///< crop box of the rendering
  const MrmlNode* segmentation = nullptr; ///< segmentation or label map
  const MrmlNode* view = nullptr;
  const MrmlNode* camera = nullptr;      ///< the view's camera
  std::vector<Message> warnings = {};    ///< "node: reason" for each difference from Slicer
  std::vector<std::string> ignored = {}; ///< "node: reason" for each unused node or setting
};

using SegmentationNodes = std::vector<const MrmlNode*>;
/// Visible segmentations, all segmentations, and all label maps: in this order a focus is searched.
std::vector<SegmentationNodes> listSegmentations(const MrmlDocument& document);

/// Throws Error (input) if the choice is ambiguous (the message lists the candidates), there is no
/// such volume, or a rendering technique has no equivalent in path tracing.
ScenePlan planRender(const MrmlDocument& document, const SceneSelection& choice);

} // namespace fenestra::core
