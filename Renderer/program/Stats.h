#pragma once
// Statistics of a render: counts, measures, and the time of each stage.

#include "program/RenderFlags.h"
#include "session/Measures.h"

namespace fenestra {

/// Facts of a render beside its scene and its result.
struct RenderStats {
  double transport = 0.0, measure = 0.0, write = 0.0, total = 0.0; ///< wall-clock seconds
  std::optional<FocusReport> focus = {};
  std::vector<std::string> warnings = {}; ///< beside the scene's
};

/// Content of options.stats, which must be set, as JSON text. emptyPixels: certain from one sample,
/// and not in samplesPerPixel; cells: of the majorant grid; focusVoxels: of the cropped labelmap;
/// controlPoints: column and row in the picture. Measures of the clip: see BoundaryMeasures and
/// FocusReport. Names of files are relative to the statistics' folder.
std::string statsJson(const RenderStats& stats, const RenderOptions& options, const Scene& scene,
                      const RenderResult& result);

} // namespace fenestra
