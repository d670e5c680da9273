#pragma once
// Format traps: one analytic subject in files that store it in different ways, written byte by
// byte, without the libraries that the readers use.

#include <filesystem>

namespace fenestra::testing {

/// Writes volumes and segmentations with voxels of about `spacing` mm over a field of view of 40 mm
/// into `folder`, which must exist.
void writeTraps(const std::filesystem::path& folder, double spacing);

} // namespace fenestra::testing
