#pragma once
// Reads organ presets: what makes one command enough for an anatomy (Resources/presets/README.md).

#include "model/volume/Modality.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fenestra {

/// Which segments of a segmentation are the focus.
struct FocusPatterns {
  /// A segment's name matches where words of it that follow each other match those of a pattern:
  /// in any case, `*` any text in a word and `?` any character, other signs and changes of case
  /// between words alike.
  std::vector<std::string> names;
  std::vector<std::string> except = {}; ///< patterns of names that are not meant
  /// Terminology codes of what a segment is, "SCT^39607008"; "SCT^4147007~SCT^12738006" for that
  /// in a region.
  std::vector<std::string> codes = {};
};

struct OrganPreset {
  std::string name; ///< the file's, without its ending
  std::string title;
  Modality modality;
  FocusPatterns focus;
  std::vector<std::string> before = {}; ///< presets that are not meant where this one is
  /// Names and values of the command line, in their order by name.
  std::vector<std::pair<std::string, std::string>> flags = {};
  std::string tested = {}; ///< the data that it was looked at with
};

/// Throws Error (input) that names file and field.
OrganPreset readPreset(const std::filesystem::path& path);

/// The same from text. `source` names it in messages, and the preset.
OrganPreset parsePreset(std::string_view json, const std::string& source);

/// Whether a segment's name matches a pattern of FocusPatterns.
bool matchesName(std::string_view pattern, std::string_view name);

} // namespace fenestra
