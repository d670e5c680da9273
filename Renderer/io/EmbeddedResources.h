#pragma once
// Files of Resources/ and a font that are compiled into the executable (Resources/CMakeLists.txt
// lists them).

#include <string>
#include <string_view>
#include <vector>

namespace fenestra::core {

/// Content of the file at `name`, a path under Resources/ like "color/fenestra.ocio". Empty: no
/// such file (`name` may come from a user).
std::string_view findResource(std::string_view name);

/// Paths under Resources/ that start with `prefix`, like "transfer/", sorted.
std::vector<std::string> listResources(std::string_view prefix);

} // namespace fenestra::core
