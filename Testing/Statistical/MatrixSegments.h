#pragma once
// Coloured segments of the matrix's scenes: built for the product, and described for the oracle.

#include "MatrixClips.h"

namespace fenestra::testing {

/// Colours the combination's segments, after the volume is made: their labelmap is turned against
/// it, and does not cover it.
void tintSegments(const Combination& c, Generator& generator, MatrixScene& scene);

} // namespace fenestra::testing
