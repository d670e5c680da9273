#pragma once
// The volume rendering presets of a 3D Slicer installation.

#include <filesystem>
#include <optional>

namespace fenestra {

/// presets.xml, a scene of named volume properties, of the Slicer in SLICER_HOME (set by Slicer for
/// programs that it starts), else of the first Slicer launcher in PATH; nullopt: none.
std::optional<std::filesystem::path> findSlicerPresets();

} // namespace fenestra
