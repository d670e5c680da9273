#pragma once
// Messages for the error codes of system calls, with the mend for a user.

#include "base/Error.h"
#include "base/safe/Descriptor.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

namespace fenestra {

inline std::string systemMessage(int code) {
  return std::generic_category().message(code);
}

/// Mend for a failed write; `other`: mend where the name or its folder is at fault.
inline std::string writingMend(int code, const std::string& other) {
  switch (code) {
  case ENOSPC:
  case EDQUOT:
  case EFBIG:
    return "free some space, or choose another disk";
  case ENAMETOOLONG:
    return "choose a shorter name";
  case EIO:
    return "its disk fails: check it";
  case EMFILE:
  case ENFILE:
    return "close other programs, or raise the limit on open files (ulimit -n)";
  case ENOMEM:
    return "close other programs";
  default:
    return other;
  }
}

/// Mend for a failed read; `other` as in writingMend.
inline std::string readingMend(int code, const std::string& other) {
  return code == ELOOP ? "its links lead to each other: name the file itself"
                       : writingMend(code, other);
}

/// Error for a result that cannot be written.
inline Error writingError(const std::filesystem::path& path, int code) {
  return outputError(path, "cannot be written: ", systemMessage(code), "; ",
                     writingMend(code, "name a file in an existing folder that you may write to"));
}

/// Error for a file or folder that cannot be made; `other` as in writingMend.
inline Error makingError(const std::filesystem::path& path, int code, const std::string& other) {
  return outputError(path, "cannot be made: ", systemMessage(code), "; ", writingMend(code, other));
}

/// Error for an input that cannot be read.
inline Error readingError(const std::filesystem::path& path, int code, const std::string& other) {
  return inputError(path, "cannot be read: ", systemMessage(code), "; ", readingMend(code, other));
}

/// Writes all of `content` to the descriptor `file`. Throws Error (output), which names `path`.
inline void writeAll(int file, std::string_view content, const std::filesystem::path& path) {
  while (!content.empty()) {
    const auto written = repeated([&] { return ::write(file, content.data(), content.size()); });
    if (written < 0)
      throw writingError(path, errno);
    content.remove_prefix(static_cast<std::size_t>(written));
  }
}

} // namespace fenestra
