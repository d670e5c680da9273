#pragma once
// The stats file: what a render did and how long each stage took.

#include "session/Measures.h"

#include <filesystem>
#include <optional>
#include <string>

namespace fenestra {

struct RenderStats {
  StageSeconds stages;
  double transport = 0.0, measure = 0.0, write = 0.0, total = 0.0; ///< wall-clock seconds
  std::optional<FocusReport> focus = {};
  std::optional<BoundaryMismatch> mismatch = {};
  std::optional<BoundaryMeasures> boundary = {};
  std::vector<Vec2> controlPoints = {};         ///< of the spline: column and row in the picture
  std::size_t cells = 0, emptyCells = 0;        ///< of the majorant grid
  std::optional<std::int64_t> focusVoxels = {}; ///< of the labelmap, as far as it was kept
  std::vector<std::string> files = {};          ///< that were read
  std::vector<std::string> warnings = {};
  std::optional<std::string> preset = {}; ///< an organ preset's name
};

/// JSON text with the contract's keys, and counters that show what was left out: shadowRays,
/// gradients, emptyPixels (certain from one sample, and not in samplesPerPixel), cells,
/// focusVoxels, filesRead, preset. What the clip is worth, beside boundaryMismatchMm and
/// focusCoverage: boundaryGapMm, boundarySlopeJump, boundaryDepthJumps, focusKept,
/// focusCoverageUnclipped, focusLight, contextRemoved (BoundaryMeasures, FocusReport),
/// controlPoints.
std::string statsJson(const RenderStats& stats, const RenderResult& result);

} // namespace fenestra
