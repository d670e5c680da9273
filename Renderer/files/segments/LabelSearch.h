#pragma once
// Choice of the names for a label map's values: the user's, those in the file, or a table beside
// it.

#include "files/segments/LabelNames.h"

#include <set>

namespace fenestra {

struct FoundNames {
  LabelNames names = {};                  ///< empty: values have no names
  std::string source = {};                ///< file, or table's name
  std::vector<std::string> warnings = {}; ///< each names the file
};

/// Names for the `values` (without 0) of the label map at `path`. `wanted`: a file, a compiled
/// table's name, or "totalsegmentator", whose version the label table in NIfTI's header
/// `extensions` decides. Otherwise that label table, a table with the label map's stem that names
/// all values, or a seg_labels.json that names exactly them; one that does not is told in a
/// warning. Throws Error (input, usage) for wanted names that there are not, or that name none of
/// the values.
FoundNames findLabelNames(const std::filesystem::path& path, const std::set<std::int32_t>& values,
                          const std::string& extensions,
                          const std::optional<std::string>& requested);

/// True if findLabelNames would look into the values: there is something to choose.
bool hasLabelNames(const std::filesystem::path& path, const std::string& extensions,
                   const std::optional<std::string>& requested);

} // namespace fenestra
