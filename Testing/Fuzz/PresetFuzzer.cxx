// Organ presets. A name pattern without wildcards must match its own text.
#include "Harness.h"

#include "base/Text.h"
#include "files/appearance/PresetReader.h"

FENESTRA_FUZZ(Preset, input) {
  const fenestra::core::OrganPreset preset = fenestra::core::parsePreset(input, "preset.json");
  for (const fenestra::core::NamePattern& pattern : preset.focus.names)
    if (!pattern.matches(fenestra::core::splitName(pattern.text)) && !pattern.words.empty() &&
        pattern.text.find_first_of("*?") == pattern.text.npos)
      throw std::logic_error("a name does not match itself");
}
