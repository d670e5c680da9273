#pragma once
// Functions over the scalar, colours and the phase function's mean cosine in Fenestra's JSON: what
// transfer functions and materials have in common. All throw Error (input).

#include "io/JsonNode.h"
#include "model/medium/PiecewiseLinear.h"

namespace fenestra {

inline constexpr double maxMagnitude = 1e30; ///< largest scalar and extinction

/// A number from -maxMagnitude to maxMagnitude: differences stay finite.
double readFinite(const JsonNode& node);

/// Rows [scalar, value...], at least one, each value from 0 to `most`. Defined for 1 and 3
/// channels.
template <int Channels>
PiecewiseLinear<Channels> readCurve(const JsonNode& rows, double maxValue);

/// Rows [scalar, "#rrggbb"], from 1 to 4096: the colours, linear Rec. 709.
ColorFunction readColors(const JsonNode& rows);

/// Form in which an object gives its colour: "color", as an eye sees it, or "albedo".
enum class ColorKind { none, reflectance, albedo };
/// Refuses both in one object.
ColorKind findColorKind(const JsonNode& object);

/// Member "g" of an object, `fallback` without one: above -1, below 1, and from 0 to
/// maxReflectanceG with colours that are seen.
double readMeanCosine(const JsonNode& object, double fallback, ColorKind kind);

} // namespace fenestra
