#pragma once
// Which segments an organ preset means, and which preset segments mean.

#include "files/looks/PresetReader.h"
#include "files/segments/SegmentationReader.h"

#include <functional>
#include <string>
#include <vector>

namespace fenestra {

/// Those of the segments that the preset's patterns or codes name, in their order.
std::vector<SegmentInfo> focusOf(const FocusPatterns& patterns,
                                 const std::vector<SegmentInfo>& segments);

/// "liver, left lung, …": enough of them for a message.
std::string listedNames(const std::vector<SegmentInfo>& segments);

/// The one of `presets` that fits the segments: it finds a focus among them, and none that fits,
/// too, comes before it. Of several whose modalities differ, those count for which `suits` says so;
/// it is asked only then. Throws Error (input), with `source` for the segmentation, where none fits
/// or several do.
const OrganPreset& fittingPreset(const std::vector<OrganPreset>& presets,
                                 const std::vector<SegmentInfo>& segments,
                                 const std::string& source,
                                 const std::function<bool(Modality)>& suits);

} // namespace fenestra
