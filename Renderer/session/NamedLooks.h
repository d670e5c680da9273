#pragma once
// Looks by name: presets that travel with the program, files, nodes of a Slicer scene, and the
// presets of a 3D Slicer that is there.

#include "files/looks/PresetReader.h"
#include "files/looks/TransferReader.h"
#include "model/lights/Light.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fenestra {

/// Names of the program's own: `kind` is a folder of Resources, as "transfer".
std::vector<std::string> ownPresets(const std::string& kind);

/// Whether a name means a file and no preset: it has a folder or an ending, or is there.
bool isFileName(const std::string& kind, const std::string& name);

struct NamedTransfer {
  TransferLook look;
  std::string file = {}; ///< that was read, where it is one of its own
};
/// The JSON itself, else the program's preset of that name, a file, a volume property of the scene
/// `input` (by name or id), or one of Slicer's presets. Throws Error (input), which lists the names
/// that there are.
NamedTransfer namedTransfer(const std::string& name, const std::filesystem::path& input);

/// Whether namedTransfer would open a file of the name.
bool isFileOfTransfer(const std::string& name, const std::filesystem::path& input);

struct NamedLights {
  std::vector<Light> lights;
  std::string file = {}; ///< that was read
};
/// The JSON itself, else the program's preset of that name, or a file. Throws Error (input).
NamedLights namedLights(const std::string& name);

/// Whether namedLights would open a file: of the name, or one that the JSON names.
bool isFileOfLights(const std::string& name);

/// An organ preset of the program, or a file. Throws Error (input).
OrganPreset namedPreset(const std::string& name);

} // namespace fenestra
