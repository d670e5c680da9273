#pragma once
// Reads lights, and the environment maps that they name.

#include "model/lights/Light.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

/// A lights `.json` (design, section 3). Throws Error (input). An environment's `file` is relative
/// to the folder of the JSON; its `radiance`, if there, multiplies the map.
std::vector<Light> readLights(const std::filesystem::path& path);

/// The same from text; files are relative to the working directory. `source` names it in messages.
std::vector<Light> parseLights(std::string_view json, const std::string& source);

/// Whether the same names a file.
bool namesFiles(std::string_view json, const std::string& source);

/// R, G, B of an EXR, latitude-longitude. Throws Error (input), also where a value is not from 0 to
/// 1e12.
EnvironmentMap readEnvironmentMap(const std::filesystem::path& path);

} // namespace fenestra
