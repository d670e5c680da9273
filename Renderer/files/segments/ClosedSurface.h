#pragma once
// Reads Slicer's closed-surface segmentations (a .vtm with one .vtp per segment) as labels.

#include "files/segments/SegmentationReader.h"

namespace fenestra::core {

/// Labels the voxels whose centers lie inside the surfaces, on the grid `reference` (the volume's);
/// null: on a grid along the RAS axes, with voxels of 1/256 of the longest extent. Surfaces are in
/// RAS, as Slicer writes them. Overlapping segments go to separate layers. Throws Error (input) for
/// files outside the folder of the .vtm, planar contours without a surface, surfaces with holes,
/// and damaged files.
Segmentation readClosedSurfaces(const std::filesystem::path& path, const Grid* reference);

/// Reads the segments of such a file, without labels.
std::vector<SegmentInfo> readClosedSurfaceInfos(const std::filesystem::path& path);

} // namespace fenestra::core
