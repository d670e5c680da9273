#pragma once
// Names for the values of a label map, from tables that people have.

#include "base/Vector.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

struct LabelName {
  std::string name;
  std::optional<Rgb> color = {}; ///< display-encoded, 0 to 1; nullopt: the table has none
};

/// Names by value, without 0, which is the background.
using LabelNames = std::map<std::int32_t, LabelName>;

/// Reads a table, known by its extension:
///   .ctbl, .txt  "value name r g b a" a line, colours 0 to 255: Slicer's and FreeSurfer's
///   .label       "value r g b a visible mesh "name"" a line: ITK-SNAP's
///   .json        {"5": "liver"}, or [{"label": 5, "name": "liver"}]
///   .csv         columns "label" (or "value", "id", "index") and "name", by a first line, else the
///                first two
/// Lines of white space and those that begin with # are skipped. Throws Error (input) for another
/// extension, a line or entry of another form, two names for one value, and a table without names.
LabelNames readLabelNames(const std::filesystem::path& path);

/// Table that is compiled in: totalsegmentator1 (104 classes), totalsegmentator2 (117), freesurfer
/// (aseg and Desikan-Killiany). nullopt: no such table.
std::optional<LabelNames> findBuiltInLabelNames(const std::string& name);
std::vector<std::string> listBuiltInLabelTables();

/// Names in the label table of a NIfTI header extension (Caret's XML, as TotalSegmentator and
/// Connectome Workbench write it); nullopt: the text has no such table. Throws Error (input) for a
/// damaged one; `source` names the file.
std::optional<LabelNames> parseLabelNamesXml(std::string_view xml, const std::string& source);

} // namespace fenestra
