#include "io/ProvenanceTag.h"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <vector>

namespace fenestra::core {
namespace {

constexpr std::size_t checksumDigits = 8, trailingBytes = 4;
constexpr std::string_view tagText =
    blankProvenanceTag.substr(0, blankProvenanceTag.size() - checksumDigits);

uLong updateChecksum(uLong before, std::string_view bytes) {
  return crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
}

std::string formatChecksum(uLong sum) {
  char digits[checksumDigits + 1];
  std::snprintf(digits, sizeof digits, "%08lx", sum);
  return digits;
}

/// Checksum of `content` without the digits at `at` and the `trailingBytes` bytes after them.
std::string computeChecksum(std::string_view content, std::size_t at) {
  const std::size_t rest = std::min(content.size(), at + checksumDigits + trailingBytes);
  return formatChecksum(
      updateChecksum(updateChecksum(0, content.substr(0, at)), content.substr(rest)));
}

/// Calls take(block) for the bytes from `begin` to `end`, or to the end of the file, in blocks.
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

/// Offsets of the digits of the last tags. Fenestra's files have their own tag last, after the tags
/// of files that they contain.
std::vector<std::uint64_t> findTags(std::istream& file) {
  constexpr std::ptrdiff_t maxTags = 4; // each takes a pass through the file
  std::vector<std::uint64_t> tags;
  std::string text; // tail of the previous block, too short for a tag, then the current block
  std::uint64_t textBegin = 0;
  readBlocks(file, 0, UINT64_MAX, [&](std::string_view block) {
    text += block;
    for (std::size_t at = text.find(tagText); at != std::string::npos;
         at = text.find(tagText, at + 1))
      tags.push_back(textBegin + at + tagText.size());
    tags.erase(tags.begin(), tags.end() - std::min<std::ptrdiff_t>(maxTags, std::ssize(tags)));
    const std::size_t done = text.size() - std::min(text.size(), tagText.size() - 1);
    text.erase(0, done);
    textBegin += done;
  });
  return tags;
}

/// True if the digits at `at` equal the checksum.
bool isTagValid(std::istream& file, std::uint64_t at) {
  uLong sum = 0;
  std::string digits;
  const auto add = [&sum](std::string_view block) { sum = updateChecksum(sum, block); };
  readBlocks(file, 0, at, add);
  readBlocks(file, at, at + checksumDigits, [&](std::string_view block) { digits += block; });
  readBlocks(file, at + checksumDigits + trailingBytes, UINT64_MAX, add);
  return digits == formatChecksum(sum);
}

} // namespace

std::string sealProvenanceTag(std::string content) {
  const std::size_t at = content.rfind(blankProvenanceTag) + tagText.size();
  return content.replace(at, checksumDigits, computeChecksum(content, at));
}

bool hasProvenanceTag(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return std::ranges::any_of(findTags(file),
                             [&](std::uint64_t at) { return isTagValid(file, at); });
}

} // namespace fenestra::core
