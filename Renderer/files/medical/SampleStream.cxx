#include "files/medical/SampleStream.h"

#include "base/Error.h"

#include <zlib.h>

#include <algorithm>
#include <fstream>
#include <memory>

namespace fenestra {
namespace {

class SampleStream {
public:
  SampleStream(const std::filesystem::path& path, const StoredSamples& stored,
               std::uint64_t declared)
      : m_path(path),
        m_file(stored.files.front(), std::ios::binary),
        m_declared(declared),
        m_compressed(stored.isStream) {
    m_file.seekg(static_cast<std::streamoff>(stored.offset));
    if (!m_compressed)
      return;
    m_input.resize(1 << 18);
    constexpr int anyHeader = 15 + 32; // zlib's or gzip's
    m_status = inflateInit2(&m_stream, anyHeader);
  }

  ~SampleStream() {
    if (m_compressed)
      inflateEnd(&m_stream);
  }
  SampleStream(const SampleStream&) = delete;
  SampleStream& operator=(const SampleStream&) = delete;

  void read(void* to, std::size_t bytes) {
    if (!m_compressed) {
      if (!m_file.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes)))
        throw inputError(m_path, "cannot be read to the end of its samples; copy it again");
      return;
    }
    auto* at = static_cast<Bytef*>(to);
    while (bytes > 0) {
      const auto part = static_cast<uInt>(std::min<std::size_t>(bytes, 1 << 30));
      m_stream.next_out = at;
      m_stream.avail_out = part;
      while (m_status == Z_OK && m_stream.avail_out > 0)
        inflateNext();
      if (m_stream.avail_out > 0)
        throw damaged();
      at += part;
      bytes -= part;
    }
  }

  void finish() {
    if (!m_compressed)
      return;
    Bytef beyond = 0;
    m_stream.next_out = &beyond;
    m_stream.avail_out = 1;
    while (m_status == Z_OK && m_stream.avail_out > 0)
      inflateNext();
    if (m_status != Z_STREAM_END || m_stream.total_out != m_declared)
      throw damaged();
  }

private:
  /// Inflates some of the requested bytes, or sets a status other than Z_OK.
  void inflateNext() {
    if (m_stream.avail_in == 0) {
      m_file.read(m_input.data(), static_cast<std::streamsize>(m_input.size()));
      m_stream.next_in = reinterpret_cast<Bytef*>(m_input.data());
      m_stream.avail_in = static_cast<uInt>(m_file.gcount());
    }
    m_status = inflate(&m_stream, Z_NO_FLUSH); // without input left: Z_BUF_ERROR
  }

  Error damaged() const {
    return inputError(m_path, "is damaged or truncated: its compressed samples do not give the ",
                      m_declared, " bytes that its header announces; copy or write it again");
  }

  std::filesystem::path m_path;
  std::ifstream m_file;
  std::uint64_t m_declared;
  bool m_compressed;
  std::vector<char> m_input;
  z_stream m_stream{};
  int m_status = Z_OK;
};

} // namespace

void openStream(const std::filesystem::path& path, const StoredSamples& stored,
                std::uint64_t declared, SampleSource& source) {
  const auto stream = std::make_shared<SampleStream>(path, stored, declared);
  source.read = [stream](void* to, std::size_t bytes) { stream->read(to, bytes); };
  source.finish = [stream] { stream->finish(); };
}

} // namespace fenestra
