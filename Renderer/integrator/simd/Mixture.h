#pragma once
// Shares of a mixture's components in the form that lanes read.

#include "integrator/simd/LabelWeights.h"
#include "model/medium/Mixture.h"

#include <memory>
#include <vector>

namespace fenestra {

/// A view: the mixture must outlive the object.
struct SimdMixture {
  /// True if lanes support every part of the mixture: no gradient opacity, no borders as surfaces.
  static bool isSupported(const Mixture& mixture);
  /// `volume`: whose points are asked for.
  SimdMixture(const Mixture& mixture, const Grid& volume);

  SimdLabelWeights weights;
  /// The same, but bricks whose components all have one extinction, and are clipped alike, are pure
  /// ones of the first such component: flights need not tell them apart.
  SimdLabelWeights merged;
  std::shared_ptr<const std::vector<std::int32_t>> mergedBricks;
  bool hasUnclipped;                     ///< the clip leaves some component
  std::vector<std::int32_t> isUnclipped; ///< of each component: 1, or 0
};

} // namespace fenestra
