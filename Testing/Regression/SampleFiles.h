#pragma once
// The format traps: one analytic subject in files that each hold it differently. The files are
// written byte by byte, by no library that the readers use.

#include <filesystem>

namespace fenestra::testing {

/// Writes volumes and segmentations of voxels of about `spacing` mm over a field of view of 40 mm
/// into `folder`, which is there.
void writeTraps(const std::filesystem::path& folder, double spacing);

} // namespace fenestra::testing
