#pragma once
// Conversion between albedo and reflectance. A thick, uniform scattering medium reflects less light
// than its single-scattering albedo; materials are described by their visible color.

#include "model/medium/PiecewiseLinear.h"

namespace fenestra::core {

/// Reflectance of a half-space (plane albedo): radiance along the normal under uniform light of
/// radiance 1, by single-scattering albedo, 0 to 1, and Henyey-Greenstein mean cosine g. The table
/// comes from Testing/Oracle/MakeReflectance; g is clamped to [0, maxReflectanceG].
double toReflectance(double albedo, double g);
inline Rgb toReflectance(const Rgb& albedo, double g) {
  return albedo.unaryExpr([g](double channel) { return toReflectance(channel, g); });
}

/// Largest mean cosine in the table; the smallest is 0.
inline constexpr double maxReflectanceG = 0.95;
/// Largest reflectance that toAlbedo inverts: a whiter medium would scatter far too often.
inline constexpr double maxReflectance = 0.95;

/// Inverse of toReflectance: the albedo of a medium with that reflectance.
double toAlbedo(double color, double g);
inline Rgb toAlbedo(const Rgb& color, double g) {
  return color.unaryExpr([g](double channel) { return toAlbedo(channel, g); });
}
/// Albedo of a reflectance function. Reflectance is linear between two knots, but its albedo is
/// not: added knots approximate it, within 2 % of the color for g = 0.
ColorFunction toAlbedo(const ColorFunction& colors, double g);

} // namespace fenestra::core
