#pragma once
// Parts that transfer functions and materials share in Fenestra's JSON: functions of the scalar,
// colors, and the phase function's mean cosine. All functions throw Error (input).

#include "io/JsonNode.h"
#include "model/medium/PiecewiseLinear.h"

namespace fenestra::core {

inline constexpr double maxMagnitude = 1e30; ///< largest scalar and extinction

/// A number from -maxMagnitude to maxMagnitude, so that differences stay finite.
double readFinite(const JsonNode& node);

/// Reads at least one row [scalar, value...], each value from 0 to `maxValue`. Defined for 1 and 3
/// channels.
template <int Channels>
PiecewiseLinear<Channels> readCurve(const JsonNode& rows, double maxValue);

/// Reads 1 to 4096 rows [scalar, "#rrggbb"] as colors in linear Rec. 709.
ColorFunction readColors(const JsonNode& rows);

/// How an object gives its color: "color", the diffuse reflectance of a thick piece, or "albedo",
/// the single-scattering albedo.
enum class ColorKind { none, reflectance, albedo };
/// Throws if the object has both.
ColorKind findColorKind(const JsonNode& object);

/// Member "g" of an object, or `fallback`: in (-1, 1); with ColorKind::reflectance, from 0 to
/// maxReflectanceG.
double readMeanCosine(const JsonNode& object, double fallback, ColorKind kind);

} // namespace fenestra::core
