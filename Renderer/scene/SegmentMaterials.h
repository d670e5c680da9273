#pragma once
// Assigns a material to each segment by its codes, name, label value or color. Only this file
// applies rules; lower layers get one SegmentMedium per segment.

#include "files/appearance/MaterialReader.h"
#include "files/segments/SegmentationReader.h"

#include <string>
#include <vector>

namespace fenestra::core {

struct SegmentMaterial {
  SegmentMedium medium = {};
  std::string name = {}; ///< of the material; empty: only a color, none of the table's materials
  /// Reason: "by SCT^10200004", "by name 'liver'", "by value 5", "by its own color", "by palette".
  std::string reason = {};
  bool isFromPalette = false; ///< the segment matches no rule and has no color of its own
};

/// Built-in materials and rules (Resources/materials), written in the user's file format.
const MaterialTable& materialLibrary();

/// Assigns materials to the segments, in their order. Rules of the user's file precede all others.
/// Among equals, the first match wins of
///   1. the label value of the segment,
///   2. its terminology: type and region, type, category, region,
///   3. its name; of several rules, the one with the highest priority, then the first.
/// A rule is skipped if the name matches its exceptions. A segment without a rule gets a tint of
/// its own color, unless that is Slicer's default gray; else a color of a palette in which the
/// first 20 are distinguishable.
std::vector<SegmentMaterial> assignMaterials(const std::vector<SegmentInfo>& segments,
                                             const MaterialTable& table);

/// True if at least one segment has a rule in the library or a color of its own. `selectors`: ids,
/// names or label values. Throws Error (input) for one that does not exist.
bool hasKnownMaterial(const Segmentation& segmentation, const std::vector<std::string>& selectors);

} // namespace fenestra::core
