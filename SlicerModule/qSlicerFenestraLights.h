#ifndef __qSlicerFenestraLights_h
#define __qSlicerFenestraLights_h

#include <QString>
#include <array>

/// Light rig of the renderer with each light scaled, as a value of the flag `lights`: the rig's
/// name, or lights as JSON.
namespace qSlicerFenestraLights {

/// Factors of key, fill and rim light, and of the environment or sky; 1: unchanged.
using Strengths = std::array<double, 4>;
constexpr Strengths unchanged = {1.0, 1.0, 1.0, 1.0};

/// `rig`: "cinema", "studio", "headlight" or "soft". Its first area light is the key, the second
/// the fill, the third the rim; strengths of lights that the rig lacks have no effect.
QString flag(const QString& rig, const Strengths& strengths);

} // namespace qSlicerFenestraLights

#endif
