#pragma once
// Mixture: a medium that is the sum of components with different optical properties. At a point x,
// component j has the label weight w_j(x) (the weights sum to 1) and the extinction
//
//     sigma_j(x) = clip_j(x) w_j(x) extinction_j(s(x)),   sigma_t = sum of sigma_j,
//
// where s is the interpolated scalar, and clip_j the clip weight, or 1 for an unclipped component.
// If the transfer function has gradient opacity, that factor applies, too. At a collision one
// component is sampled with probability sigma_j / sigma_t, and its albedo, phase function and
// surface shading apply, which is unbiased. The estimator depends on this list of parts only, so
// that a second volume could join it with weights of its own.
//
// If components differ only in albedo, a Tint gives the same medium with less noise.

#include "base/Random.h"
#include "model/medium/LabelWeights.h"
#include "model/medium/TransferFunction.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

namespace fenestra::core {

/// Optical properties of a component.
struct Component {
  TransferFunction transfer; ///< its extinction includes the density factor
  bool isClipped = true;     ///< false: the clip does not remove it
  /// Weight of the component's interface as a surface: scales the weight's gradient, per mm, which
  /// is added to the scalar gradient, in spans of the volume's own extinction per mm.
  double interfaceWeight = 0.0;
};

struct Mixture {
  std::shared_ptr<const LabelWeights> weights;
  /// Indexed by component number in `weights`; at least one. All have surface shading if the
  /// volume's own transfer function has it, else none. That function's span scales the gradients of
  /// all components: a constant extinction has no span.
  std::vector<Component> components;

  /// True if some component is not clipped.
  bool hasUnclipped() const { return !std::ranges::all_of(components, &Component::isClipped); }
  /// True if some extinction depends on the gradient.
  bool hasGradientOpacity() const {
    return std::ranges::any_of(components, [](const Component& component) {
      return component.transfer.gradientOpacity.has_value();
    });
  }
};

/// One component's part of a mixture's extinction at a point.
struct MixturePart {
  std::uint8_t component;
  double extinction; ///< sigma_j, mm^-1, > 0
};

/// A point of the volume (index space) and the values that a mixture's parts there depend on.
struct MixturePoint {
  Vec3 index;
  double scalar;
  double clipWeight;  ///< clip weight at the point
  double slope = 0.0; ///< |gradient|, scalar units per mm; 0 unless needsGradient()
};

/// Evaluates a mixture at points of a volume. A view: the mixture must outlive it.
class MixtureField {
public:
  MixtureField(const Mixture& mixture, const Grid& volume)
      : m_mixture(mixture),
        m_toWeights(mixture.weights->grid().worldToIndex * volume.indexToWorld),
        m_hasUnclipped(mixture.hasUnclipped()),
        m_needsGradient(mixture.hasGradientOpacity()) {}

  const Mixture& mixture() const { return m_mixture; }
  bool hasUnclipped() const { return m_hasUnclipped; }
  bool needsGradient() const { return m_needsGradient; }

  /// Calls visit(part) once per component with extinction > 0 at the point.
  template <typename Visit>
  void forEachPart(const MixturePoint& point, Visit&& visit) const {
    m_mixture.weights->forEachWeight(
        m_toWeights * point.index, [&](std::uint8_t number, double weight) {
          const Component& component = m_mixture.components[number];
          double extinction = (component.isClipped ? point.clipWeight : 1.0) * weight *
                              component.transfer.extinction(point.scalar).value();
          if (component.transfer.gradientOpacity)
            extinction *= (*component.transfer.gradientOpacity)(point.slope).value();
          if (extinction > 0.0)
            visit(MixturePart{number, extinction});
        });
  }

  /// sigma_t, mm^-1.
  double extinction(const MixturePoint& point) const {
    double sum = 0.0;
    forEachPart(point, [&](const MixturePart& part) { sum += part.extinction; });
    return sum;
  }

  /// Samples the component of a collision, with probability sigma_j / sigma_t. Uses a random number
  /// only if there are several; returns 0 if the extinction is 0.
  std::uint8_t sampleComponent(const MixturePoint& point, Random& random) const {
    double sum = 0.0;
    std::uint8_t last = 0;
    int count = 0;
    forEachPart(point, [&](const MixturePart& part) {
      sum += part.extinction;
      last = part.component;
      ++count;
    });
    if (count < 2)
      return last;
    double rest = random.uniform() * sum;
    std::optional<std::uint8_t> sampled;
    forEachPart(point, [&](const MixturePart& part) {
      if (!sampled && rest < part.extinction)
        sampled = part.component;
      rest -= part.extinction;
    });
    return sampled.value_or(last);
  }

  /// Gradient of a component's label weight at a point (the volume's index space), per mm, world
  /// axes: central differences over one voxel of the weights' grid on each side.
  Vec3 weightGradient(std::uint8_t number, const Vec3& index) const {
    const Vec3 middle = m_toWeights * index;
    const auto findWeight = [&](const Vec3& at) {
      double sum = 0.0;
      m_mixture.weights->forEachWeight(
          at, [&](std::uint8_t other, double weight) { sum += other == number ? weight : 0.0; });
      return sum;
    };
    Vec3 difference;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = Vec3::Unit(axis);
      difference[axis] = 0.5 * (findWeight(middle + step) - findWeight(middle - step));
    }
    return m_mixture.weights->grid().worldToIndex.linear().transpose() * difference;
  }

private:
  const Mixture& m_mixture;
  Affine m_toWeights;
  bool m_hasUnclipped, m_needsGradient;
};

} // namespace fenestra::core
