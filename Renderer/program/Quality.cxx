#include "program/Quality.h"

#include <algorithm>

namespace fenestra::core {
namespace {

struct Level {
  const char* name;
  const char* samples;
  const char* noise; ///< null: not limited
};

constexpr Level levels[] = {{"draft", "16", nullptr},
                            {"normal", "256", "0.05"},
                            {"high", "1024", "0.025"},
                            {"final", "4096", "0.015"}};

constexpr const char* stopOptions[] = {"samples", "seconds", "noise"};

} // namespace

std::vector<std::string> listQualityNames() {
  std::vector<std::string> names;
  for (const Level& level : levels)
    names.emplace_back(level.name);
  return names;
}

std::string describeQuality() {
  const auto describe = [](const Level& level) {
    return concat(level.name, " (--samples ", level.samples,
                  level.noise ? concat(" --noise ", level.noise) : "", ")");
  };
  return concat("Stops the render at a level of quality: ", join(levels, ", ", describe),
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
  for (const Level& level : levels)
    if (name == level.name) {
      expanded.add("samples", level.samples);
      if (level.noise)
        expanded.add("noise", level.noise);
    }
  return expanded;
}

void removeQualityOptions(OptionValues& values) {
  for (const char* option : stopOptions)
    values.remove(option);
}

} // namespace fenestra::core
