#pragma once
// Mixture: a medium that is a sum of components, each with its own matter. At a point x component j
// has the share w_j(x) of the segmentation (all sum to 1), and
//
//     sigma_j(x) = keep_j(x) w_j(x) extinction_j(s(x)),   sigma_t = sum of sigma_j,
//
// where s is the interpolated scalar (and the extinction is times the gradient opacity, where a
// transfer function has one), and keep_j the clip's, or 1 for a component that the clip leaves. At
// a collision one component is drawn with probability sigma_j / sigma_t, and all that follows
// (albedo, phase function or surface) is that component's: unbiased, whatever differs. The
// estimator knows a list of parts alone: another volume's matter would join it with shares of its
// own.
//
// Where components differ in nothing but albedo, Tint is the same medium with less noise.

#include "base/Random.h"
#include "model/medium/LabelWeights.h"
#include "model/medium/TransferFunction.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

namespace fenestra {

/// Matter of a component.
struct Component {
  TransferFunction transfer; ///< its density is in the extinction
  bool isClipped = true;     ///< false: stays where the clip removes all else
  /// Weight of the border as a surface: of the share's gradient, per mm, beside the scalar's, in
  /// spans of the volume's own extinction per mm.
  double interfaceWeight = 0.0;
};

struct Mixture {
  std::shared_ptr<const LabelWeights> weights;
  /// By number in `shares`, at least one. All have surface shading where the volume's own transfer
  /// function has it, else none. Gradients count by that function's span for all of them: a
  /// constant extinction has none.
  std::vector<Component> components;

  /// True if the clip leaves some component.
  bool hasUnclipped() const { return !std::ranges::all_of(components, &Component::isClipped); }
  /// True if some extinction depends on the gradient.
  bool hasGradientOpacity() const {
    return std::ranges::any_of(components, [](const Component& component) {
      return component.transfer.gradientOpacity.has_value();
    });
  }
};

/// Part of a mixture's extinction at a point.
struct MixturePart {
  std::uint8_t component;
  double extinction; ///< sigma_j, mm^-1, > 0
};

/// A point of the volume (its index space) with what a mixture's parts there depend on.
struct MixturePoint {
  Vec3 index;
  double scalar;
  double clipWeight;  ///< keep of the clip there
  double slope = 0.0; ///< |gradient|, scalar units per mm; 0 unless needsGradient()
};

/// A volume's mixture at its points. A view: the mixture must outlive the object.
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

  /// Calls visit(part) for the parts at a point, each component once.
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

  /// Component that a collision meets, with probability sigma_j / sigma_t. Draws a number where
  /// there are several; component 0 where the extinction is 0.
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

  /// Gradient of a component's share at a point (the volume's index space), per mm, world axes:
  /// central differences over one voxel of the shares to each side.
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

} // namespace fenestra
