#pragma once
// Bytes of samples, as stored, or inflated from one zlib or gzip stream.

#include "base/Error.h"
#include "files/medical/MedicalHeader.h"

#include <zlib.h>

#include <fstream>
#include <vector>

namespace fenestra {

/// Reads samples that locateSamples found to be `isRaw` or `isStream`, from the first byte on.
class SampleStream {
public:
  /// `path` is for messages; `declared` bytes have passed checkCapacity.
  SampleStream(const std::filesystem::path& path, const StoredSamples& stored,
               std::uint64_t declared);
  ~SampleStream();
  SampleStream(const SampleStream&) = delete;
  SampleStream& operator=(const SampleStream&) = delete;

  /// Reads the next bytes. Throws Error (input) where the samples end before.
  void read(void* to, std::size_t bytes);

  /// Call after the declared bytes are read: throws Error (input) unless a compressed stream ends
  /// there, with the right checksum.
  void finish();

private:
  void inflateNext();
  Error damaged() const;

  std::filesystem::path m_path;
  std::ifstream m_file;
  std::uint64_t m_declared;
  bool m_compressed;
  std::vector<char> m_input;
  z_stream m_stream{};
  int m_status = Z_OK;
};

} // namespace fenestra
