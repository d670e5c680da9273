#pragma once
// Reads organ presets: flags and focus for an anatomy (Resources/presets/README.md).

#include "files/appearance/SegmentPatterns.h"
#include "model/volume/Volume.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fenestra {

struct OrganPreset {
  std::string name; ///< file name without extension
  std::string title;
  Modality modality;
  SegmentPatterns focus;                ///< segments that are the focus
  std::vector<std::string> before = {}; ///< presets that `auto` passes over where this one fits
  /// Flags of the command line and their values, sorted by name.
  std::vector<std::pair<std::string, std::string>> options = {};
  std::string tested = {}; ///< data on which the preset was tried
};

/// Reads a preset from JSON text. `source`, a path, names the text in messages, and its stem the
/// preset. Throws Error (input) that names source and field.
OrganPreset parsePreset(std::string_view json, const std::string& source);

} // namespace fenestra
