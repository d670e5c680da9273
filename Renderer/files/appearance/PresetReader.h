#pragma once
// Reads organ presets: options and focus for an anatomy (Resources/README.md).

#include "files/appearance/SegmentPatterns.h"
#include "model/volume/Volume.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fenestra::core {

struct OrganPreset {
  std::string name; ///< file name without extension
  std::string title;
  Modality modality;
  SegmentPatterns focus;                ///< the segments that form the focus
  std::vector<std::string> before = {}; ///< presets that `auto` skips if this one matches
  /// Command line options and their values, sorted by name.
  std::vector<std::pair<std::string, std::string>> options = {};
  std::string tested = {}; ///< data on which the preset was tested
};

/// Parses a preset from JSON text. `source`, a path, identifies the text in messages; its stem is
/// the preset's name. Throws Error (input) that states source and field.
OrganPreset parsePreset(std::string_view json, const std::string& source);

} // namespace fenestra::core
