#pragma once
// Format traps: files that store the same analytic subject in different ways, such as axes, types
// and encodings. They are written without the libraries that the readers use.

#include <filesystem>

namespace fenestra::testing {

/// Writes volumes and segmentations with voxels of about `spacing` mm over a field of view of 40 mm
/// into `folder`, which must exist.
void writeTraps(const std::filesystem::path& folder, double spacing);

} // namespace fenestra::testing
