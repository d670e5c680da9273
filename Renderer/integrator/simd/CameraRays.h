#pragma once
// Start of paths on camera rays: SIMD version of integrator/scalar/CameraRays.h, in float. Highway
// selects the instruction set at run time.

#include "integrator/scalar/CameraRays.h"
#include "integrator/simd/PathBatch.h"

namespace fenestra::core {

/// Camera rays as functions of the raster position relative to the image's center. Rays start in
/// the plane that faces the camera at the depth of the domain's nearest corner (at the camera, if
/// that lies behind it). So floats keep their precision however far away the camera is.
struct CameraTable {
  using Triple = std::array<float, 3>;

  CameraTable(const Domain& domain, const Camera& camera);

  double nearDepth;              ///< of that plane, mm; PathBatch depths are relative to it
  float middleColumn, middleRow; ///< raster position of the image's center
  Triple point, pointPerColumn,
      pointPerRow; ///< on the plane, index space: at the center; per pixel
  Triple forward, forwardPerColumn,
      forwardPerRow;  ///< direction, world axes: at the center; per pixel
  AffineRows toIndex; ///< maps world directions to index space
};

/// Appends one path per camera sample to `paths`. Changes rows and columns of `samples` to raster
/// positions relative to the image's center.
void beginPaths(const SimdMedium& medium, const CameraTable& table, const CameraRays& cameraRays,
                CameraSamples& samples, PathBatch& paths);

} // namespace fenestra::core
