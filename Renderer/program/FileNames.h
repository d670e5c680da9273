#pragma once
// File names as stored in results: relative to the folder of the result, so that published images
// do not reveal the location of patient data.

#include "program/Options.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fenestra::core {

/// `name` relative to `folder`; for a member of an archive, the archive's relative name and the
/// member's. A text that names no file is returned unchanged.
std::string toRelativeName(const std::string& name, const std::filesystem::path& folder);

/// Command-line arguments with file names made relative to `folder`: positional arguments, and
/// values of options that can name a file.
std::vector<std::string> toRelativeArguments(const std::vector<std::string>& words,
                                             std::span<const Option> options,
                                             const std::filesystem::path& folder);

/// Argument "--name=value" with the canonical name; any other argument unchanged.
std::string toCanonicalArgument(const std::string& word, std::span<const Option> options);

} // namespace fenestra::core
