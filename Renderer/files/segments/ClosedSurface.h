#pragma once
// Slicer's closed-surface segmentations (.vtm with a .vtp for each segment), as labels.

#include "files/segments/SegmentationReader.h"

namespace fenestra {

/// Labels are the voxels of `reference` (the volume's grid) whose centres the surfaces hold;
/// without one, of a grid along RAS axes with 256 voxels along the longest extent. Surfaces are in
/// RAS, as Slicer writes them. Segments that overlap lie in several layers. Throws Error (input):
/// files that the .vtm names outside its folder, planar contours without a surface, surfaces with
/// holes, damaged files.
Segmentation readClosedSurfaces(const std::filesystem::path& path, const Grid* reference);

/// What names its segments.
std::vector<SegmentInfo> readClosedSurfaceInfos(const std::filesystem::path& path);

} // namespace fenestra
