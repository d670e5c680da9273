#pragma once
// Finds the names for a label map's values: in the table that the user requests, in the file
// itself, or in a table beside it.

#include "base/Error.h"
#include "files/segments/LabelNames.h"

#include <set>

namespace fenestra::core {

struct FoundNames {
  LabelNames names = {};   ///< empty: the values have no names
  std::string source = {}; ///< table: a file, or the name of a built-in one
  std::vector<Message> warnings = {};
};

/// The path without its last extension, and without both of ".nii.gz".
std::filesystem::path stripExtensions(const std::filesystem::path& path);

/// Finds names for the `values` (without 0) of the label map at `path`. `requested` is a file, a
/// built-in table, or "totalsegmentator", whose version follows from the label table in the NIfTI
/// header `extensions`. If nothing is requested, uses that label table, else a table with the label
/// map's stem that names all values, else a seg_labels.json that names exactly these values. A
/// single value without a name is called as the file. A table beside the label map that does not
/// match gives a warning, and so does a built-in table that contradicts the names in or beside the
/// label map. Throws Error (input, request) if the requested table does not exist or
/// names none of the values.
FoundNames findLabelNames(const std::filesystem::path& path, const std::set<std::int32_t>& values,
                          const std::string& extensions,
                          const std::optional<std::string>& requested);

} // namespace fenestra::core
