#pragma once
// The head of a fetus as one smooth shape. For phantom's own sources.

#include "phantoms/Shapes.h"

namespace fenestra {

/// World: the middle of the head near the origin, the face anterior, superior up.
Solid fetusHead();
/// A fist beside its chin.
Solid fetusHand();

} // namespace fenestra
