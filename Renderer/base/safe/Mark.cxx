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

using TakeBlock = std::function<void(std::string_view block, std::uint64_t begin)>;

/// Passes the file, which may have any size, to `take` block by block.
void readBlocks(const std::filesystem::path& path, const TakeBlock& take) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> block(1 << 20);
  for (std::uint64_t begin = 0;
       file.read(block.data(), static_cast<std::streamsize>(block.size())) || file.gcount() > 0;) {
    const std::string_view bytes(block.data(), static_cast<std::size_t>(file.gcount()));
    take(bytes, begin);
    begin += bytes.size();
  }
}

/// Offsets of the digits of the last marks. A file of ours has its own mark last, after the marks
/// of files that it contains.
std::vector<std::uint64_t> marksIn(const std::filesystem::path& path) {
  constexpr std::ptrdiff_t mostMarks = 4; // each costs a pass through the file
  std::vector<std::uint64_t> marks;
  std::string text; // tail of the previous block, too short to hold a mark, then the current block
  readBlocks(path, [&](std::string_view block, std::uint64_t begin) {
    const std::uint64_t textBegin = begin - text.size();
    text += block;
    for (std::size_t at = text.find(markText); at != std::string::npos;
         at = text.find(markText, at + 1))
      marks.push_back(textBegin + at + markText.size());
    marks.erase(marks.begin(),
                marks.end() - std::min<std::ptrdiff_t>(mostMarks, std::ssize(marks)));
    text.erase(0, text.size() - std::min(text.size(), markText.size() - 1));
  });
  return marks;
}

/// True if the digits at `at` equal the checksum.
bool isSealed(const std::filesystem::path& path, std::uint64_t at) {
  uLong sum = 0;
  std::string digits;
  readBlocks(path, [&](std::string_view block, std::uint64_t begin) {
    const auto part = [&](std::uint64_t from, std::uint64_t to) { // intersection with the block
      const std::uint64_t end = begin + block.size();
      const std::uint64_t first = std::clamp(from, begin, end), last = std::clamp(to, begin, end);
      return block.substr(static_cast<std::size_t>(first - begin),
                          static_cast<std::size_t>(last - first));
    };
    sum = checksumOf(sum, part(0, at));
    digits += part(at, at + checksumDigits);
    sum = checksumOf(sum, part(at + checksumDigits + behind, UINT64_MAX));
  });
  return digits == digitsOf(sum);
}

} // namespace

std::string sealed(std::string content) {
  const std::size_t at = content.rfind(unsealedMark) + markText.size();
  return content.replace(at, checksumDigits, checksum(content, at));
}

bool bearsMark(const std::filesystem::path& path) {
  const std::vector<std::uint64_t> marks = marksIn(path);
  return std::any_of(marks.begin(), marks.end(),
                     [&path](std::uint64_t at) { return isSealed(path, at); });
}

} // namespace fenestra
