// Slicer scene archives (.mrb).
#include "SceneInputs.h"

#include <zlib.h>

#include <cstring>

namespace {

template <typename T>
T get(const std::string& bytes, std::size_t at) {
  T value{};
  if (at + sizeof(T) <= bytes.size())
    std::memcpy(&value, &bytes[at], sizeof(T));
  return value;
}

void put(std::string& bytes, std::size_t at, std::uint32_t value) {
  if (at + sizeof(value) <= bytes.size())
    std::memcpy(&bytes[at], &value, sizeof(value));
}

/// Corrects the checksums of stored entries, since libzip rejects every changed entry otherwise.
std::string fixChecksums(std::string zip) {
  // Entry of the central directory: method at 10, checksum at 16, size at 20, local header at 42.
  // Local header of 30 bytes: checksum at 14, lengths of name and extra field at 26 and 28.
  for (std::size_t at = 0; (at = zip.find("PK\1\2", at)) != std::string::npos; at += 4) {
    const std::uint64_t local = get<std::uint32_t>(zip, at + 42);
    const std::uint64_t size = get<std::uint32_t>(zip, at + 20);
    const std::uint64_t data =
        local + 30 + get<std::uint16_t>(zip, local + 26) + get<std::uint16_t>(zip, local + 28);
    if (get<std::uint16_t>(zip, at + 10) != 0 || data + size > zip.size())
      continue;
    const auto sum = static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(zip.data() + data), static_cast<uInt>(size)));
    put(zip, local + 14, sum);
    put(zip, at + 16, sum);
  }
  return zip;
}

} // namespace

FENESTRA_FUZZ(Archive, input) {
  using namespace fenestra::core;
  fuzzing::loadScene(fuzzing::writeInput(fixChecksums(std::string(input)), "scene.mrb"));
}
