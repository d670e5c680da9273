#pragma once
// The ways to render that are compared.

#include "transport/render/Render.h"

#include <span>
#include <string>

namespace fenestra::benchmarks {

struct Mode {
  const char* name;
  const char* description; ///< for the report, half a sentence
  /// Samples and seed of the settings count; nothing else stops it.
  Film (*render)(const RenderScene& scene, RenderSettings settings);
};

/// All of them, in the report's order. A new one is a line of this table (Modes.cxx).
std::span<const Mode> modes();

/// Throws Error (usage) for an unknown name.
const Mode& findMode(const std::string& name);

} // namespace fenestra::benchmarks
