#pragma once
// Segments of the matrix's scenes: built for the product, and described for the oracle.

#include "MatrixClips.h"

namespace fenestra::testing {

/// Gives the combination's segments their matter or colours, after the volume is made: their
/// labelmap is turned against it, and does not cover it.
void placeSegments(const Combination& c, Generator& generator, MatrixScene& scene);

} // namespace fenestra::testing
