#include "integrator/simd/Mixture.h"

namespace fenestra::core {

namespace {

/// For each component the first with the same extinction and the same isClipped.
std::vector<std::int32_t> findFirstAlike(const std::vector<Component>& components) {
  std::vector<std::int32_t> first;
  for (const Component& component : components) {
    const auto isAlike = [&](const Component& other) {
      return other.isClipped == component.isClipped &&
             other.transfer.extinction == component.transfer.extinction;
    };
    first.push_back(
        static_cast<std::int32_t>(std::ranges::find_if(components, isAlike) - components.begin()));
  }
  return first;
}

std::vector<std::int32_t> mergeBricks(const Mixture& mixture) {
  const std::vector<std::int32_t> first = findFirstAlike(mixture.components);
  std::vector<std::int32_t> bricks = mixture.weights->bricks();
  for (std::size_t brick = 0; brick < bricks.size(); ++brick) {
    std::int32_t common = -1;
    bool isMixed = false;
    mixture.weights->forEachInBrick(brick, [&](std::uint8_t component) {
      isMixed = isMixed || (common >= 0 && first[component] != common);
      common = first[component];
    });
    if (!isMixed)
      bricks[brick] = common;
  }
  return bricks;
}

} // namespace

bool SimdMixture::isSupported(const Mixture& mixture) {
  const auto isUsable = [](const Component& component) {
    return !component.transfer.gradientOpacity && component.interfaceWeight == 0.0;
  };
  return SimdLabelWeights::isSupported(*mixture.weights) &&
         std::ranges::all_of(mixture.components, isUsable);
}

SimdMixture::SimdMixture(const Mixture& mixture, const Grid& volume)
    : weights(*mixture.weights, volume),
      merged(weights),
      mergedBricks(std::make_shared<const std::vector<std::int32_t>>(mergeBricks(mixture))),
      hasUnclipped(mixture.hasUnclipped()) {
  merged.bricks = mergedBricks->data();
  for (const Component& component : mixture.components)
    isUnclipped.push_back(component.isClipped ? 0 : 1);
}

} // namespace fenestra::core
