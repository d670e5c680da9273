#pragma once
// Stage that makes a segmentation of the lungs that it finds in a CT without labels.

#include "scene/Stages.h"

namespace fenestra::core {

/// Name of the transfer function that shows the inside of lungs.
inline constexpr const char* lungTransfer = "ct-lung";
/// Name of the segment of found lungs.
inline constexpr const char* lungSegment = "lungs";

struct FoundLungs {
  Handle<SegmentsInput> input = {};   ///< null: none were found
  double volume = 0.0;                ///< mm^3
  std::vector<Message> warnings = {}; ///< if none were found
};

/// True if the request shows the inside of lungs, but has no focus for which the body is clipped.
bool needsLungs(const RenderRequest& request);

FoundLungs findLungSegment(const VolumeHandle& volume);

} // namespace fenestra::core
