#pragma once
// Optical properties as functions of the scalar. These functions *are* the medium: the product and
// every oracle read extinction and albedo from here.

#include "model/medium/CoatReflectance.h"
#include "model/medium/PiecewiseLinear.h"

#include <optional>

namespace fenestra {

/// Surface lobes of hybrid shading: Lambert with the albedo, and GGX with a Fresnel term by
/// Schlick.
struct SurfaceShading {
  double diffuse = 0.9;
  double specular = 0.2;
  double power = 10.0; ///< Blinn-Phong exponent: roughness^2 = 2 / (power + 2)
  double gamma = 0.5;  ///< Kroes, Post, Botha 2012: how readily a gradient counts as a surface
  /// Set: GGX lies over the Lambert lobe as a coat, and what it reflects the other does not get; F0
  /// is tissue's. Else the lobes stand side by side, and F0 is 0.04.
  std::optional<CoatReflectance> coated = {};
  /// Factor on the odds a / (1 - a) of the albedo a, for the Lambert lobe.
  double oddsFactor = 1.0;

  /// Lobes of matter whose colour is given: `specular` from 0 to 1, `roughness` above 0, to 1; g:
  /// of the phase function. A surface sends light back at once, so that with the matter's own
  /// albedo it would look brighter than the matter. With 0.47 of its odds a half-space of surfaces
  /// alone looks like one of isotropic scattering (within 2 % of 1 - a; measured, 300,000 paths),
  /// and 1 - g brings anisotropic scattering to isotropic (similarity, van de Hulst 1980).
  static SurfaceShading makeCoated(double specular, double roughness, double g = 0.0);

  /// Weights of the lobes, and F0: reflectance at normal incidence, of refractive index 1.4 or 1.5.
  struct Lobes {
    double lambert, glossy, f0;
    CoatReflectance coat; ///< over the Lambert lobe, its weight included; 0: side by side
  };
  /// Weights that never reflect more than arrives.
  Lobes lobes() const;
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
  TransferFunction withShift(double offset) const {
    const auto move = [offset](auto& knot) { knot.position += offset; };
    TransferFunction result = *this;
    result.extinction = extinction.withKnots(move);
    result.albedo = albedo.withKnots(move);
    return result;
  }
  /// Extinction multiplied by `factor` >= 0.
  TransferFunction withDensity(double factor) const {
    TransferFunction result = *this;
    result.extinction = extinction.withKnots([factor](auto& knot) { knot.value *= factor; });
    return result;
  }
};

} // namespace fenestra
