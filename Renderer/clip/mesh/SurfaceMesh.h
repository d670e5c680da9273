#pragma once
// Surfaces as triangle meshes, for other views and other programs; the clipping surface as one.

#include "clip/field/Clip.h"
#include "model/volume/Domain.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fenestra::core {

struct SurfaceMesh {
  std::vector<Vec3> points;  ///< world mm
  std::vector<float> depths; ///< of each point, mm; empty: none
  /// Indices of points, counterclockwise as seen from the camera, or from outside a closed surface:
  /// normals point there.
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Tolerance for buildSurfaceMesh, mm: a tenth of a pixel on the plane through the target. The
/// samples resolve the surface to a pixel only, so no view of this resolution would show a smaller
/// error in depth. There is no option for it: larger images give finer meshes.
inline double surfaceTolerance(const Camera& camera) {
  return 0.1 * camera.pixelPitch();
}

/// Triangulates the surface over the volume's projection, where it has a depth (in perspective: in
/// front of the camera). Vertices are samples of the clip's buffer; every other sample is within
/// `tolerance`, mm along depth, of the mesh. The mesh has no cracks: neighboring samples are
/// connected even across depth jumps, and only samples without a depth leave gaps. A cell with one
/// sample without a depth gives one triangle. Empty if no three samples span a triangle.
SurfaceMesh buildSurfaceMesh(const ClipDepth& clip, const Domain& volume, double tolerance);

} // namespace fenestra::core
