#pragma once
// Finds the volume rendering presets of a 3D Slicer installation.

#include <filesystem>
#include <optional>

namespace fenestra::core {

/// Path of presets.xml, a scene of named volume properties. Looks in SLICER_HOME (which Slicer sets
/// for its child processes), then beside the first Slicer launcher in PATH. nullopt: not found.
std::optional<std::filesystem::path> findSlicerPresets();

} // namespace fenestra::core
