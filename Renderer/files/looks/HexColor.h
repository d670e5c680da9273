#pragma once
// Colours as people write them.

#include "base/Vector.h"

namespace fenestra {

class JsonNode;

/// Linear Rec. 709 of the text "#rrggbb", which is sRGB (IEC 61966-2-1). Throws Error (input) for
/// anything else.
Rgb readHexColor(const JsonNode& node);

} // namespace fenestra
