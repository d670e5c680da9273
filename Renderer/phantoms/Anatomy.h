#pragma once
// Anatomy data: Resources/phantoms/*.json define the structures of a subject by names and by shapes
// made of points and radii, mm, in the subject's frame.

#include "phantoms/Shapes.h"

#include <nlohmann/json.hpp>

namespace fenestra::core {

using Anatomy = nlohmann::json;

/// Loads Resources/phantoms/`subject`.json.
Anatomy loadAnatomy(const std::string& subject);

void from_json(const Anatomy& numbers, Vec2& vector);
void from_json(const Anatomy& numbers, Vec3& vector);

/// Reads a part, or a list of parts, each combined with those before it by {"unite": MM},
/// {"cut": MM} or {"intersect": MM}; MM is the width of the blend. A part is one of
///   {"ellipsoid": [CENTER, RADII]}
///   {"block": HALF SIZE, "rounding": MM}
///   {"loft": [[z, x, y, radius along x, along y], ...], "squareness": 0 to 1 [0.25], "cap": MM
///   [5]}
///   {"tube": [[x, y, z, radius], ...], "stretch": FACTORS}
///   {"above": z}
///   {"parts": [...]}
/// and may have a frame of its own, {"frame": [ORIGIN, AXIS, UP]}, or be {"paired": true}.
void from_json(const Anatomy& parts, Solid& solid);

} // namespace fenestra::core
