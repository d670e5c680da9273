#include "io/ProvenanceTag.h"

#include "base/PhysicalMemory.h"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>

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

} // namespace

std::string sealProvenanceTag(std::string content) {
  const std::size_t at = content.rfind(blankProvenanceTag) + tagText.size();
  return content.replace(at, checksumDigits, computeChecksum(content, at));
}

bool hasProvenanceTag(const std::filesystem::path& path) {
  constexpr double maxFraction = 0.25; // of the memory; encoders need more for a file of their own
  constexpr int maxTags = 4;           // each takes a pass through the content
  std::error_code failed;
  const std::uintmax_t size = std::filesystem::file_size(path, failed);
  if (failed || static_cast<double>(size) > maxFraction * physicalMemory())
    return false;
  std::string content(size, '\0');
  std::ifstream(path, std::ios::binary).read(content.data(), static_cast<std::streamsize>(size));
  std::size_t at = content.rfind(tagText);
  for (int i = 0; i < maxTags && at != std::string::npos; ++i) {
    const std::size_t digits = at + tagText.size();
    if (content.compare(digits, checksumDigits, computeChecksum(content, digits)) == 0)
      return true;
    at = at > 0 ? content.rfind(tagText, at - 1) : std::string::npos;
  }
  return false;
}

} // namespace fenestra::core
