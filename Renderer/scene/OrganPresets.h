#pragma once
// Segments that an organ preset means, and the preset that fits segments.

#include "files/appearance/PresetReader.h"
#include "files/segments/SegmentationReader.h"

#include <functional>
#include <string>
#include <vector>

namespace fenestra {

/// Segments that the preset's patterns or codes name, in the order of `segments`.
std::vector<SegmentInfo> findFocusSegments(const SegmentPatterns& patterns,
                                           const std::vector<SegmentInfo>& segments);

/// Names for a message, at most 12: "liver, left lung, …".
std::string joinSegmentNames(const std::vector<SegmentInfo>& segments);

/// Preset of `presets` that finds a focus among the segments, unless another one that does comes
/// before it (OrganPreset::before). Several of different modalities: only presets with
/// suits(modality) count; `suits` is called in this case only. Throws Error (input), naming
/// `source` as the segmentation, if none or several remain.
const OrganPreset& findMatchingPreset(const std::vector<OrganPreset>& presets,
                                      const std::vector<SegmentInfo>& segments,
                                      const std::string& source,
                                      const std::function<bool(Modality)>& isSuitable);

} // namespace fenestra
