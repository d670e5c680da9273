#pragma once
// Slicer's closed-surface segmentations (.vtm with a .vtp for each segment), as labels.

#include "files/segments/SegmentationReader.h"

namespace fenestra {

/// Labels of the voxels of `reference` (the volume's grid) whose centres are inside the surfaces;
/// null: a grid along RAS axes, of voxels of 1/256 of the longest extent. Surfaces are in RAS, as
/// Slicer writes them. Overlapping segments lie in several layers. Throws Error (input): files that
/// the .vtm names outside its folder, planar contours without a surface, surfaces with holes,
/// damaged files.
Segmentation readClosedSurfaces(const std::filesystem::path& path, const Grid* reference);

/// Segments of such a file, without labels.
std::vector<SegmentInfo> readClosedSurfaceInfos(const std::filesystem::path& path);

} // namespace fenestra
