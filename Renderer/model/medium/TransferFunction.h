#pragma once
// Optical properties as functions of the scalar. These functions *are* the medium: the product and
// every oracle read extinction and albedo from here.

#include "model/medium/PiecewiseLinear.h"

#include <optional>

namespace fenestra {

/// Surface lobes of hybrid shading: Lambert with the albedo and GGX with Schlick's F0 = 0.04.
struct SurfaceShading {
  double diffuse = 0.9;
  double specular = 0.2;
  double power = 10.0; ///< Blinn-Phong exponent: roughness^2 = 2 / (power + 2)
  double gamma = 0.5;  ///< Kroes, Post, Botha 2012: how readily a gradient counts as a surface
};

struct TransferFunction {
  ScalarFunction extinction; ///< mm^-1 over the scalar
  ColorFunction albedo;      ///< linear Rec. 709, each in [0, 1]
  std::optional<ScalarFunction> gradientOpacity =
      {};                                     ///< factor over |gradient|, scalar units per mm
  double g = 0.0;                             ///< Henyey-Greenstein mean cosine, in (-1, 1)
  std::optional<SurfaceShading> shading = {}; ///< set: hybrid; else the phase function alone

  /// This function of (s - offset): every knot of extinction and albedo moved by `offset` scalar
  /// units.
  TransferFunction shifted(double offset) const {
    const auto move = [offset](auto& knot) { knot.position += offset; };
    TransferFunction result = *this;
    result.extinction = extinction.withKnots(move);
    result.albedo = albedo.withKnots(move);
    return result;
  }
  /// Extinction multiplied by `factor` >= 0.
  TransferFunction scaled(double factor) const {
    TransferFunction result = *this;
    result.extinction = extinction.withKnots([factor](auto& knot) { knot.value *= factor; });
    return result;
  }
};

} // namespace fenestra
