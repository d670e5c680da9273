#pragma once
// Render modes that the benchmark compares.

#include "integrator/render/Render.h"

#include <span>
#include <string>

namespace fenestra::core::benchmarks {

struct Mode {
  const char* name;
  /// Renders with the samples and seed of the settings; other limits are ignored.
  Film (*render)(const SceneView& scene, RenderSettings settings);
};

/// All modes. Add new ones to the table in Modes.cxx.
std::span<const Mode> modes();

/// Throws Error (usage) for an unknown name.
const Mode& findMode(const std::string& name);

} // namespace fenestra::core::benchmarks
