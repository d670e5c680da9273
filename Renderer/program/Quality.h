#pragma once
// --quality: levels that stand for options that stop the render.

#include "program/Options.h"

namespace fenestra::core {

std::vector<std::string> listQualityNames();
/// Help text: each level with its options.
std::string describeQuality();

/// Replaces --quality by the options that it stands for, or removes it if the values have one of
/// --samples, --seconds and --noise. Throws Error (usage) for an unknown level.
OptionValues expandQuality(const OptionValues& values);

/// Removes --samples, --seconds and --noise, which replace --quality.
void removeQualityOptions(OptionValues& values);

} // namespace fenestra::core
