#pragma once
// Matter of each segment, by what the segmentation says of it.

#include "files/appearance/MaterialReader.h"
#include "files/segments/SegmentationReader.h"

#include <string>
#include <vector>

namespace fenestra {

struct SegmentMaterial {
  SegmentMedium medium = {};
  std::string name = {}; ///< of the material; empty: none of the table's, but a colour
  /// Reason: "by SCT^10200004", "by name 'liver'", "by value 5", "by its own colour", "by palette".
  std::string reason = {};
  bool isFromPalette = false; ///< nothing is known of the segment
};

/// Materials and rules that are compiled in (Resources/materials).
const MaterialTable& materialLibrary();

/// Materials of the segments, in their order. A rule of the table's own file is taken before any
/// beneath it, and among those the first of
///   1. the segment's label value,
///   2. its terminology: type and region, type, category, region,
///   3. its name; of several rules that of the greatest priority, then the first.
/// A rule whose exceptions the name matches is passed over. A segment without a rule is tinted in
/// its own colour, if that is not Slicer's default grey; else in a colour of a palette, so that
/// no two of the first 20 look alike.
std::vector<SegmentMaterial> assignMaterials(const std::vector<SegmentInfo>& segments,
                                             const MaterialTable& table);

/// True if the library knows one of the segments, or it has a colour of its own. `selectors`: ids,
/// names or label values. Throws Error (input) for one that is not there.
bool isAnyKnown(const Segmentation& segmentation, const std::vector<std::string>& selectors);

} // namespace fenestra
