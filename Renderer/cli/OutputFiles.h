#pragma once
// Results must not cost a user other files.

#include <filesystem>
#include <vector>

namespace fenestra {

/// Throws Error (usage) where a result is one of the inputs or another result, under whatever name.
void checkDistinct(const std::vector<std::filesystem::path>& inputs,
                   const std::vector<std::filesystem::path>& results);

} // namespace fenestra
