#include "io/ReaderProgram.h"

#include "base/Error.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

namespace fenestra::core {
namespace {

/// File that contains this code. From the kernel's list of mapped files (proc(5)): dladdr gives the
/// main program's name as its caller typed it.
std::filesystem::path findThisFile() {
  const auto here = reinterpret_cast<std::uintptr_t>(&findThisFile);
  std::ifstream maps("/proc/self/maps");
  if (!maps)
    throw outputError(ErrorCode::outOfMemory, readerName,
                      "cannot be located: /proc/self/maps is not readable; close other programs");
  for (std::string line; std::getline(maps, line);) { // "begin-end rwxp offset device inode /path"
    std::uintptr_t begin = 0, end = 0;
    const char* const last = line.data() + line.size();
    const auto dash = std::from_chars(line.data(), last, begin, 16);
    if (dash.ptr == last)
      continue;
    std::from_chars(dash.ptr + 1, last, end, 16);
    if (here >= begin && here < end)
      return line.substr(std::min(line.find('/'), line.size()));
  }
  return {};
}

} // namespace

std::filesystem::path findReaderProgram() {
  static const std::filesystem::path code = findThisFile(); // the mapping does not change
  for (const std::filesystem::path& folder :
       {code.parent_path(), code.parent_path() / "fenestra"}) {
    std::error_code failed;
    if (std::filesystem::is_regular_file(folder / readerName, failed))
      return folder / readerName;
  }
  throw outputError(ErrorCode::missingFile, readerName, "not found beside ", code,
                    "; install it there, or in the folder fenestra there");
}

} // namespace fenestra::core
