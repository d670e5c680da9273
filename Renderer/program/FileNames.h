#pragma once
// Names of files as results keep them: relative to the folder of the result, so that pictures which
// are passed on do not tell where, and under whose name, a patient's files lie.

#include "program/Flags.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fenestra {

/// `name` as seen from `folder`; members of an archive behind the archive's name. Names of nothing
/// stay as they are.
std::string relativeName(const std::string& name, const std::filesystem::path& folder);

/// Words of a command line in which files are named as seen from `folder`: positional ones, and
/// values of flags that take a file.
std::vector<std::string> relativeArguments(const std::vector<std::string>& words,
                                           std::span<const Flag> flags,
                                           const std::filesystem::path& folder);

} // namespace fenestra
