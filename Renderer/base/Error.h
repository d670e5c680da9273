#pragma once
// Every failure that a user can cause is an Error: one line that names the file (or option), the
// field and the fix. The kind is the process's exit status.

#include "base/Text.h"

#include <stdexcept>
#include <string>

namespace fenestra {

enum class ErrorKind {
  usage = 2,  ///< the command line is wrong
  input = 3,  ///< a file or its content is wrong
  output = 4, ///< a result cannot be written, or a resource is missing
};

class Error : public std::runtime_error {
public:
  Error(ErrorKind kind, const std::string& line) : std::runtime_error(line), m_kind(kind) {}

  ErrorKind kind() const { return m_kind; }
  int exitStatus() const { return static_cast<int>(m_kind); }

private:
  ErrorKind m_kind;
};

// Parts are those of concat(): texts, paths and integers.
template <typename... Parts>
Error usageError(const Parts&... line) {
  return {ErrorKind::usage, concat(line...)};
}
template <typename File, typename... Parts>
Error inputError(const File& file, const Parts&... what) {
  return {ErrorKind::input, concat(file, ": ", what...)};
}
template <typename File, typename... Parts>
Error outputError(const File& file, const Parts&... what) {
  return {ErrorKind::output, concat(file, ": ", what...)};
}

} // namespace fenestra
