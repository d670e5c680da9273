#include "transport/lanes/Shares.h"

namespace fenestra {

bool WideShares::serves(const Shares& shares) {
  constexpr std::size_t most = std::size_t{1} << 32; // indices of 32 bits
  return shares.planes().size() <= most / sizeof(Shares::Plane);
}

WideShares::WideShares(const Shares& shares, const Grid& volume)
    : toShares(affineRows(shares.grid().worldToIndex * volume.indexToWorld)),
      bricks(shares.bricks().data()),
      planes(shares.planes().data()) {
  std::int32_t stride = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t size = shares.grid().size[axis];
    axes[static_cast<std::size_t>(axis)] = {static_cast<float>(size - 1),
                                            static_cast<float>(std::max<std::int64_t>(size - 2, 0)),
                                            stride};
    stride *= static_cast<std::int32_t>(shares.brickCount()[axis]);
  }
}

} // namespace fenestra
