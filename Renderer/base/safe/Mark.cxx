#include "base/safe/Mark.h"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <vector>

namespace fenestra {
namespace {

constexpr std::size_t checksumDigits = 8, behind = 4;
constexpr std::string_view markText = unsealedMark.substr(0, unsealedMark.size() - checksumDigits);

uLong checksumOf(uLong before, std::string_view bytes) {
  return crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
}

std::string digitsOf(uLong sum) {
  char digits[checksumDigits + 1];
  std::snprintf(digits, sizeof digits, "%08lx", sum);
  return digits;
}

/// Checksum of `content` without the digits at `at` and the `behind` bytes after them.
std::string checksum(std::string_view content, std::size_t at) {
  const std::size_t rest = std::min(content.size(), at + checksumDigits + behind);
  return digitsOf(checksumOf(checksumOf(0, content.substr(0, at)), content.substr(rest)));
}

/// Passes the bytes from `begin` to `end`, or to the file's own end, to `take` block by block.
void readBlocks(std::istream& file, std::uint64_t begin, std::uint64_t end,
                const std::function<void(std::string_view block)>& take) {
  file.clear();
  file.seekg(static_cast<std::streamoff>(begin));
  std::vector<char> block(std::min<std::uint64_t>(1 << 20, end - begin));
  while (begin < end && file) {
    const auto most = std::min<std::uint64_t>(block.size(), end - begin);
    file.read(block.data(), static_cast<std::streamsize>(most));
    take({block.data(), static_cast<std::size_t>(file.gcount())});
    begin += most;
  }
}

/// Offsets of the digits of the last marks. A file of ours has its own mark last, after the marks
/// of files that it contains.
std::vector<std::uint64_t> marksIn(std::istream& file) {
  constexpr std::ptrdiff_t mostMarks = 4; // each costs a pass through the file
  std::vector<std::uint64_t> marks;
  std::string text; // tail of the previous block, too short to hold a mark, then the current block
  std::uint64_t textBegin = 0;
  readBlocks(file, 0, UINT64_MAX, [&](std::string_view block) {
    text += block;
    for (std::size_t at = text.find(markText); at != std::string::npos;
         at = text.find(markText, at + 1))
      marks.push_back(textBegin + at + markText.size());
    marks.erase(marks.begin(),
                marks.end() - std::min<std::ptrdiff_t>(mostMarks, std::ssize(marks)));
    const std::size_t done = text.size() - std::min(text.size(), markText.size() - 1);
    text.erase(0, done);
    textBegin += done;
  });
  return marks;
}

/// True if the digits at `at` equal the checksum.
bool isSealed(std::istream& file, std::uint64_t at) {
  uLong sum = 0;
  std::string digits;
  const auto add = [&sum](std::string_view block) { sum = checksumOf(sum, block); };
  readBlocks(file, 0, at, add);
  readBlocks(file, at, at + checksumDigits, [&](std::string_view block) { digits += block; });
  readBlocks(file, at + checksumDigits + behind, UINT64_MAX, add);
  return digits == digitsOf(sum);
}

} // namespace

std::string sealed(std::string content) {
  const std::size_t at = content.rfind(unsealedMark) + markText.size();
  return content.replace(at, checksumDigits, checksum(content, at));
}

bool bearsMark(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return std::ranges::any_of(marksIn(file), [&](std::uint64_t at) { return isSealed(file, at); });
}

} // namespace fenestra
