#pragma once
// Clipping surface as triangles, for viewing from other directions.

#include "clip/field/Clip.h"
#include "model/volume/Domain.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fenestra {

struct SurfaceMesh {
  std::vector<Vec3> points;  ///< world mm
  std::vector<float> depths; ///< of each point, mm
  /// Indices of points, counter-clockwise as seen from the eye: normals point towards the eye.
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Tolerance for buildSurfaceMesh(), mm: a tenth of a pixel on the plane through the target. Across
/// the view the surface is known to a pixel only, so no picture of this resolution, from any side,
/// would show a smaller error in depth.
inline double surfaceTolerance(const Camera& camera) {
  return 0.1 * camera.pixelPitch();
}

/// Mesh of the surface over the volume's projection, as far as the surface has a depth (in
/// perspective: in front of the eye). Points are samples of the clip's buffer, at each sample's
/// depth on its eye ray; every other sample is within `tolerance`, mm along depth, of the mesh.
/// Triangles meet at whole edges, without cracks: neighbouring samples are joined however their
/// depths differ; only samples without a depth leave gaps. A cell between four samples, one of them
/// without a depth, gives one triangle. Empty if no three samples span a triangle.
SurfaceMesh buildSurfaceMesh(const ClipDepth& clip, const Domain& volume, double tolerance);

} // namespace fenestra
