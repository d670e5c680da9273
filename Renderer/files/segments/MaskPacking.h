#pragma once
// One segmentation of many masks, which may overlap and have different grids.

#include "files/segments/MaskRuns.h"
#include "files/segments/SegmentationReader.h"

#include <string>
#include <vector>

namespace fenestra::core {

struct NamedMask {
  SegmentInfo info;
  MaskRuns mask;
};

/// Makes one segmentation of at least one mask. Masks of equal grid that do not overlap form one
/// label map; others are cropped. `source`: file name in messages.
Segmentation packMasks(const std::string& source, std::vector<NamedMask> masks);

} // namespace fenestra::core
