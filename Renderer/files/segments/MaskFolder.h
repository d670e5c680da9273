#pragma once
// Reads a folder of masks, one structure per file, as TotalSegmentator, MONAI and VISTA3D write it.

#include "files/segments/SegmentationReader.h"

#include <filesystem>
#include <vector>

namespace fenestra::core {

/// The volume files directly in a folder, sorted, without hidden ones; empty: none.
std::vector<std::filesystem::path> listMaskFiles(const std::filesystem::path& folder);

/// Reads the masks of a folder (readMask) as segments, named by their files without extension; they
/// may overlap and have different grids. Masks of equal grid that do not overlap form one label
/// map; others are cropped. A file that is no mask is left out with a warning. Throws Error (input)
/// if the folder has no mask. `reference`:
/// the volume's grid, which chooses between disagreeing NIfTI forms (NiftiForms.h); null: none.
Segmentation readMaskFolder(const std::filesystem::path& folder, const Grid* reference = nullptr);

/// Names the segments without reading the files, hence also those that are no masks.
std::vector<SegmentInfo> readMaskFolderInfos(const std::filesystem::path& folder);

} // namespace fenestra::core
