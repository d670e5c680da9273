#include "transport/lanes/Tint.h"

namespace fenestra {

bool WideTint::serves(const Tint& tint) {
  constexpr std::size_t most = std::size_t{1} << 31; // indices of 32 bits
  return tint.shares->groups().size() < most / (sizeof(Shares::Group) / sizeof(std::int32_t));
}

WideTint::WideTint(const Tint& tint, const Grid& volume)
    : toShares(affineRows(tint.shares->grid().worldToIndex * volume.indexToWorld)),
      bricks(tint.shares->bricks().data()),
      groups(tint.shares->groups().data()) {
  std::int32_t stride = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t size = tint.shares->grid().size[axis];
    axes[static_cast<std::size_t>(axis)] = {static_cast<float>(size - 1),
                                            static_cast<float>(std::max<std::int64_t>(size - 2, 0)),
                                            stride};
    stride *= static_cast<std::int32_t>(tint.shares->brickCount()[axis]);
  }
  for (const std::optional<ColorFunction>& colors : tint.albedo)
    albedo.push_back(colors ? std::optional(WideTable(*colors)) : std::nullopt);
}

} // namespace fenestra
