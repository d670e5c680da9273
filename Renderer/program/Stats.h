#pragma once
// Statistics of a render: counts, measures, and the time of each stage.

#include "measure/FocusMeasures.h"
#include "program/RenderFlags.h"
#include "session/Scene.h"

namespace fenestra {

/// Facts of a render beside its scene and its result.
struct RenderStats {
  double transport = 0.0, measure = 0.0, write = 0.0, total = 0.0; ///< wall-clock seconds
  std::optional<FocusReport> focus = {};
  std::vector<std::string> warnings = {}; ///< beside the scene's
};

/// Content of options.stats, which must be set: JSON text with the contract's keys, and counters of
/// work done and left out: shadowRays, gradients, emptyPixels (certain from one sample; not in
/// samplesPerPixel), cells (of the majorant grid), focusVoxels (of the cropped labelmap),
/// filesRead, preset. Measures of the clip, beside boundaryMismatchMm and focusCoverage:
/// boundaryGapMm, boundarySlopeJump, boundaryDepthJumps, focusKept, focusCoverageUnclipped,
/// focusLight, contextRemoved (BoundaryMeasures, FocusReport), controlPoints (of a spline; column
/// and row in the picture). Names of files are relative to the statistics' folder.
std::string statsJson(const RenderStats& stats, const RenderOptions& options, const Scene& scene,
                      const RenderResult& result);

} // namespace fenestra
