#pragma once
// Inputs of SIMD shading besides SimdMedium, in float: scattering, albedo, lights.

#include "base/Narrow.h"
#include "integrator/simd/EnvironmentTables.h"
#include "integrator/simd/Mixture.h"
#include "integrator/simd/PiecewiseLinear.h"
#include "model/lights/LightSet.h"
#include "model/medium/Scattering.h"
#include "model/medium/Tint.h"
#include "model/volume/Grid.h"

#include <vector>

namespace fenestra::core {

/// "Local" space has world axes, mm, and its origin at the volume's center, so that floats keep
/// their precision wherever the volume lies.
struct SimdShading {
  /// True if float precision suffices: no lobe is narrower than the resolution of directions, and
  /// no light is so far away or so bright that squares overflow.
  static bool isSupported(const Grid& grid, const TransferFunction& transfer,
                          const LightSet& lights, const Mixture* mixture = nullptr);

  /// Non-owning: environment maps and tint must outlive the object.
  SimdShading(const Grid& grid, const TransferFunction& transfer, const LightSet& lights,
              std::uint64_t maxBounces, bool normalsWanted, const Tint* tinted = nullptr,
              const Mixture* mixture = nullptr);

  using BsdfNumbers = std::array<float, 10>; ///< of a Bsdf, in the order of its members
  std::vector<BsdfNumbers> bsdfs;            ///< one; or one per component of a mixture
  bool isCoated = false;                     ///< some Bsdf is
  std::vector<SimdTable> albedos;            ///< one; or one per component of a mixture or tint
  std::optional<SimdLabelWeights> tint;
  bool hybrid;       ///< surface shading is on
  float surfaceRate; ///< 25 gamma^3, of Medium's surface probability
  bool sobel;        ///< kind of the gradient (GradientKind)
  bool wantNormals;
  std::int32_t bounces; ///< maximum number of scatterings

  LightTables<float> lights; ///< in local space
  bool hasSampledLights;     ///< some light or map is sampled
  std::vector<EnvironmentTables> maps;

  AffineRows toLocal;      ///< points: from index space
  AffineRows localToIndex; ///< directions
  /// Maps differences across two voxels to gradients, in spans of the transfer function per mm.
  AffineRows indexDifferenceToGradient;
};

} // namespace fenestra::core
