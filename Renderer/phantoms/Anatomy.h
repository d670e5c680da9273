#pragma once
// Anatomy as numbers: the files Resources/phantoms/*.json give names and shapes of a subject's
// structures as points and radii, mm, in the subject's frame.

#include "phantoms/Shapes.h"

#include <nlohmann/json.hpp>

namespace fenestra {

using Anatomy = nlohmann::json;

/// Content of Resources/phantoms/`subject`.json.
Anatomy loadAnatomy(const std::string& subject);

void from_json(const Anatomy& numbers, Vec2& vector);
void from_json(const Anatomy& numbers, Vec3& vector);

/// Reads a part, or a list of parts, each joined with those before it: {"unite": MM}, {"cut": MM}
/// or {"intersect": MM}, MM being the width of the blend. A part is one of
///   {"ellipsoid": [CENTER, RADII]}
///   {"block": HALF SIZE, "rounding": MM}
///   {"loft": [[z, x, y, radius along x, along y], ...], "squareness": 0 to 1 [0.25], "cap": MM
///   [5]}
///   {"tube": [[x, y, z, radius], ...], "stretch": FACTORS}
///   {"above": z}
///   {"parts": [...]}
/// and may lie in a frame of its own, {"frame": [ORIGIN, AXIS, UP]}, or be {"paired": true}.
void from_json(const Anatomy& parts, Solid& solid);

} // namespace fenestra
