#pragma once
// Directional albedo of a GGX coat: the fraction of incident light that it reflects in total.

#include <algorithm>

namespace fenestra::core {

/// Schlick's F0 of tissue in air, refractive index 1.4.
inline constexpr double tissueF0 = 0.028;

/// Reflected fraction of the light from one direction, as a function of that direction's cosine to
/// the normal: a polynomial in x = 1 - cosine.
struct CoatReflectance {
  double constant = 0.0, x2 = 0.0, x4 = 0.0, x8 = 0.0;

  double operator()(double cosine) const {
    const double x = std::clamp(1.0 - cosine, 0.0, 1.0);
    const double square = x * x, fourth = square * square;
    return constant + x2 * square + x4 * fourth + x8 * fourth * fourth;
  }
  /// Cosine-weighted mean over the hemisphere: the integral of 2 cosine times this.
  double mean() const { return constant + x2 / 6.0 + x4 / 15.0 + x8 / 45.0; }
  CoatReflectance withScale(double f) const { return {f * constant, f * x2, f * x4, f * x8}; }
};

/// Directional albedo of GGX with tissue's F0: a least-squares fit, raised so that it is nowhere
/// too low; so a coat and the lobe below never reflect more light than arrives. The error is at
/// most 0.005 for a roughness of at least 0.2, and 0.07 at 0.05 and grazing angles.
CoatReflectance fitCoatReflectance(double roughness);

} // namespace fenestra::core
