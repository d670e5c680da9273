#pragma once
// How matter scatters, beside its albedo, in the form that formulas read.

#include "model/medium/TransferFunction.h"

#include <array>

namespace fenestra {

/// `Number`: plain, or one a lane.
template <typename Number>
struct BsdfParameters {
  Number g;
  Number diffuse, specular, f0, oddsFactor, roughness; ///< of SurfaceShading
  bool isCoated;
  std::array<Number, 4> coat; ///< of CoatReflectance, over the Lambert lobe; 0: reflects nothing

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

/// Without shading nothing is reflected.
BsdfParameters<double> makeBsdfParameters(double g, const std::optional<SurfaceShading>& shading);

} // namespace fenestra
