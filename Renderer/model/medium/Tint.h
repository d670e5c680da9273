#pragma once
// Tint: colours of segments. Extinction, phase function, surfaces and normals stay the transfer
// function's, so that an error of the segmentation can colour wrongly, and never move, hide or
// invent a surface.

#include "model/medium/LabelWeights.h"
#include "model/medium/PiecewiseLinear.h"

#include <memory>
#include <optional>

namespace fenestra {

struct Tint {
  std::shared_ptr<const LabelWeights> weights;
  /// Albedo of each component over the scalar; nothing: as the transfer function has it.
  std::vector<std::optional<ColorFunction>> albedo;
};

/// A volume's tint at its points. A view: the tint must outlive the object.
class TintField {
public:
  TintField(const Tint& tint, const Grid& volume)
      : m_tint(tint), m_toWeights(tint.weights->grid().worldToIndex * volume.indexToWorld) {}

  /// Mean of the components' albedo at a point (the volume's index space), weighted by their
  /// shares; `own`: of the transfer function.
  Rgb albedo(const Vec3& index, double scalar, const Rgb& transferAlbedo) const {
    Rgb sum = Rgb::Zero();
    m_tint.weights->forEachWeight(m_toWeights * index, [&](std::uint8_t component, double weight) {
      const std::optional<ColorFunction>& albedo = m_tint.albedo[component];
      sum += weight * (albedo ? Rgb((*albedo)(scalar)) : transferAlbedo);
    });
    return sum;
  }

private:
  const Tint& m_tint;
  Affine m_toWeights;
};

} // namespace fenestra
