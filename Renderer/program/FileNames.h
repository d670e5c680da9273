#pragma once
// File names as results store them: relative to the folder of the result, so that pictures passed
// on do not reveal where, and under whose name, a patient's files lie.

#include "program/Options.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fenestra {

/// `name` relative to `folder`; for a member of an archive, the archive's name, then the member's.
/// A name without a file is returned unchanged.
std::string toRelativeName(const std::string& name, const std::filesystem::path& folder);

/// Words of a command line with file names made relative to `folder`: positionals, and values of
/// flags that take a file.
std::vector<std::string> toRelativeArguments(const std::vector<std::string>& words,
                                             std::span<const Option> options,
                                             const std::filesystem::path& folder);

} // namespace fenestra
