#include "program/FileNames.h"

#include "base/safe/SystemCalls.h"

#include <utility>

namespace fenestra {
namespace {

namespace fs = std::filesystem;

/// Type of the file; none if `path` names no file (a look as text) or may not be examined. Throws
/// Error (input) if the file system fails.
fs::file_type typeOf(const fs::path& path) {
  std::error_code failed;
  const fs::file_type type = fs::status(path, failed).type();
  const int code = failed.value();
  if (type == fs::file_type::none && code != ENAMETOOLONG && code != EACCES && code != ELOOP)
    throw readError(path, code, "check its disk");
  return type;
}

fs::path realPath(const fs::path& path) {
  std::error_code failed;
  fs::path real = fs::canonical(path, failed);
  if (failed)
    throw readError(path, failed.value(), "check the permissions of its folder");
  return real;
}

/// Relative name of a result, which does not exist yet.
std::string writtenName(const std::string& name, const fs::path& folder) {
  std::error_code failed;
  const fs::path path = fs::absolute(name, failed);
  if (failed) // without a working folder the result cannot be written either
    return name;
  return (fs::path(relativeName(path.parent_path().string(), folder)) / path.filename())
      .lexically_normal()
      .string();
}

} // namespace

std::string relativeName(const std::string& name, const fs::path& folder) {
  std::error_code failed;
  fs::path there = fs::absolute(name, failed), inside;
  if (failed) // the working folder is gone: no file has this name
    return name;
  while (typeOf(there) == fs::file_type::not_found && there.has_relative_path()) {
    inside = inside.empty() ? there.filename() : there.filename() / inside; // in an archive
    there = there.parent_path();
  }
  const fs::path from = folder.empty() ? "." : folder;
  if (typeOf(from) == fs::file_type::not_found) // the later write reports the missing folder
    return name;
  const fs::file_type type = typeOf(there);
  if (type == fs::file_type::none || (!inside.empty() && type != fs::file_type::regular))
    return name;
  const fs::path relative = realPath(there).lexically_relative(realPath(from));
  return (inside.empty() ? relative : relative / inside).string();
}

std::vector<std::string> relativeArguments(const std::vector<std::string>& words,
                                           std::span<const Option> flags, const fs::path& folder) {
  const auto named = [&](const Option* flag, const std::string& value) { // null: a positional's
    if (flag && !flag->canNameFile())
      return value;
    return flag && flag->isOutputFile() ? writtenName(value, folder) : relativeName(value, folder);
  };
  std::vector<std::string> result;
  const Option* pending = nullptr; // flag whose value is the next word
  for (const std::string& word : words) {
    if (pending || !word.starts_with("--")) {
      result.push_back(named(std::exchange(pending, nullptr), word));
      continue;
    }
    const std::size_t equals = word.find('=');
    const Option* const flag = findOption(flags, word.substr(2, equals - 2));
    if (flag && equals != word.npos)
      result.push_back(word.substr(0, equals + 1) + named(flag, word.substr(equals + 1)));
    else
      result.push_back(word);
    if (flag && equals == word.npos && !flag->isSwitch())
      pending = flag;
  }
  return result;
}

} // namespace fenestra
