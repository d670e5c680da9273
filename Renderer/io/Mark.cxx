#include "io/Mark.h"

#include <zlib.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>

namespace fenestra {
namespace {

constexpr std::size_t checksumDigits = 8, behind = 4;
constexpr std::string_view markText = unsealedMark.substr(0, unsealedMark.size() - checksumDigits);

uLong checksumOf(uLong before, std::string_view bytes) {
  return crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
}

/// Of everything but the digits at `at` and what is behind them.
std::string checksum(std::string_view content, std::size_t at) {
  const std::size_t rest = std::min(content.size(), at + checksumDigits + behind);
  const uLong sum = checksumOf(checksumOf(0, content.substr(0, at)), content.substr(rest));
  char digits[checksumDigits + 1];
  std::snprintf(digits, sizeof digits, "%08lx", sum);
  return digits;
}

} // namespace

std::string sealed(std::string content) {
  const std::size_t at = content.rfind(unsealedMark) + markText.size();
  return content.replace(at, checksumDigits, checksum(content, at));
}

bool bearsMark(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string content(std::istreambuf_iterator<char>(file), {});
  for (std::size_t at = content.find(markText); at != std::string::npos;
       at = content.find(markText, at)) {
    at += markText.size();
    if (content.compare(at, checksumDigits, checksum(content, at)) == 0)
      return true;
  }
  return false;
}

} // namespace fenestra
