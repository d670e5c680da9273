#pragma once
// Reads lights, and the environment maps that they reference.

#include "model/lights/Light.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra::core {

/// Reads a lights `.json`. Throws Error (input). The `file` of an environment is relative to the
/// folder of the JSON file; its `radiance`, if present, scales the map.
std::vector<Light> readLights(const std::filesystem::path& path);

/// Parses lights from JSON text. `source` identifies the text in messages. The `file` of an
/// environment is relative to `folder`, by default the working directory.
std::vector<Light> parseLights(std::string_view json, const std::string& source,
                               const std::filesystem::path& folder = {});

/// True if a lights JSON text references a file.
bool hasFileReference(std::string_view json, const std::string& source);

/// Reads R, G, B of a latitude-longitude EXR. Throws Error (input), also for values outside
/// [0, 1e12].
EnvironmentMap readEnvironmentMap(const std::filesystem::path& path);

} // namespace fenestra::core
