#pragma once
// Who is looked at, and the clipping surface of them.

#include "BoundaryMeasure.h"

#include <filesystem>
#include <string>

namespace fenestra::accuracy {

struct Subject {
  std::string name;
  std::filesystem::path input;    ///< what is rendered
  std::filesystem::path labelmap; ///< on the volume's grid
  std::string focus;              ///< as --focus has it
  int label;                      ///< in the labelmap
  double smoothing = 0.0;         ///< of the labels, mm, as --labelsmoothing has it
  double elevation = 0.0;         ///< degrees above the horizon from which it is seen
};

/// The knee that `fenestra phantom` makes, in a folder; `size` in voxels as its flag has it, or "".
Subject makeKnee(const std::filesystem::path& folder, const std::string& size);

/// Of smoothed labels this is what the renderer has made of them: how it smooths is not the
/// question here.
Indicator readIndicator(const Subject& subject);

/// One of `count` views around the patient's superior axis, of the whole focus; the first is from
/// the front. `elevation` in degrees.
View viewAround(const FocusField& field, int number, int count, int size, double elevation = 0.0);

/// The clipping surface of `--clip surface --boundary …`, whose depth (mm from the eye's plane) is
/// a function of raster positions: what is to be checked.
Surface clippingSurface(const Subject& subject, const View& view, const std::string& boundary);

/// A picture of everything opaque, clipped: depth of what is seen at each pixel, mm, row by row
/// from the top. Written to a folder on the way. Of an orthographic view, of a subject that is a
/// Slicer scene.
std::vector<float> depthsInPicture(const Subject& subject, const View& view,
                                   const std::string& boundary,
                                   const std::filesystem::path& folder);

} // namespace fenestra::accuracy
