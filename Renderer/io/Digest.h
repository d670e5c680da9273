#pragma once
// Digest of bytes, the same on every machine. Not cryptographic: detects damage, not tampering.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace fenestra::core {

/// Chained mixing of words of eight bytes: two contents that differ within one aligned word always
/// have different digests.
class Digest {
public:
  void add(std::string_view bytes);
  /// Digest of all bytes so far and of their number.
  std::uint64_t value() const;

private:
  std::uint64_t m_state = 0, m_size = 0;
  std::string m_rest; ///< bytes of an incomplete word
};

/// Digest of the first `bytes` bytes of a file, or of all if it is shorter, read in blocks. Throws
/// Error (input) if the file cannot be read.
std::uint64_t computeDigest(const std::filesystem::path& file, std::uint64_t bytes = UINT64_MAX);

} // namespace fenestra::core
