#pragma once
// Errors of failed system calls, with a hint for the user.

#include "base/Error.h"
#include "io/platform/Descriptor.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

namespace fenestra::core {

inline std::string systemMessage(int code) {
  return std::generic_category().message(code);
}

/// Hint for a failed write. `nameHint`: hint if the name or its folder is at fault.
inline std::string writeHint(int code, const std::string& nameHint) {
  switch (code) {
  case ENOSPC:
  case EDQUOT:
  case EFBIG:
    return "free some space, or choose another disk";
  case ENAMETOOLONG:
    return "choose a shorter name";
  case EIO:
    return "check the disk for errors";
  case EMFILE:
  case ENFILE:
    return "close other programs, or raise the limit on open files (ulimit -n)";
  case ENOMEM:
    return "close other programs";
  default:
    return nameHint;
  }
}

/// Hint for a failed read; `nameHint` as in writeHint.
inline std::string readHint(int code, const std::string& nameHint) {
  return code == ELOOP ? "its symbolic links form a loop: name the file itself"
                       : writeHint(code, nameHint);
}

/// Error for a result that cannot be written.
inline Error writeError(const std::filesystem::path& path, int code) {
  return outputError(path, "cannot be written: ", systemMessage(code), "; ",
                     writeHint(code, "name a file in an existing folder that you may write to"));
}

/// Error for a file or folder that cannot be created; `nameHint` as in writeHint.
inline Error createError(const std::filesystem::path& path, int code, const std::string& nameHint) {
  return outputError(path, "cannot be created: ", systemMessage(code), "; ",
                     writeHint(code, nameHint));
}

/// Error for an input that cannot be read.
inline Error readError(const std::filesystem::path& path, int code, const std::string& nameHint) {
  return inputError(ErrorCode::unreadableFile, path, "cannot be read: ", systemMessage(code), "; ",
                    readHint(code, nameHint));
}

/// Writes all of `content` to the descriptor `file`. Throws Error (output), which names `path`.
inline void writeAll(int file, std::string_view content, const std::filesystem::path& path) {
  while (!content.empty()) {
    const auto written =
        retryOnEintr([&] { return ::write(file, content.data(), content.size()); });
    if (written < 0)
      throw writeError(path, errno);
    content.remove_prefix(static_cast<std::size_t>(written));
  }
}

} // namespace fenestra::core
