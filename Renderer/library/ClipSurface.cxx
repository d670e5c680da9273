#include "fenestra/ClipSurface.h"

#include "clip/mesh/SurfaceWriter.h"
#include "library/Convert.h"

namespace fenestra {
inline namespace v1 {

void ClipSurface::save(const std::string& path) const {
  guard([&] {
    core::SurfaceMesh mesh{{}, depths, triangles};
    for (const Vector3& point : points)
      mesh.points.push_back(toVec3(point));
    core::Outputs outputs;
    core::declareSurface(path, outputs);
    core::writeSurface(mesh, path, outputs);
    outputs.commit();
  });
}

} // namespace v1
} // namespace fenestra
