#pragma once
// Format variants: files that store the same analytic subject with different axes, types and
// encodings. They are written without the libraries that the readers use.

#include <filesystem>

namespace fenestra::core::testing {

/// Writes volumes and segmentations with voxels of about `spacing` mm over a field of view of 40 mm
/// into `folder`, which must exist.
void writeFormatVariants(const std::filesystem::path& folder, double spacing);

} // namespace fenestra::core::testing
