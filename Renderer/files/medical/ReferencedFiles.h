#pragma once
// Finds the files that another file references as its parts, such as detached sample data. They are
// registered as inputs when a scene is opened, so that no output replaces them.

#include <filesystem>
#include <vector>

namespace fenestra::core {

/// Paths of the sample files of a .nrrd, .nhdr, .mha or .mhd, the surfaces of a .vtm, and the other
/// file of an Analyze pair, whether they exist or not; for numbered series, the existing files.
/// Empty for damaged and other files; their readers report what is wrong.
std::vector<std::filesystem::path> findReferencedFiles(const std::filesystem::path& path);

} // namespace fenestra::core
