#pragma once
// System calls on files as they are meant: repeated where a signal interrupts them, and what their
// error codes mean for a user, with the mend.

#include "base/Error.h"

#include <cerrno>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

#include <unistd.h>

namespace fenestra {

inline std::string systemMessage(int code) {
  return std::generic_category().message(code);
}

/// Mend for a file or folder that cannot be read or written whatever its name; empty where the name
/// or its folder is what is wrong.
inline std::string resourceMend(int code) {
  switch (code) {
  case EIO:
    return "its disk fails: check it";
  case EMFILE:
  case ENFILE:
    return "close other programs, or raise the limit on open files (ulimit -n)";
  case ENOMEM:
    return "close other programs";
  default:
    return {};
  }
}

/// The same for reading, and `other` where neither a resource nor the name is what is wrong.
inline std::string readingMend(int code, const std::string& other) {
  switch (code) {
  case ELOOP:
    return "its links lead to each other: name the file itself";
  case ENAMETOOLONG:
    return "choose a shorter name";
  default:
    const std::string mend = resourceMend(code);
    return mend.empty() ? other : mend;
  }
}

/// The same for writing, and `other` where the name is what is wrong.
inline std::string writingMend(int code, const std::string& other) {
  switch (code) {
  case ENOSPC:
  case EDQUOT:
  case EFBIG:
    return "free some space, or choose another disk";
  case ENAMETOOLONG:
    return "choose a shorter name";
  default:
    const std::string mend = resourceMend(code);
    return mend.empty() ? other : mend;
  }
}

/// A result that cannot be written.
inline Error writingError(const std::filesystem::path& path, int code) {
  return outputError(
      path.string(),
      "cannot be written: " + systemMessage(code) + "; " +
          writingMend(code, "name a file in an existing folder that you may write to"));
}

/// An input that cannot be read.
inline Error readingError(const std::filesystem::path& path, int code, const std::string& other) {
  return inputError(path.string(),
                    "cannot be read: " + systemMessage(code) + "; " + readingMend(code, other));
}

/// What `call` returns once no signal interrupts it.
template <typename Call>
auto repeated(Call&& call) {
  auto result = call();
  while (result < 0 && errno == EINTR)
    result = call();
  return result;
}

/// All of `content` to a descriptor; `path` names it. Throws Error (output).
inline void writeAll(int file, std::string_view content, const std::filesystem::path& path) {
  while (!content.empty()) {
    const auto written = repeated([&] { return ::write(file, content.data(), content.size()); });
    if (written < 0)
      throw writingError(path, errno);
    content.remove_prefix(static_cast<std::size_t>(written));
  }
}

} // namespace fenestra
