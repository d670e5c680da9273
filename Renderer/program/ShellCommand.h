#pragma once
// Commands to be copied into a POSIX shell.

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace fenestra::core {

/// Quotes an argument, if needed.
std::string quoteForShell(const std::string& argument);

/// A render of one of an Inspection's `examples`, as an indented line that is not wrapped.
std::string formatExample(const nlohmann::ordered_json& example);

} // namespace fenestra::core
