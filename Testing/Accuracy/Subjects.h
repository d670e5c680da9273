#pragma once
// Subjects of the boundary check, and their clipping surfaces.

#include "BoundaryMeasure.h"
#include "scene/RenderRequest.h"

#include <filesystem>
#include <string>

namespace fenestra::core::accuracy {

struct Subject {
  std::string name;
  std::filesystem::path input;    ///< volume or scene to render
  std::filesystem::path labelmap; ///< on the volume's grid
  std::string focus;              ///< value of --focus
  int label;                      ///< label value of the focus
  double smoothing = 0.0;         ///< label smoothing, mm (--label-smoothing)
  double elevation = 0.0;         ///< elevation of the camera above the horizon, degrees
};

/// Writes the knee of `fenestra phantom` to a folder; `size` in voxels as in --size, or "".
Subject makeKnee(const std::filesystem::path& folder, const std::string& size);

/// Request of a surface without softness, with the paper's spline or the exact boundary.
RenderRequest makeRequest(const Subject& subject, const View& view, Boundary boundary);

/// Indicator of the subject's focus. Smoothed labels come from the renderer, since the check does
/// not test the smoothing.
Indicator readIndicator(const Subject& subject);

/// View `number` of `count` around the patient's superior axis, which frames the focus; number 0 is
/// anterior. `elevation` in degrees.
View makeView(const FocusField& field, int number, int count, int size, double elevation = 0.0);

/// The tested surface, of `--clip surface --clip-boundary …`: depth (mm from the camera plane) at a
/// raster position.
Surface makeSurface(const Subject& subject, const View& view, const std::string& boundary);

/// Renders a clipped image with an opaque volume to `folder`. Returns the depth of the visible
/// point in each pixel, mm, row by row from the top. Requires an orthographic view and a Slicer
/// scene.
std::vector<float> renderDepths(const Subject& subject, const View& view,
                                const std::string& boundary, const std::filesystem::path& folder);

} // namespace fenestra::core::accuracy
