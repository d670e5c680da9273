#pragma once
// Head of a fetus as one smooth shape. Internal to the phantom library.

#include "phantoms/Shapes.h"

namespace fenestra {

/// Head in the world: its middle near the origin, face anterior, superior up.
Solid fetusHead();
/// Fist beside the chin.
Solid fetusHand();

} // namespace fenestra
