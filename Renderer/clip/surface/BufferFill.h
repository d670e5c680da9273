#pragma once
// Fills a depth buffer outside the focus (clip/portable/SmoothFill.h).

#include "clip/field/SilhouetteCells.h"

namespace fenestra::core {

/// Fills the samples of `buffer` outside the focus, from the halo on. At least one sample must be
/// focus. `length`: mm, over which the surface levels off.
void fillSmoothly(DepthBuffer& buffer, const std::vector<Region>& regions,
                  const std::vector<SilhouetteCells::HaloSample>& halo, double length);

} // namespace fenestra::core
