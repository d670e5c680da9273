#ifndef __qSlicerFenestraLights_h
#define __qSlicerFenestraLights_h

#include <QString>
#include <array>

/// A light rig of the renderer's with each of its lights dimmed or raised, as the flag `lights`
/// takes it: the rig's name, or lights as JSON.
namespace qSlicerFenestraLights {

/// Of the key, fill and rim light, and of the environment; 1 is as the rig has it.
using Strengths = std::array<double, 4>;
constexpr Strengths unchanged = {1.0, 1.0, 1.0, 1.0};

/// `rig`: "studio", "headlight" or "soft". A rig's first area light is its key, its second its
/// fill, its third its rim; those that it has not are not changed.
QString flag(const QString& rig, const Strengths& strengths);

} // namespace qSlicerFenestraLights

#endif
