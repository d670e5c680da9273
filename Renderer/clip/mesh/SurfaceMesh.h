#pragma once
// The clipping surface as triangles, for whoever looks at it from elsewhere.

#include "clip/keep/Clip.h"
#include "model/volume/Domain.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fenestra {

struct SurfaceMesh {
  std::vector<Vec3> points;  ///< world mm
  std::vector<float> depths; ///< of each point, mm
  /// Counter-clockwise as the eye sees them: their normals point towards it.
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A tenth of a pixel on the plane through the target, mm. Sideways the surface is known to a
/// pixel; so a mesh that is off by less in depth looks the same from any side in a picture as fine
/// as this one, and it is as good for a subject of 1 mm as for one of 1 m.
inline double surfaceTolerance(const Camera& camera) {
  return 0.1 * camera.pixelPitch();
}

/// The surface over the volume's projection, where it has a depth (in perspective: in front of the
/// eye). Its points are samples of the clip's buffer, where each sample's eye ray has its depth; of
/// those that are not, none is farther from the mesh than `tolerance` along depth, mm. Triangles
/// meet at whole edges, so that there are no cracks: neighbouring samples are joined however their
/// depths differ, and left apart by samples without a depth alone. A cell between four samples of
/// which one has no depth gives one triangle. Empty where there are no three samples to span one.
SurfaceMesh surfaceMesh(const ClipDepth& clip, const Domain& volume, double tolerance);

} // namespace fenestra
