#pragma once
// Colour as it is seen: of a thick, uniform scattering medium an eye sees less than its albedo.

#include "model/medium/PiecewiseLinear.h"

namespace fenestra {

/// Radiance of a half-space seen along its normal under uniform light of radiance 1 (its plane
/// albedo), by single-scattering albedo, 0 to 1, and Henyey-Greenstein mean cosine g. From a table
/// that Testing/Oracle/MakeReflectance made; g below 0 reads as 0, and beyond 0.95 as 0.95.
double toReflectance(double albedo, double g);
inline Rgb toReflectance(const Rgb& albedo, double g) {
  return albedo.unaryExpr([g](double channel) { return toReflectance(channel, g); });
}

/// Mean cosines of the table: 0 to this.
inline constexpr double maxReflectanceG = 0.95;
/// Greatest reflectance that toAlbedo inverts: whiter matter would scatter for minutes.
inline constexpr double maxReflectance = 0.95;

/// Albedo whose reflectance is that; its inverse.
double toAlbedo(double color, double g);
inline Rgb toAlbedo(const Rgb& color, double g) {
  return color.unaryExpr([g](double channel) { return toAlbedo(channel, g); });
}
/// Albedo of a function whose colours are seen. Between two knots colours are linear, which their
/// albedo is not: knots in between follow it, within 2 % of the colour for g = 0.
ColorFunction toAlbedo(const ColorFunction& colors, double g);

} // namespace fenestra
