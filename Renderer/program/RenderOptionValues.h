#pragma once

#include "program/RenderOptions.h"

#include <optional>
#include <string>
#include <vector>

/// Values of render options that have a syntax of their own. Each function reads the value of
/// option `name` from `values` into its last argument, and throws a usage error if it is invalid.

namespace fenestra::core {

void readMargins(const OptionValues& values, const std::string& name, FocusRequest& focus);
void readVolumeSmoothing(const OptionValues& values, const std::string& name,
                         SmoothingRequest& smoothing);
void readPlane(const OptionValues& values, const std::string& name,
               std::optional<PlaneRequest>& plane);
void readEnvironment(const OptionValues& values, const std::string& name, RenderRequest& scene);
void readBackground(const OptionValues& values, const std::string& name,
                    std::optional<Background>& background);
void readAnnotations(const OptionValues& values, const std::string& name, Annotations& annotations);
void readSpacing(const OptionValues& values, const std::string& name, std::optional<Vec3>& spacing);
void readSize(const OptionValues& values, const std::string& name, RenderRequest& scene);
void readShard(const OptionValues& values, const std::string& name, RenderOptions& options);
void readTexts(const OptionValues& values, const std::string& name,
               std::vector<std::string>& texts);
void readWord(const OptionValues& values, const std::string& name,
              std::optional<std::string>& word);
void readSwitch(const OptionValues&, const std::string&, bool& isOn);
void readLayers(const OptionValues& values, const std::string& name, LayerSet& layers);

} // namespace fenestra::core
