#pragma once
// Optical properties as functions of the scalar. These functions *define* the medium: the renderer
// and every test oracle read extinction and albedo from here.

#include "model/medium/CoatReflectance.h"
#include "model/medium/PiecewiseLinear.h"

#include <optional>

namespace fenestra::core {

/// Surface lobes of hybrid shading: Lambert with the albedo, and GGX with Schlick's Fresnel term.
struct SurfaceShading {
  double diffuse = 0.9;
  double specular = 0.2;
  double power = 10.0; ///< Blinn-Phong exponent: roughness^2 = 2 / (power + 2)
  double gamma = 0.5;  ///< Kroes, Post, Botha 2012: sensitivity of surfaces to gradients
  /// Set: GGX coats the Lambert lobe, which receives only the light that the coat transmits; F0 is
  /// tissue's. Not set: the lobes are added side by side, and F0 is 0.04.
  std::optional<CoatReflectance> coated = {};
  /// Factor on the odds a / (1 - a) of the albedo a in the Lambert lobe.
  double oddsFactor = 1.0;

  /// Shading of a material with a given color: `specular` from 0 to 1, `roughness` above 0 to 1; g:
  /// of the phase function. A surface returns light after one scattering, so that with the medium's
  /// albedo it would look too bright. An odds factor of 0.47 makes a half-space of surfaces look
  /// like one of isotropic scattering (within 2 % of 1 - a; measured, 300,000 paths), and 1 - g
  /// reduces anisotropic scattering to isotropic (similarity, van de Hulst 1980).
  static SurfaceShading makeCoated(double specular, double roughness, double g = 0.0);

  /// Weights of the lobes, and F0: reflectance at normal incidence, for index 1.4 or 1.5.
  struct Lobes {
    double lambert, glossy, f0;
    CoatReflectance coat; ///< over the Lambert lobe, scaled by `glossy`; 0: side by side
  };
  /// Weights normalized to conserve energy.
  Lobes lobes() const;
};

/// Gradient of the scalar that gives normals and surfaces (Field::gradient, Field::sobelGradient).
/// Gradient opacity always takes central differences, as VTK does.
enum class GradientKind { central, sobel };

struct TransferFunction {
  ScalarFunction extinction; ///< mm^-1 over the scalar
  ColorFunction albedo;      ///< linear Rec. 709, each in [0, 1]
  std::optional<ScalarFunction> gradientOpacity =
      {};                                        ///< factor over |gradient|, scalar units per mm
  double g = 0.0;                                ///< Henyey-Greenstein mean cosine, in (-1, 1)
  std::optional<SurfaceShading> shading = {};    ///< set: hybrid; not set: phase function only
  GradientKind gradient = GradientKind::central; ///< that of the volume's own function applies

  /// Copy with every knot of extinction and albedo moved by `offset` scalar units.
  TransferFunction withShift(double offset) const {
    const auto move = [offset](auto& knot) { knot.position += offset; };
    TransferFunction result = *this;
    result.extinction = extinction.withKnots(move);
    result.albedo = albedo.withKnots(move);
    return result;
  }
  /// Copy with the extinction multiplied by `factor` >= 0.
  TransferFunction withDensity(double factor) const {
    TransferFunction result = *this;
    result.extinction = extinction.withKnots([factor](auto& knot) { knot.value *= factor; });
    return result;
  }
};

} // namespace fenestra::core
