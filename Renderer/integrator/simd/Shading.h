#pragma once
// Scatterers and lights in the form that lanes' events read, in float; beside SimdMedium.

#include "base/Narrow.h"
#include "integrator/simd/EnvironmentTables.h"
#include "integrator/simd/Mixture.h"
#include "integrator/simd/PiecewiseLinear.h"
#include "model/lights/LightSet.h"
#include "model/medium/BsdfParameters.h"
#include "model/medium/Tint.h"
#include "model/volume/Grid.h"

#include <vector>

namespace fenestra {

/// "Local" space: world axes, mm, origin at the volume's centre: floats keep their digits wherever
/// the volume lies.
struct SimdShading {
  /// True if floats suffice: no lobe narrower than the resolution of directions in float, and no
  /// light so far away or bright that squares overflow.
  static bool isSupported(const Grid& grid, const TransferFunction& transfer,
                          const LightSet& lights, const Mixture* mixture = nullptr);

  /// A view of environment maps and tint, which must outlive the object.
  SimdShading(const Grid& grid, const TransferFunction& transfer, const LightSet& lights,
              std::uint64_t maxBounces, bool normalsWanted, const Tint* tinted = nullptr,
              const Mixture* mixture = nullptr);

  std::vector<BsdfParameters<float>> bsdfs; ///< one; or of each component of a mixture
  std::vector<SimdTable> albedos;           ///< one; or of each component of a mixture or tint
  std::optional<SimdLabelWeights> tint;
  bool hybrid;       ///< surface shading
  float surfaceRate; ///< 25 gamma^3 of Medium's surface probability
  bool wantNormals;
  std::int32_t bounces; ///< greatest number of scatterings

  LightTables<float> lights; ///< local
  bool hasSampledLights;     ///< there are lights, or maps, to draw
  std::vector<EnvironmentTables> maps;

  AffineRows toLocal;      ///< points, from index space
  AffineRows localToIndex; ///< directions
  /// Map from differences over two voxels to gradients, in spans of the transfer function per mm.
  AffineRows indexDifferenceToGradient;
};

} // namespace fenestra
