#pragma once
// Finds the segmentations of a Slicer scene that have the segments of a focus.

#include "files/slicer/MrmlScene.h"

#include <optional>
#include <string>
#include <vector>

namespace fenestra::core {

/// Segmentations and label maps that have the segments `focus` (ids, names or label values), each
/// once: for a segment the only visible segmentation that has it, else the only segmentation, else
/// the only label map. Empty: the scene has fewer than two. `labels`: table of label names. Throws
/// Error (input) if several have a segment, or none has it and none is the first to be searched.
std::vector<const MrmlNode*> findFocusNodes(MrmlScene& scene, const std::vector<std::string>& focus,
                                            const std::optional<std::string>& labels);

} // namespace fenestra::core
