#pragma once
// What the header of an EXR says, looked at before OpenEXR believes it. For io's own sources.

#include <filesystem>

namespace fenestra {

/// OpenEXR takes memory for an attribute of any size before it looks for its bytes, and reads those
/// of most types without regard to their size, so that what follows can be anything. Throws
/// std::runtime_error unless every attribute lies within the file and fills its size exactly.
void checkExrAttributes(const std::filesystem::path& path);

} // namespace fenestra
