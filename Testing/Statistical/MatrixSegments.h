#pragma once
// Segments of the matrix's scenes, for Fenestra and as descriptions for the oracle.

#include "MatrixClips.h"

namespace fenestra::core::testing {

/// Adds the combination's segments with their media or colors; requires the scene's volume. Their
/// label map is rotated relative to the volume and does not cover it.
void placeSegments(const Combination& c, Generator& generator, MatrixScene& scene);

} // namespace fenestra::core::testing
