#pragma once
// Eye rays in SIMD lanes, in float (readable/CameraRays.h): where paths begin. The instruction set
// is chosen at run time (Highway).

#include "integrator/scalar/CameraRays.h"
#include "integrator/simd/PathBatch.h"

namespace fenestra {

/// Eye rays as functions of the raster position, counted from the picture's middle: floats keep
/// their digits however far away the eye is, as rays begin in the plane that faces the eye at the
/// depth of the domain's nearest corner (at the eye, if that lies behind).
struct CameraTable {
  using Triple = std::array<float, 3>;

  CameraTable(const Domain& domain, const Camera& camera);

  double nearDepth;              ///< of the plane, mm; PathBatch counts depths from here
  float middleColumn, middleRow; ///< of the picture
  Triple point, pointPerColumn,
      pointPerRow; ///< of the plane, index space: in the middle, and its change
  Triple forward, forwardPerColumn,
      forwardPerRow;  ///< direction, world axes: in the middle, and its change
  AffineRows toIndex; ///< of directions
};

/// Begins a path for each start, behind those of `paths`. Changes rows and columns of `starts` to
/// raster positions, counted from the picture's middle.
void beginPaths(const SimdMedium& medium, const CameraTable& table, const CameraRays& cameraRays,
                CameraSamples& samples, PathBatch& paths);

} // namespace fenestra
