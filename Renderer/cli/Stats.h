#pragma once
// The stats file: what a render did and how long each stage took.

#include "scene/Scene.h"

#include <filesystem>
#include <optional>
#include <string>

namespace fenestra {

struct RenderStats {
  StageSeconds stages;
  double transport = 0.0, write = 0.0, total = 0.0; ///< wall-clock seconds
  std::optional<double> focusCoverage = {};
  std::optional<BoundaryMismatch> mismatch = {};
  std::vector<std::string> warnings = {};
};

/// JSON text with the contract's keys.
std::string statsJson(const RenderStats& stats, const RenderResult& result);

} // namespace fenestra
