#pragma once
// Subjects of the boundary check, and their clipping surfaces.

#include "BoundaryMeasure.h"

#include <filesystem>
#include <string>

namespace fenestra::accuracy {

struct Subject {
  std::string name;
  std::filesystem::path input;    ///< volume or scene to render
  std::filesystem::path labelmap; ///< on the volume's grid
  std::string focus;              ///< value of --focus
  int label;                      ///< value of the focus in the labelmap
  double smoothing = 0.0;         ///< of the labels, mm (--labelsmoothing)
  double elevation = 0.0;         ///< elevation of the views above the horizon, degrees
};

/// Knee from `fenestra phantom`, written to a folder; `size` in voxels as in --size, or "".
Subject makeKnee(const std::filesystem::path& folder, const std::string& size);

/// Indicator of the subject's focus; for smoothed labels, the renderer's smoothed labels (the check
/// does not test the smoothing).
Indicator readIndicator(const Subject& subject);

/// View `number` of `count` around the patient's superior axis, framing the whole focus; number 0
/// is from the front. `elevation` in degrees.
View makeView(const FocusField& field, int number, int count, int size, double elevation = 0.0);

/// Clipping surface of `--clip surface --boundary …`, the subject of the check: depth (mm from the
/// eye's plane) at a raster position.
Surface clippingSurface(const Subject& subject, const View& view, const std::string& boundary);

/// Depth of the visible point at each pixel, mm, row by row from the top, in a clipped picture with
/// everything opaque. Writes the picture to `folder`. Requires an orthographic view and a Slicer
/// scene.
std::vector<float> renderDepths(const Subject& subject, const View& view,
                                const std::string& boundary, const std::filesystem::path& folder);

} // namespace fenestra::accuracy
