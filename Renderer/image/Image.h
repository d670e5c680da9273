#pragma once
// Finished image as named float planes, for writers, readers and `compare`.

#include "base/Vector.h"

#include <map>
#include <string>
#include <vector>

namespace fenestra::core {

/// One value per pixel, row 0 at the top.
using Plane = std::vector<float>;

/// Channels by their EXR names (R G B A Z clip.Z albedo.R … error.R … samples.N), each width *
/// height floats, row 0 at the top.
struct Image {
  int width = 0, height = 0;
  std::map<std::string, Plane> channels;
  std::map<std::string, std::string> header; ///< version, target, seed, samples, camera, command …

  const Plane* find(const std::string& name) const {
    const auto it = channels.find(name);
    return it == channels.end() ? nullptr : &it->second;
  }
};

/// Position of an image in the world, stored in NRRD files so that Slicer shows the image there.
struct ImagePlane {
  Vec3 topLeft = Vec3::Zero();     ///< center of the top-left pixel, RAS mm
  Vec3 columnStep = Vec3::UnitX(); ///< to the next pixel to the right, mm
  Vec3 rowStep = -Vec3::UnitZ();   ///< to the next pixel below, mm
};

} // namespace fenestra::core
