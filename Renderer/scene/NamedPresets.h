#pragma once
// Look-up of transfer functions, lights, materials and organ presets by name: built-in presets,
// files, nodes of a Slicer scene, and the presets of an installed 3D Slicer.

#include "files/appearance/MaterialReader.h"
#include "files/appearance/PresetReader.h"
#include "files/appearance/TransferReader.h"
#include "model/lights/Light.h"
#include "scene/Input.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra::core {

/// True if the option value is inline JSON (lights or a transfer function) instead of a name.
inline bool isInlineJson(std::string_view value) {
  return value.starts_with('{');
}

/// Names of the built-in presets. `kind`: a folder of Resources, such as "transfer".
std::vector<std::string> listBuiltinPresets(const std::string& kind);

/// True if `name` is no built-in preset and is an existing file, or contains a slash or a dot.
bool isFileName(const std::string& kind, const std::string& name);

struct NamedTransfer {
  TransferFile transfer;
  std::string source;                  ///< the name, or the option if it was inline JSON
  std::vector<std::string> files = {}; ///< files read; empty for inline JSON and built-in presets
};
/// Finds a transfer function: inline JSON, a built-in preset, a file, a volume property of the
/// scene (by name or id), or one of Slicer's presets, in this order. Throws Error (input), which
/// lists the known names.
NamedTransfer findTransfer(const std::string& name, const Input& input);

/// True if findTransfer would open a file with this name.
bool isTransferFile(const std::string& name, const Input& input);

struct NamedLights {
  std::vector<Light> lights;
  std::string source;                  ///< the name, or the option if it was inline JSON
  std::vector<std::string> files = {}; ///< files read; empty for inline JSON and built-in presets
};
/// Finds lights: inline JSON, a built-in preset, or a file, in this order. Throws Error (input).
NamedLights findLights(const std::string& name);

/// True if findLights would open a file: with this name, or one that the inline JSON names.
bool isLightsFile(const std::string& name);

struct NamedMaterials {
  MaterialTable table;
  std::string source;                  ///< the name
  std::vector<std::string> files = {}; ///< files read; empty: only the library

  /// True if the colors of focus and context are adjusted for contrast (TintContrast.h).
  bool hasColorAdjustment() const {
    return table.hasContrast || table.context.saturation || table.context.lightness;
  }
};
/// Materials of the library ("contrast": with contrast adjustment and skin detection), or of a file
/// whose rules precede the library's. `contextSaturation`: replaces that of the materials. Throws
/// Error (input).
NamedMaterials findMaterials(const std::string& name,
                             const std::optional<double>& contextSaturation = {});

/// True if findMaterials would open a file with this name.
bool isMaterialsFile(const std::string& name);

/// Organ preset: built-in or from a file. Throws Error (input).
OrganPreset findOrganPreset(const std::string& name);

} // namespace fenestra::core
