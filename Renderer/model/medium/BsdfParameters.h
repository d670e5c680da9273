#pragma once
// Scattering parameters except the albedo, for ScatteringFormulas-inl.h.

#include "model/medium/TransferFunction.h"

#include <array>

namespace fenestra::core {

/// `Number`: a plain number, or one per SIMD lane.
template <typename Number>
struct BsdfParameters {
  Number g;
  Number diffuse, specular, f0, oddsFactor, roughness; ///< as in SurfaceShading
  bool isCoated;
  std::array<Number, 4> coat; ///< CoatReflectance over the Lambert lobe; 0: reflects nothing

  template <typename To>
  BsdfParameters<To> cast() const {
    const auto number = [](Number x) { return static_cast<To>(x); };
    return {
        number(g),          number(diffuse),
        number(specular),   number(f0),
        number(oddsFactor), number(roughness),
        isCoated,           {number(coat[0]), number(coat[1]), number(coat[2]), number(coat[3])}};
  }
};

/// Without shading, the surface lobes reflect nothing.
BsdfParameters<double> makeBsdfParameters(double g, const std::optional<SurfaceShading>& shading);

} // namespace fenestra::core
