// Organ presets, with a name to match against their patterns.
#include "Harness.h"

#include "files/looks/PresetReader.h"

FENESTRA_FUZZ(Preset, input) {
  const fenestra::OrganPreset preset = fenestra::parsePreset(input, "preset.json");
  for (const std::string& pattern : preset.focus.names)
    if (!fenestra::matchesName(pattern, pattern) && pattern.find_first_of("*?") == pattern.npos &&
        fenestra::matchesName("*", pattern))
      throw std::logic_error("a name that is not itself");
}
