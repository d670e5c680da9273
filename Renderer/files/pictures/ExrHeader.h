#pragma once
// Check of an EXR header before OpenEXR reads the file.

#include <filesystem>

namespace fenestra {

/// Throws std::runtime_error unless every attribute lies within the file and fills its size
/// exactly. OpenEXR takes memory for an attribute of any size before it reads the bytes, and reads
/// most types without regard to their size, misreading all that follows.
void checkExrAttributes(const std::filesystem::path& path);

} // namespace fenestra
