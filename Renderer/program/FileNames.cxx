#include "program/FileNames.h"

#include "io/platform/SystemErrors.h"

#include <utility>

namespace fenestra::core {
namespace {

namespace fs = std::filesystem;

/// Type of the file; none if `path` is no file name (inline JSON) or must not be examined. Throws
/// Error (input) if the file system fails.
fs::file_type findFileType(const fs::path& path) {
  std::error_code failed;
  const fs::file_type type = fs::status(path, failed).type();
  const int code = failed.value();
  if (type == fs::file_type::none && code != ENAMETOOLONG && code != EACCES && code != ELOOP)
    throw readError(path, code, "check its disk");
  return type;
}

fs::path resolvePath(const fs::path& path) {
  std::error_code failed;
  fs::path real = fs::canonical(path, failed);
  if (failed)
    throw readError(path, failed.value(), "check the permissions of its folder");
  return real;
}

/// Relative name of a result, which need not exist yet.
std::string toRelativeOutput(const std::string& name, const fs::path& folder) {
  std::error_code failed;
  const fs::path path = fs::absolute(name, failed);
  if (failed) // without a working directory the result cannot be written either
    return name;
  return (fs::path(toRelativeName(path.parent_path().string(), folder)) / path.filename())
      .lexically_normal()
      .string();
}

} // namespace

std::string toRelativeName(const std::string& name, const fs::path& folder) {
  std::error_code failed;
  fs::path existing = fs::absolute(name, failed), member;
  if (failed) // the working directory was deleted: no file has this name
    return name;
  while (findFileType(existing) == fs::file_type::not_found && existing.has_relative_path()) {
    member = member.empty() ? existing.filename() : existing.filename() / member; // in an archive
    existing = existing.parent_path();
  }
  const fs::path from = folder.empty() ? "." : folder;
  if (findFileType(from) == fs::file_type::not_found) // reported when the result is written
    return name;
  const fs::file_type type = findFileType(existing);
  if (type == fs::file_type::none || (!member.empty() && type != fs::file_type::regular))
    return name;
  const fs::path relative = resolvePath(existing).lexically_relative(resolvePath(from));
  return (member.empty() ? relative : relative / member).string();
}

std::vector<std::string> toRelativeArguments(const std::vector<std::string>& words,
                                             std::span<const Option> options,
                                             const fs::path& folder) {
  const auto convert = [&](const Option* option, const std::string& value) { // null: positional
    if (option && !option->canNameFile())
      return value;
    return option && option->isOutputFile() ? toRelativeOutput(value, folder)
                                            : toRelativeName(value, folder);
  };
  std::vector<std::string> result;
  const Option* pending = nullptr; // option whose value is the next word
  for (const std::string& word : words) {
    const auto parsed = pending ? std::nullopt : parseOptionWord(options, word);
    if (!parsed) {
      result.push_back(word.starts_with("--") && !pending
                           ? word
                           : convert(std::exchange(pending, nullptr), word));
      continue;
    }
    const auto& [option, value] = *parsed;
    const std::size_t head = word.size() - (value ? value->size() : 0);
    result.push_back(word.substr(0, head) + (value ? convert(option, word.substr(head)) : ""));
    if (!value && !option->isSwitch())
      pending = option;
  }
  return result;
}

std::string toCanonicalArgument(const std::string& word, std::span<const Option> options) {
  const auto parsed = parseOptionWord(options, word);
  if (!parsed)
    return word;
  const auto& [option, value] = *parsed;
  return concat("--", option->name, value ? concat("=", *value) : "");
}

} // namespace fenestra::core
