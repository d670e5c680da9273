#pragma once
// Files that another file names as its parts.

#include <filesystem>
#include <vector>

namespace fenestra {

/// Paths of the sample files that a .nrrd, .nhdr, .mha or .mhd names, of the surfaces of a .vtm,
/// and of the other half of an Analyze pair, whether they exist or not; of numbered series, the
/// existing files. Empty for damaged and other files: readers report what is wrong.
std::vector<std::filesystem::path> findReferencedFiles(const std::filesystem::path& path);

} // namespace fenestra
