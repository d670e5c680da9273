#include "transport/lanes/Mixture.h"

namespace fenestra {

bool WideMixture::serves(const Mixture& mixture) {
  const auto isServed = [](const Component& component) {
    return !component.transfer.gradientOpacity && component.border == 0.0;
  };
  return WideShares::serves(*mixture.shares) &&
         std::ranges::all_of(mixture.components, isServed);
}

WideMixture::WideMixture(const Mixture& mixture, const Grid& volume)
    : shares(*mixture.shares, volume), hasFree(mixture.hasFree()) {
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
