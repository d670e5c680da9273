#pragma once
// Contact sheet: many pictures on one, with their names.

#include "image/Image.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace fenestra {

struct SheetEntry {
  std::string name;
  std::vector<std::string> lines = {}; ///< below the name
  std::filesystem::path image = {};    ///< .png or .tif; empty: none
  std::string problem = {};            ///< why there is no picture, or what is wrong with it
};

/// Most entries that are worth one sheet.
inline constexpr std::size_t maxSheetEntries = 36;

/// Sheet in linear Rec. 709, channels R, G, B: title, subtitle, and the entries in their order, row
/// by row, in at most `maxColumns` columns, each picture scaled into the same box. A picture that
/// cannot be read is a problem of its entry. At most 2200 pixels wide.
Image makeContactSheet(const std::string& title, const std::string& subtitle,
                       std::span<const SheetEntry> entries, int maxColumns = 6);

} // namespace fenestra
