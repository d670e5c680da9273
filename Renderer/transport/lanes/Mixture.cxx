#include "transport/lanes/Mixture.h"

namespace fenestra {

namespace {

/// For each component the first one of that extinction, clipped alike.
std::vector<std::int32_t> firstAlike(const std::vector<Component>& components) {
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

std::vector<std::int32_t> bricksAlike(const Mixture& mixture) {
  const std::vector<std::int32_t> first = firstAlike(mixture.components);
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

bool SimdMixture::serves(const Mixture& mixture) {
  const auto isServed = [](const Component& component) {
    return !component.transfer.gradientOpacity && component.interfaceWeight == 0.0;
  };
  return SimdLabelWeights::serves(*mixture.weights) &&
         std::ranges::all_of(mixture.components, isServed);
}

SimdMixture::SimdMixture(const Mixture& mixture, const Grid& volume)
    : weights(*mixture.weights, volume),
      merged(weights),
      mergedBricks(std::make_shared<const std::vector<std::int32_t>>(bricksAlike(mixture))),
      hasFree(mixture.hasUnclipped()) {
  merged.bricks = mergedBricks->data();
  for (const Component& component : mixture.components)
    isFree.push_back(component.isClipped ? 0 : 1);
}

} // namespace fenestra
