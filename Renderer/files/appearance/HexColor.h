#pragma once
// Colours in JSON as they are chosen on a monitor.

#include "base/Vector.h"
#include "io/JsonNode.h"

namespace fenestra {

/// Reads an sRGB colour "#rrggbb" and decodes it (IEC 61966-2-1): linear Rec. 709, 0 to 1. Throws
/// Error (input) for anything but # and six hexadecimal digits.
Rgb readHexColor(const JsonNode& node);

} // namespace fenestra
