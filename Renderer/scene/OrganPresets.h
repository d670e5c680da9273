#pragma once
// Matching of organ presets and segments. A preset only supplies default options. Its segments are
// found by name, without reading labels, so later stages get options that a user could have given.
// Explicit options override a preset, and an explicit preset overrides the scene's options.

#include "files/appearance/PresetReader.h"
#include "files/segments/SegmentationReader.h"
#include "scene/Input.h"

#include <functional>
#include <string>
#include <vector>

namespace fenestra::core {

/// Segments that match the preset's name patterns or codes, in the order of `segments`.
std::vector<SegmentInfo> findFocusSegments(const SegmentPatterns& patterns,
                                           const std::vector<SegmentInfo>& segments);

/// Joins at most 12 names for a message: "liver, left lung, …".
std::string joinSegmentNames(const std::vector<SegmentInfo>& segments);

/// Finds the preset of `presets` whose focus is among the segments; if several match, among those
/// with voxels, which listNonEmpty() returns. A matching preset excludes the presets that it lists
/// in OrganPreset::before. If the remaining ones differ in modality, only
/// those with isSuitable(modality) count; it is not called otherwise. Throws Error (input), with
/// `source` as the segmentation's name, if none or several remain.
const OrganPreset& findMatchingPreset(const std::vector<OrganPreset>& presets,
                                      const std::vector<SegmentInfo>& segments,
                                      const std::string& source,
                                      const std::function<std::vector<SegmentInfo>()>& listNonEmpty,
                                      const std::function<bool(Modality)>& isSuitable);

struct ChosenPreset {
  OrganPreset preset;
  std::vector<std::string> focus; ///< selectors of its segments; empty without a segmentation
};

/// The preset with a name, of a file, or for "auto" the built-in one that suits the input. The
/// focus becomes choice.focus or, if that is empty, all segments that the preset knows. Throws
/// Error: request if "auto" finds no segmentation; input, also if the preset knows none of the
/// segments.
ChosenPreset chooseOrganPreset(const std::string& name, const Input& input,
                               const InputChoice& choice, const VolumeChoice& volume);

} // namespace fenestra::core
