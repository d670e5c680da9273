#include "transport/lanes/Mixture.h"

namespace fenestra {

namespace {

bool areAlike(const Component& a, const Component& b) {
  return a.isClipped == b.isClipped && a.transfer.extinction == b.transfer.extinction;
}

/// For each component the first one that is alike.
std::vector<std::int32_t> firstAlike(const std::vector<Component>& components) {
  std::vector<std::int32_t> first;
  for (const Component& component : components)
    first.push_back(static_cast<std::int32_t>(
        std::ranges::find_if(components,
                             [&](const Component& other) { return areAlike(other, component); }) -
        components.begin()));
  return first;
}

std::vector<std::int32_t> bricksAlike(const Mixture& mixture) {
  const std::vector<std::int32_t> first = firstAlike(mixture.components);
  std::vector<std::int32_t> bricks = mixture.shares->bricks();
  for (std::size_t brick = 0; brick < bricks.size(); ++brick) {
    std::int32_t common = -1;
    bool isMixed = false;
    mixture.shares->forEachOf(brick, [&](std::uint8_t component) {
      isMixed = isMixed || (common >= 0 && first[component] != common);
      common = first[component];
    });
    if (!isMixed)
      bricks[brick] = common;
  }
  return bricks;
}

} // namespace

bool WideMixture::serves(const Mixture& mixture) {
  const auto isServed = [](const Component& component) {
    return !component.transfer.gradientOpacity && component.border == 0.0;
  };
  return WideShares::serves(*mixture.shares) && std::ranges::all_of(mixture.components, isServed);
}

WideMixture::WideMixture(const Mixture& mixture, const Grid& volume)
    : shares(*mixture.shares, volume),
      alike(shares),
      alikeBricks(std::make_shared<const std::vector<std::int32_t>>(bricksAlike(mixture))),
      hasFree(mixture.hasFree()) {
  alike.bricks = alikeBricks->data();
  double low = infinity, high = -infinity;
  for (const Component& component : mixture.components) {
    const auto& knots = component.transfer.extinction.knots();
    low = std::min(low, knots.front().position);
    high = std::max(high, knots.back().position);
  }
  const WideTable::Bins bins(low, high);
  for (const Component& component : mixture.components) {
    isFree.push_back(component.isClipped ? 0 : 1);
    extinction.emplace_back(component.transfer.extinction);
    const std::vector<WideTable::Line> own = bins.linesOf(component.transfer.extinction);
    lines.insert(lines.end(), own.begin(), own.end());
  }
  count = static_cast<std::int32_t>(lines.size() / mixture.components.size());
  start = narrow(low);
  linesPerUnit = bins.perUnit;
  lastLine = static_cast<float>(count - 1);
}

} // namespace fenestra
