#include "cli/FileNames.h"

namespace fenestra {
namespace {

namespace fs = std::filesystem;

bool takesFile(const Flag& flag) {
  return std::string_view(flag.value).find("FILE") != std::string_view::npos;
}

/// A result is named before it is there.
std::string writtenName(const std::string& name, const fs::path& folder) {
  const fs::path path = fs::absolute(name);
  return (fs::path(relativeName(path.parent_path().string(), folder)) / path.filename())
      .lexically_normal()
      .string();
}

} // namespace

std::string relativeName(const std::string& name, const fs::path& folder) {
  std::error_code failed;
  fs::path there = fs::absolute(name), inside;
  while (!fs::exists(there, failed) && there.has_relative_path()) { // a member of an archive
    inside = inside.empty() ? there.filename() : there.filename() / inside;
    there = there.parent_path();
  }
  if (!inside.empty() && !fs::is_regular_file(there, failed))
    return name;
  const fs::path from = fs::canonical(folder.empty() ? "." : folder, failed);
  const fs::path relative = fs::canonical(there, failed).lexically_relative(from);
  return failed || relative.empty() ? name
                                    : (inside.empty() ? relative : relative / inside).string();
}

std::vector<std::string> relativeArguments(const std::vector<std::string>& words,
                                           std::span<const Flag> flags, const fs::path& folder) {
  std::vector<std::string> result;
  const Flag* pending = nullptr; // whose value is the next word
  for (const std::string& word : words) {
    const bool isFlag = !pending && word.starts_with("--");
    const std::size_t equals = isFlag ? word.find('=') : std::string::npos;
    const Flag* flag = isFlag ? findFlag(flags, word.substr(2, equals - 2)) : pending;
    const bool hasValue = !isFlag || equals != std::string::npos;
    const std::size_t valueAt = isFlag ? equals + 1 : 0;
    pending = flag && !hasValue && *flag->value ? flag : nullptr;
    if (!hasValue || (flag ? !takesFile(*flag) : isFlag)) {
      result.push_back(word);
      continue;
    }
    const std::string value = word.substr(valueAt);
    result.push_back(word.substr(0, valueAt) + (flag && isWritten(*flag)
                                                    ? writtenName(value, folder)
                                                    : relativeName(value, folder)));
  }
  return result;
}

} // namespace fenestra
