#pragma once
// Label weights of a mixture's components in SIMD form.

#include "integrator/simd/LabelWeights.h"
#include "model/medium/Mixture.h"

#include <memory>
#include <vector>

namespace fenestra::core {

/// Non-owning: the mixture must outlive the object.
struct SimdMixture {
  /// False for mixtures with gradient opacity or with interfaces shaded as surfaces.
  static bool isSupported(const Mixture& mixture);
  /// `volume`: grid of the points to be looked up.
  SimdMixture(const Mixture& mixture, const Grid& volume);

  SimdLabelWeights weights;
  /// Label weights for free flights, which read extinctions alone. A brick whose components have
  /// the same extinction, and are all clipped or all unclipped, becomes a pure brick of the first
  /// such component.
  SimdLabelWeights merged;
  std::shared_ptr<const std::vector<std::int32_t>> mergedBricks;
  bool hasUnclipped;                     ///< some component is unclipped
  std::vector<std::int32_t> isUnclipped; ///< per component: 1 if unclipped, else 0
};

} // namespace fenestra::core
