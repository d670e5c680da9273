#pragma once
// A focus that the default transfer functions make transparent, such as lungs and airways, is shown
// as solid bodies. Their surface is that of the segmentation: the data have none.

#include "scene/Stages.h"

namespace fenestra::core {

/// Segments of the focus and their medians, if the transfer function makes each mostly transparent;
/// else empty: of lungs and their vessels, the vessels are visible. `hasVoxels`: from
/// findNonEmpty(). Throws Error (input) for unknown names.
TransparentFocus findTransparentFocus(const Handle<SegmentsInput>& segments,
                                      const Handle<std::vector<bool>>& hasVoxels,
                                      const std::vector<std::string>& names,
                                      const VolumeHandle& volume,
                                      const Handle<TransferChoice>& transfer);

/// Segments in which gaps separate those of a transparent focus that touch, such as the lobes of a
/// lung: as solid bodies they would have no fissures. A segment that would lose over half remains.
Handle<SegmentsInput> separateSegments(const Handle<SegmentsInput>& segments,
                                       const Handle<TransparentFocus>& transparent,
                                       const VolumeHandle& volume);

} // namespace fenestra::core
