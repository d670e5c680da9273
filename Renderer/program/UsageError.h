#pragma once
// Errors about the command line.

#include "base/Error.h"

namespace fenestra::core {

/// Error of kind request, code usage. The parts form a line "subject: detail", like "--size:
/// expected WIDTHxHEIGHT".
template <typename... Parts>
Error usageError(const Parts&... line) {
  const std::string text = concat(line...);
  const std::size_t colon = text.find(": ");
  if (colon == std::string::npos)
    return {ErrorKind::request, {ErrorCode::usage, "", text}};
  return {ErrorKind::request, {ErrorCode::usage, text.substr(0, colon), text.substr(colon + 2)}};
}

} // namespace fenestra::core
