#ifndef __qSlicerFenestraLights_h
#define __qSlicerFenestraLights_h

#include <QJsonArray>
#include <QString>
#include <array>

/// Light rigs of the renderer with scaled lights, as values of the flag `lights`: a rig's name or
/// lights as JSON.
namespace qSlicerFenestraLights {

/// Factors for key, fill and rim light, and for the environment or sky; 1: unchanged.
using Strengths = std::array<double, 4>;
constexpr Strengths unchanged = {1.0, 1.0, 1.0, 1.0};

/// Scales the radiance of each light by its role. Of the lights placed in the camera's frame, those
/// behind the volume are rim lights; the first in front is the key light, the second the fill
/// light. Other lights are unchanged, since a light in world space has no role.
QJsonArray scaleLights(const QJsonArray& lights, const Strengths& strengths);

/// `rig`: name of a rig in Resources/lights; any other value of the flag is returned unchanged.
/// Strengths of lights that the rig lacks have no effect.
QString makeFlag(const QString& rig, const Strengths& strengths);

/// True for each strength that has a light in the rig; an unknown rig has no lights.
std::array<bool, 4> findLights(const QString& rig);

} // namespace qSlicerFenestraLights

#endif
