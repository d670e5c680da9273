#include "program/Quality.h"

#include "scene/QualityLevels.h"

#include <algorithm>

namespace fenestra::core {
namespace {

constexpr const char* stopOptions[] = {"samples", "seconds", "noise"};

} // namespace

std::vector<std::string> listQualityNames() {
  std::vector<std::string> names;
  for (const QualityLevel& level : qualityLevels)
    names.emplace_back(level.name);
  return names;
}

std::string describeQuality() {
  const auto describe = [](const QualityLevel& level) {
    return concat(level.name, " (--samples ", level.samples,
                  level.noise > 0.0 ? concat(" --noise ", toString(level.noise)) : "", ")");
  };
  return concat("Stops the render at a level of quality: ", join(qualityLevels, ", ", describe),
                "; --samples, --noise or --seconds replaces all that it sets");
}

OptionValues expandQuality(const OptionValues& values) {
  OptionValues expanded = values;
  if (!values.has("quality"))
    return expanded;
  const std::string name = values.word("quality");
  expanded.remove("quality");
  if (std::ranges::any_of(stopOptions, [&](const char* option) { return values.has(option); }))
    return expanded;
  for (const QualityLevel& level : qualityLevels)
    if (name == level.name) {
      expanded.add("samples", concat(level.samples));
      if (level.noise > 0.0)
        expanded.add("noise", toString(level.noise));
    }
  return expanded;
}

void removeQualityOptions(OptionValues& values) {
  for (const char* option : stopOptions)
    values.remove(option);
}

} // namespace fenestra::core
