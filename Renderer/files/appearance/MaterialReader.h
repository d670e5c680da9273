#pragma once
// Reads materials and the rules that say which segments they are for (Resources/materials/README.md
// describes the file), and changes to one segment, as a command line gives them.

#include "files/appearance/SegmentPatterns.h"
#include "model/medium/Material.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

/// Material of the segments that match: by label value, code, category or name.
struct MaterialRule {
  SegmentPatterns patterns;
  std::string category;             ///< code of a segment's category; empty: any or none
  std::vector<std::int32_t> values; ///< of a label map
  std::string material;             ///< name in MaterialTable::materials
  int priority = 10;                ///< and of two rules for one name the greater is taken
  bool isClipped = true;
  double density = 1.0;
  bool isFromFile = false; ///< of the file itself, not of the table beneath
};

/// Colours of what is not focus; nothing: not said.
struct ContextColors {
  std::optional<double> saturation = {}; ///< 0: grey, 1: unchanged
  std::optional<double> lightness = {};  ///< share of the way to white, 0 to 1
};

struct MaterialTable {
  std::map<std::string, Material> materials;
  std::vector<MaterialRule> rules; ///< of equals the first is taken
  std::string rest;                ///< material of what is no segment; empty: the volume's own
  ContextColors context;
  bool hasContrast = false; ///< colours are changed until the focus is told from its neighbours
  bool detectsSkin = false; ///< what is no segment is skin in the outer millimetres of the body
};

/// Reads a table over the table `beneath`: its materials replace those of the same name, its rules
/// come first. `source` names the text in messages. Throws Error (input) that names source and
/// field.
MaterialTable parseMaterials(std::string_view json, const std::string& source,
                             const MaterialTable& base = {});

/// Change to the matter of one segment.
struct MaterialChange {
  std::string selector;  ///< id, name or label value, as for --focus
  nlohmann::json fields; ///< members of a material and of a rule
};

/// Parses "Liver: color=#963e2e, density=2, clip=no": what stands before the last colon selects a
/// segment. Throws Error (input) for fields that parseMaterials would not take, too.
MaterialChange parseMaterialChange(const std::string& text, const MaterialTable& table);

/// Matter with the change: first its "material", then single members. Throws Error (input), where
/// members contradict those of `matter`.
SegmentMedium applyChange(const SegmentMedium& medium, const MaterialChange& change,
                          const MaterialTable& table);

} // namespace fenestra
