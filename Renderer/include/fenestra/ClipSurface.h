#pragma once

#include "fenestra/Types.h"

#include <string>
#include <vector>

namespace fenestra {
inline namespace v1 {

/// Clipping surface as triangles.
struct FENESTRA_EXPORT ClipSurface {
  std::vector<Vector3> points; ///< RAS mm
  std::vector<float> depths;   ///< of each point, along the viewing direction, mm
  /// Indices of points, counterclockwise as seen from the camera.
  std::vector<std::array<std::uint32_t, 3>> triangles;

  /// Writes a .vtp, .ply or .stl. Throws Error (request, output).
  void save(const std::string& path) const;
};

} // namespace v1
} // namespace fenestra
