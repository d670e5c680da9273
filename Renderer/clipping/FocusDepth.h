#pragma once
// Where the eye first meets the focus.

#include "clipping/DepthBuffer.h"
#include "volume/Domain.h"
#include "volume/Mask.h"

#include <cstdint>
#include <vector>

namespace fenestra {

/// What an eye ray meets: the focus; the volume's domain but not the focus; neither.
enum class Region : std::uint8_t { outside, context, focus };

struct FocusDepth {
  DepthBuffer depth;           ///< of the focus, infinite elsewhere
  std::vector<Region> regions; ///< of each sample of `depth`

  bool isFocus(std::int64_t column, std::int64_t row) const {
    return column >= 0 && row >= 0 && column < depth.columns() && row < depth.rows() &&
           regions[static_cast<std::size_t>(depth.sample(column, row))] == Region::focus;
  }
};

/// The depth at which the ray of each sample first meets the 0.5 level of the focus inside the
/// volume's domain and in front of the eye: exact, to rounding. A ray that starts, or enters the
/// domain, inside the focus meets it there. The buffer spans the whole volume, cropped or not.
FocusDepth traceFocus(const Camera& camera, const Domain& volume, const Mask& focus);

} // namespace fenestra
