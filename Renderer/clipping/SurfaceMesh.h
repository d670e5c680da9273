#pragma once
// The clipping surface as triangles, for whoever looks at it from elsewhere.

#include "clipping/Clip.h"
#include "volume/Domain.h"

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

/// Points of a mesh, at most; the buffer's samples may be more.
inline constexpr std::int64_t mostSurfacePoints = std::int64_t{512} * 512;

/// The surface over the volume's projection, where it has a depth (in perspective: in front of the
/// eye): each point is a sample of the clip's buffer, where that sample's eye ray has its depth.
/// Every sample is a point, or every n-th of each row and column and the last. Empty where there
/// are no three samples to span a triangle.
SurfaceMesh surfaceMesh(const ClipDepth& clip, const Domain& volume);

} // namespace fenestra
