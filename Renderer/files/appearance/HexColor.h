#pragma once
// Reads sRGB hex colors from JSON.

#include "base/Vector.h"
#include "io/JsonNode.h"

namespace fenestra::core {

/// Reads an sRGB color "#rrggbb" and decodes it (IEC 61966-2-1) to linear Rec. 709, 0 to 1. Throws
/// Error (input) for anything but # and six hexadecimal digits.
Rgb readHexColor(const JsonNode& node);

} // namespace fenestra::core
