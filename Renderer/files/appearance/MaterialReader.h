#pragma once
// Reads tables of materials with the rules that assign them to segments, and the changes to single
// segments that --material gives. Resources/materials/README.md describes the file.
//
// Rules choose by terminology code, label value or name. Layers below the scene layer receive none
// of these, only one SegmentMedium per segment. The built-in library uses the user's file format.

#include "files/appearance/SegmentPatterns.h"
#include "model/medium/Material.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra::core {

/// Assigns a material to the segments that match by label value, code, category or name.
struct MaterialRule {
  SegmentPatterns patterns;
  std::string category;             ///< code of a segment's category; empty: any
  std::vector<std::int32_t> values; ///< label values
  std::string material;             ///< name in MaterialTable::materials
  int priority = 10;                ///< the higher of two rules that match by name wins
  bool isClipped = true;
  double density = 1.0;
  bool isFromFile = false; ///< from the file itself, not from the table that it extends
};

/// Color adjustment of the context; not set: unspecified.
struct ContextColors {
  std::optional<double> saturation = {}; ///< 0: gray, 1: unchanged
  std::optional<double> lightness = {};  ///< 0: unchanged, 1: white
};

struct MaterialTable {
  std::map<std::string, Material> materials;
  std::vector<MaterialRule> rules; ///< among equal matches the first wins
  std::string rest;                ///< material outside all segments; empty: the volume's own
  ContextColors context;
  bool hasContrast = false; ///< colors are adjusted so that the focus is distinguishable
  bool detectsSkin = false; ///< unsegmented tissue in the body's outer millimeters is skin
};

/// Parses a table that extends the table `base`: its materials replace those of the same name, and
/// its rules come first. `source` identifies the text in messages. Throws Error (input) that states
/// source and field.
MaterialTable parseMaterials(std::string_view json, const std::string& source,
                             const MaterialTable& base = {});

/// Change to the material of one segment.
struct MaterialChange {
  std::string selector;  ///< id, name or label value, as for --focus
  nlohmann::json fields; ///< members of a material or of a rule
};

/// Parses "Liver: color=#963e2e, density=2, clip=no"; the text before the last colon selects the
/// segment. Throws Error (input), also for fields that parseMaterials would reject.
MaterialChange parseMaterialChange(const std::string& text, const MaterialTable& table);

/// Applies a change: first its "material", then the single members. Throws Error (input) if members
/// contradict those of `medium`.
SegmentMedium applyChange(const SegmentMedium& medium, const MaterialChange& change,
                          const MaterialTable& table);

} // namespace fenestra::core
