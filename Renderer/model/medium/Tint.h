#pragma once
// Tint: colors of segments. Extinction, phase function, surfaces and normals come from the transfer
// function, so that segmentation errors can change colors but never move, hide or create a surface.
// The tint is the mean of the components' albedos, not a Mixture: the medium is the same, with less
// noise, and everything but the color stays bit-identical.

#include "model/medium/LabelWeights.h"
#include "model/medium/PiecewiseLinear.h"

#include <memory>
#include <optional>

namespace fenestra::core {

struct Tint {
  std::shared_ptr<const LabelWeights> weights;
  /// Albedo of each component over the scalar; nullopt: the transfer function's.
  std::vector<std::optional<ColorFunction>> albedo;
};

/// Evaluates a tint at points of a volume. A view: the tint must outlive it.
class TintField {
public:
  TintField(const Tint& tint, const Grid& volume)
      : m_tint(tint), m_toWeights(tint.weights->grid().worldToIndex * volume.indexToWorld) {}

  /// Mean albedo of the components at a point (the volume's index space), by colorWeight() of their
  /// label weights. `transferAlbedo`: the transfer function's albedo there.
  Rgb albedo(const Vec3& index, double scalar, const Rgb& transferAlbedo) const {
    Rgb sum = Rgb::Zero();
    double total = 0.0;
    m_tint.weights->forEachWeight(
        m_toWeights * index, [&](std::uint8_t component, double fraction) {
          const std::optional<ColorFunction>& albedo = m_tint.albedo[component];
          const double weight = scalar::colorWeight(fraction);
          sum += weight * (albedo ? Rgb((*albedo)(scalar)) : transferAlbedo);
          total += weight;
        });
    return sum / total;
  }

private:
  const Tint& m_tint;
  Affine m_toWeights;
};

} // namespace fenestra::core
