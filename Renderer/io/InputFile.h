#pragma once
// The first questions that every reader asks of its path.

#include "core/Error.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <string>

namespace fenestra {

/// Bytes that a text file of any kind may have.
inline constexpr std::uint64_t largestText = std::uint64_t{64} << 20;

/// Throws Error (input) unless `path` is a file; `mend` says what to name instead of a folder.
inline void requireFile(const std::filesystem::path& path, const std::string& mend) {
  std::error_code failed;
  const auto status = std::filesystem::status(path, failed);
  if (std::filesystem::is_regular_file(status))
    return;
  if (std::filesystem::is_directory(status))
    throw inputError(path.string(), "is a folder; " + mend);
  if (!std::filesystem::exists(status))
    throw inputError(path.string(), "there is no such file; check the name");
  throw inputError(path.string(), "is not a file that can be read; " + mend);
}

/// The last extension with its dot, in lower case: ".GZ" of "a.nii.GZ" is ".gz".
inline std::string lowerExtension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

} // namespace fenestra
