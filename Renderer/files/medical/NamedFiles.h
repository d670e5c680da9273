#pragma once
// Files that hold a part of another one, which names them.

#include <filesystem>
#include <vector>

namespace fenestra {

/// Where the samples of a .nrrd, .nhdr, .mha or .mhd and the surfaces of a .vtm are said to be, be
/// they there or not, and the other half of an Analyze pair. Of numbered series those that are
/// there. Whatever is damaged, or no such file, names none: this tells what belongs together, and
/// readers tell what is wrong.
std::vector<std::filesystem::path> filesNamedBy(const std::filesystem::path& path);

} // namespace fenestra
