#pragma once
// The files under Resources/ that travel inside the executable (Resources/CMakeLists.txt picks
// them).

#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

/// The text of a file by its path under Resources/, like "color/fenestra.ocio"; empty where there
/// is none of that name, for names can be a user's.
std::string_view embeddedResource(std::string_view name);

/// The names that start with `prefix`, like "transfer/", sorted.
std::vector<std::string> embeddedResourceNames(std::string_view prefix);

} // namespace fenestra
