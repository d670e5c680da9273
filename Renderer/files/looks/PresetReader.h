#pragma once
// Reads organ presets: flags and focus for an anatomy (Resources/presets/README.md).

#include "model/volume/Volume.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fenestra {

/// Patterns of the segments that are the focus.
struct FocusPatterns {
  /// Patterns of names. A name matches if consecutive words of it match the words of a pattern, in
  /// upper or lower case; `*` is any text in a word, `?` any character. Other signs, and changes to
  /// upper case, separate words.
  std::vector<std::string> names;
  std::vector<std::string> except = {}; ///< patterns of excluded names
  /// Terminology codes of a segment's type, like "SCT^39607008", or type~region, like
  /// "SCT^4147007~SCT^12738006".
  std::vector<std::string> codes = {};
};

struct OrganPreset {
  std::string name; ///< file name without extension
  std::string title;
  Modality modality;
  FocusPatterns focus;
  std::vector<std::string> before = {}; ///< presets that `auto` passes over where this one fits
  /// Flags of the command line and their values, sorted by name.
  std::vector<std::pair<std::string, std::string>> flags = {};
  std::string tested = {}; ///< data on which the preset was tried
};

/// Reads a preset from JSON text. `source`, a path, names the text in messages, and its stem the
/// preset. Throws Error (input) that names source and field.
OrganPreset parsePreset(std::string_view json, const std::string& source);

/// True if a segment's name matches one of FocusPatterns::names.
bool matchesName(std::string_view pattern, std::string_view name);

} // namespace fenestra
