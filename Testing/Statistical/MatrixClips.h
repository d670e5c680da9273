#pragma once
// Clips and context styles of the matrix's scenes, for Fenestra and as descriptions for the
// oracle.

#include "Matrix.h"

#include <random>

namespace fenestra::core::testing {

using Generator = std::mt19937_64;

inline double uniform(Generator& generator, double low, double high) {
  return low + (high - low) * static_cast<double>(generator() >> 11) * 0x1p-53;
}

inline Vec3 randomDirection(Generator& generator) {
  const double u = uniform(generator, 0.0, 1.0);
  return sampleUniformSphere({u, uniform(generator, 0.0, 1.0)});
}

/// Requires the scene's camera, volume and crop.
void placeClip(const Combination& c, Generator& generator, MatrixScene& scene);

void styleContext(StyleFactor factor, MatrixScene& scene);

} // namespace fenestra::core::testing
