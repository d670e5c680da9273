#pragma once
// Looks by name: presets compiled into the program, files, nodes of a Slicer scene, and the presets
// of an installed 3D Slicer.

#include "files/appearance/MaterialReader.h"
#include "files/appearance/PresetReader.h"
#include "files/appearance/TransferReader.h"
#include "model/lights/Light.h"
#include "scene/Input.h"

#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

/// True if `look` (lights or a transfer function) is JSON itself, not a name.
inline bool isInlineJson(std::string_view value) {
  return value.starts_with('{');
}

/// Names of the program's own presets. `kind`: a folder of Resources, e.g. "transfer".
std::vector<std::string> listBuiltinPresets(const std::string& kind);

/// True if `name` is no own preset, and has a folder or an ending, or is an existing file.
bool isFileName(const std::string& kind, const std::string& name);

struct NamedTransfer {
  TransferFile transfer;
  std::string source;                  ///< its name, or the flag for JSON
  std::vector<std::string> files = {}; ///< files read; empty: JSON or own preset
};
/// Transfer function from the JSON itself, else the program's preset of that name, a file, a volume
/// property of a scene (by name or id), or one of Slicer's presets. Throws Error (input)
/// that lists the known names.
NamedTransfer findTransfer(const std::string& name, const Input& input);

/// True if findTransfer would open a file of that name.
bool isTransferFile(const std::string& name, const Input& input);

struct NamedLights {
  std::vector<Light> lights;
  std::string source;                  ///< its name, or the flag for JSON
  std::vector<std::string> files = {}; ///< files read; empty: JSON or own preset
};
/// Lights from the JSON itself, else the program's preset of that name, or a file. Throws Error
/// (input).
NamedLights findLights(const std::string& name);

/// True if findLights would open a file: of that name, or named in the JSON.
bool isLightsFile(const std::string& name);

struct NamedMaterials {
  MaterialTable table;
  std::string source;                  ///< its name
  std::vector<std::string> files = {}; ///< files read; empty: the library alone

  /// True if focus and context get colours of their own (TintContrast.h).
  bool hasColorAdjustment() const {
    return table.hasContrast || table.context.saturation || table.context.lightness;
  }
};
/// Materials of the library ("auto": with contrast and skin), or of a file over it. Throws Error
/// (input).
NamedMaterials findMaterials(const std::string& name);

/// True if findMaterials would open a file of that name.
bool isMaterialsFile(const std::string& name);

/// Organ preset of the program, or from a file. Throws Error (input).
OrganPreset findOrganPreset(const std::string& name);

} // namespace fenestra
