#pragma once
// Eye rays in SIMD lanes, in float (readable/EyeRays.h): where paths begin. The instruction set is
// chosen at run time (Highway).

#include "transport/lanes/PathBatch.h"
#include "transport/readable/EyeRays.h"

namespace fenestra {

/// Eye rays as functions of the raster position, counted from the picture's middle: floats keep
/// their digits however far away the eye is, as rays begin in the plane that faces the eye at the
/// depth of the domain's nearest corner (at the eye, if that lies behind).
struct EyeTable {
  using Triple = std::array<float, 3>;

  EyeTable(const Domain& domain, const Camera& camera);

  double nearDepth;                    ///< of the plane, mm
  float middleColumn, middleRow;       ///< of the picture
  Triple point, perColumn, perRow;     ///< of the plane, index space: in the middle, and its change
  Triple forward, turnColumn, turnRow; ///< direction, world axes: in the middle, and its change
  AffineRows toIndex;                  ///< of directions
};

class WideEyeRays {
public:
  /// A view of `volume` and `eye`.
  WideEyeRays(const WideScene& volume, const Domain& domain, const Camera& camera,
              const EyeRays& eye)
      : m_volume(volume), m_eye(eye), m_table(domain, camera) {}

  /// PathBatch counts depths from here, mm.
  double nearDepth() const { return m_table.nearDepth; }

  /// Begins a path for each start, behind those of `paths`. Changes rows and columns of `starts` to
  /// raster positions, counted from the picture's middle.
  void begin(PathStarts& starts, PathBatch& paths) const;

private:
  const WideScene& m_volume;
  const EyeRays& m_eye;
  EyeTable m_table;
};

} // namespace fenestra
