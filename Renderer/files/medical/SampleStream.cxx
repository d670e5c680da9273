#include "files/medical/SampleStream.h"

#include "base/Error.h"

#include <zlib.h>

#include <fstream>
#include <memory>

namespace fenestra::core {
namespace {

/// One zlib or gzip stream that starts at the file's current position.
class InflatedSamples {
public:
  InflatedSamples(const std::filesystem::path& path, std::ifstream file, std::uint64_t declared)
      : m_path(path), m_file(std::move(file)), m_declared(declared) {
    constexpr int anyHeader = 15 + 32; // detects zlib and gzip headers
    m_status = inflateInit2(&m_stream, anyHeader);
  }
  ~InflatedSamples() { inflateEnd(&m_stream); }
  InflatedSamples(const InflatedSamples&) = delete;
  InflatedSamples& operator=(const InflatedSamples&) = delete;

  void read(void* to, std::size_t bytes) {
    if (inflateTo(to, bytes) < bytes)
      throw makeDamagedError();
  }

  void finish() {
    char extra = 0;
    inflateTo(&extra, 1);
    if (m_status != Z_STREAM_END || m_stream.total_out != m_declared)
      throw makeDamagedError();
  }

private:
  /// Returns the number of bytes; fewer than `bytes` if the stream ends or is damaged.
  std::size_t inflateTo(void* to, std::size_t bytes) {
    m_stream.next_out = static_cast<Bytef*>(to);
    m_stream.avail_out = static_cast<uInt>(bytes);
    while (m_status == Z_OK && m_stream.avail_out > 0) {
      if (m_stream.avail_in == 0) {
        m_file.read(m_input.data(), static_cast<std::streamsize>(m_input.size()));
        m_stream.next_in = reinterpret_cast<Bytef*>(m_input.data());
        m_stream.avail_in = static_cast<uInt>(m_file.gcount());
      }
      m_status = inflate(&m_stream, Z_NO_FLUSH); // Z_BUF_ERROR at the end of the file
    }
    return bytes - m_stream.avail_out;
  }

  Error makeDamagedError() const {
    return inputError(ErrorCode::damagedFile, m_path,
                      "is damaged or truncated: its compressed samples do not inflate to ",
                      m_declared, " bytes as its header declares; copy or write it again");
  }

  std::filesystem::path m_path;
  std::ifstream m_file;
  std::uint64_t m_declared;
  std::vector<char> m_input = std::vector<char>(1 << 18);
  z_stream m_stream{};
  int m_status = Z_OK;
};

} // namespace

void openStream(const std::filesystem::path& path, const StoredSamples& stored,
                std::uint64_t declared, SampleSource& source) {
  std::ifstream file(stored.files.front(), std::ios::binary);
  file.seekg(static_cast<std::streamoff>(stored.offset));
  if (stored.isStream) {
    const auto samples = std::make_shared<InflatedSamples>(path, std::move(file), declared);
    source.read = [samples](void* to, std::size_t bytes) { samples->read(to, bytes); };
    source.finish = [samples] { samples->finish(); };
    return;
  }
  const auto samples = std::make_shared<std::ifstream>(std::move(file));
  source.read = [path, samples](void* to, std::size_t bytes) {
    if (!samples->read(static_cast<char*>(to), static_cast<std::streamsize>(bytes)))
      throw inputError(ErrorCode::unreadableFile, path,
                       "cannot be read to the end of its samples; copy it again");
  };
  source.skip = [samples](std::uint64_t bytes) {
    samples->seekg(static_cast<std::streamoff>(bytes), std::ios::cur);
  };
}

} // namespace fenestra::core
