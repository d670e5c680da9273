#pragma once
// Work in a process of its own, for libraries that do not survive damaged files.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace fenestra {

/// Has a child process fill `size` bytes: `fill` gets the place, and says whether it is done.
/// Nothing where it is not, throws, crashes, or takes more than five minutes; what it prints is
/// dropped. Throws Error (output) where there is no memory or no process to be had.
std::optional<std::string> filledApart(std::size_t size, const std::function<bool(char*)>& fill);

} // namespace fenestra
