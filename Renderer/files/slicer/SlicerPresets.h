#pragma once
// The volume rendering presets of a 3D Slicer installation, by name.

#include "files/slicer/MrmlDocument.h"
#include "model/medium/TransferFunction.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fenestra {

/// presets.xml of the Slicer in SLICER_HOME (set by Slicer for programs that it starts), else of
/// the first Slicer launcher in PATH; nullopt: none.
std::optional<std::filesystem::path> findSlicerPresets();

/// Slicer's presets: volume property nodes in a MRML file.
class SlicerPresets {
public:
  /// Throws Error (input).
  explicit SlicerPresets(const std::filesystem::path& path);

  /// Preset of this name; nullopt: none. Throws Error (input) where the preset is damaged.
  std::optional<TransferFunction> find(const std::string& name) const;
  std::vector<std::string> names() const;

private:
  MrmlDocument m_document;
};

} // namespace fenestra
