#pragma once
// Light that a coat of GGX reflects in all directions together.

#include <algorithm>

namespace fenestra {

/// Schlick's F0 of tissue against air, refractive index 1.4.
inline constexpr double tissueF0 = 0.028;

/// Share of the light from one direction that is reflected, by that direction's cosine to the
/// normal: a polynomial in x = 1 - cosine.
struct CoatReflectance {
  double constant = 0.0, x2 = 0.0, x4 = 0.0, x8 = 0.0;

  double operator()(double cosine) const {
    const double x = std::clamp(1.0 - cosine, 0.0, 1.0);
    const double square = x * x, fourth = square * square;
    return constant + x2 * square + x4 * fourth + x8 * fourth * fourth;
  }
  /// Over a hemisphere, weighted by the cosine: the integral of 2 cosine times this.
  double mean() const { return constant + x2 / 6.0 + x4 / 15.0 + x8 / 45.0; }
  CoatReflectance withScale(double f) const { return {f * constant, f * x2, f * x4, f * x8}; }
};

/// Reflectance of GGX with tissue's F0: least squares over the cosine, raised until it is nowhere
/// less, so that a coat and what lies below never reflect more than arrives. Too much by 0.005 at
/// most from a roughness of 0.2 on, by 0.07 at 0.05 and glancing angles.
CoatReflectance fitCoatReflectance(double roughness);

} // namespace fenestra
