#pragma once
// Reads names for the values of a label map from common table formats.

#include "base/Vector.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra::core {

struct LabelName {
  std::string name;
  std::optional<Rgb> color = {}; ///< display-encoded, 0 to 1; nullopt: the table has no color
};

/// Names by label value; 0, the background, is left out.
using LabelNames = std::map<std::int32_t, LabelName>;

/// Reads a table; the extension selects its format:
///   .ctbl, .txt  "value name r g b a" per line, colors 0 to 255: Slicer's and FreeSurfer's; or as
///                .label, if a line ends with a name in quotes
///   .label       "value r g b a visible mesh "name"" per line: ITK-SNAP's
///   .json        {"5": "liver"}, {"liver": 5}, either of them as "labels" (dataset.json of nnU-Net
///                and Medical Segmentation Decathlon), or [{"label": 5, "name": "liver"}]
///   .csv, .tsv   columns "label" (or "value", "id", "index"), "name" and "color" (#rrggbb, or
///                color_r and the two after it, 0 to 255) if a first line names them, else the
///                first two columns; separated by commas or semicolons (.csv) or tabs (.tsv, as in
///                BIDS)
/// Skips empty lines and lines that begin with #. Throws Error (input) for another extension, a
/// malformed line or entry, two names for one value, and a table without names.
LabelNames readLabelNames(const std::filesystem::path& path);

/// Built-in table: totalsegmentator1 (104 classes), totalsegmentator2 (117), freesurfer (aseg and
/// Desikan-Killiany). nullopt: no such table.
std::optional<LabelNames> findBuiltInLabelNames(const std::string& name);
std::vector<std::string> listBuiltInLabelTables();

/// Parses the label table in a NIfTI header extension (Caret's XML, as TotalSegmentator and
/// Connectome Workbench write it); nullopt: the text has no such table. Throws Error (input) for a
/// damaged table; `source` names the file.
std::optional<LabelNames> parseLabelNamesXml(std::string_view xml, const std::string& source);

} // namespace fenestra::core
