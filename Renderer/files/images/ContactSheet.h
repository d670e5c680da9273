#pragma once
// Contact sheet: one image of captioned thumbnails.

#include "image/Image.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace fenestra::core {

struct SheetEntry {
  std::string name;
  std::vector<std::string> lines = {}; ///< caption below the name
  std::filesystem::path image = {};    ///< .png or .tif; empty: no image
  std::string problem = {};            ///< why the image is missing, or a warning about it
};

/// Maximum number of entries for one readable sheet.
inline constexpr std::size_t maxSheetEntries = 36;

/// Makes a sheet at most 2200 pixels wide, in linear Rec. 709 with channels R, G, B. It holds the
/// title, the subtitle, and the entries row by row in at most `maxColumns` columns. Every thumbnail
/// is scaled to fit the same box. An unreadable image becomes its entry's `problem`.
Image makeContactSheet(const std::string& title, const std::string& subtitle,
                       std::span<const SheetEntry> entries, int maxColumns = 6);

} // namespace fenestra::core
