#pragma once
// Stats file of a render: counts, measures, and the time of each stage.

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
  std::vector<Vec2> controlPoints = {};         ///< spline's; column and row in the picture
  std::size_t cells = 0, emptyCells = 0;        ///< majorant grid's
  std::optional<std::int64_t> focusVoxels = {}; ///< voxels of the cropped labelmap
  std::vector<std::string> files = {};          ///< files read
  std::vector<std::string> warnings = {};
  std::optional<std::string> preset = {}; ///< organ preset's name
};

/// JSON text with the contract's keys, and counters of work done and left out: shadowRays,
/// gradients, emptyPixels (certain from one sample; not in samplesPerPixel), cells, focusVoxels,
/// filesRead, preset. Measures of the clip, beside boundaryMismatchMm and focusCoverage:
/// boundaryGapMm, boundarySlopeJump, boundaryDepthJumps, focusKept, focusCoverageUnclipped,
/// focusLight, contextRemoved (BoundaryMeasures, FocusReport), controlPoints.
std::string statsJson(const RenderStats& stats, const RenderResult& result);

} // namespace fenestra
