#pragma once
// Colours of segments in the form that lanes read.

#include "model/medium/Tint.h"
#include "transport/lanes/Shares.h"

#include <optional>
#include <vector>

namespace fenestra {

/// A view: the tint must outlive the object.
struct WideTint {
  /// `volume`: whose points are asked for.
  WideTint(const Tint& tint, const Grid& volume) : shares(*tint.shares, volume) {
    for (const std::optional<ColorFunction>& colors : tint.albedo)
      albedo.push_back(colors ? std::optional(WideTable(*colors)) : std::nullopt);
  }

  WideShares shares;
  std::vector<std::optional<WideTable>> albedo; ///< of each component, as in Tint
};

} // namespace fenestra
