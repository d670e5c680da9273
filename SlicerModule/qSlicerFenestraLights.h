#ifndef __qSlicerFenestraLights_h
#define __qSlicerFenestraLights_h

#include <QJsonArray>
#include <QString>
#include <array>

/// Light rig of the renderer with each light scaled, as a value of the flag `lights`: the rig's
/// name, or lights as JSON.
namespace qSlicerFenestraLights {

/// Factors of key, fill and rim light, and of the environment or sky; 1: unchanged.
using Strengths = std::array<double, 4>;
constexpr Strengths unchanged = {1.0, 1.0, 1.0, 1.0};

/// Lights in the renderer's form with radiances scaled by what each light is. Of lights with a
/// place in the camera's frame those behind the volume are rims, the first before it is the key,
/// the second the fill. All other lights stay as they are: a lamp in the world may stand anywhere.
QJsonArray scaleLights(const QJsonArray& lights, const Strengths& strengths);

/// `rig`: name of a rig in Resources/lights, or any other value of the flag, which is returned as
/// it is. Strengths of lights that the rig lacks have no effect.
QString makeFlag(const QString& rig, const Strengths& strengths);

/// True for each strength that has a light in the rig; an unknown rig has none.
std::array<bool, 4> findLights(const QString& rig);

} // namespace qSlicerFenestraLights

#endif
