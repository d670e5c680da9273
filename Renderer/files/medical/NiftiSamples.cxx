#include "files/medical/NiftiSamples.h"

#include "base/Error.h"
#include "files/medical/MghHeader.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <memory>

namespace fenestra::core {
namespace {

Error makeDamagedError(const std::filesystem::path& path) {
  return inputError(ErrorCode::damagedFile, path,
                    "is damaged or truncated; copy or write it again");
}

/// Reads plain and gzip-compressed files.
class NiftiStream {
public:
  explicit NiftiStream(const std::filesystem::path& path)
      : m_path(path), m_file(gzopen(path.c_str(), "rb"), gzclose) {
    if (!m_file)
      throw inputError(ErrorCode::unreadableFile, path, "cannot be read; check its permissions");
    gzbuffer(m_file.get(), 1 << 18);
  }

  void read(void* to, std::size_t bytes) {
    auto* at = static_cast<char*>(to);
    while (bytes > 0) {
      const auto part = static_cast<unsigned>(std::min<std::size_t>(bytes, 1 << 30));
      if (gzread(m_file.get(), at, part) != static_cast<int>(part))
        throw makeDamagedError(m_path);
      at += part;
      bytes -= part;
    }
  }

  void seek(std::int64_t offset) {
    if (gzseek(m_file.get(), offset, SEEK_SET) != offset)
      throw makeDamagedError(m_path);
  }

  void skip(std::uint64_t bytes) {
    if (gzseek(m_file.get(), static_cast<z_off_t>(bytes), SEEK_CUR) < 0)
      throw makeDamagedError(m_path);
  }

  /// Reads beyond the samples, so that zlib verifies the checksum if the stream ends within 1024
  /// bytes.
  void checkEnd() {
    std::array<char, 1024> rest;
    if (gzread(m_file.get(), rest.data(), rest.size()) < 0)
      throw makeDamagedError(m_path);
  }

private:
  std::filesystem::path m_path;
  std::unique_ptr<std::remove_pointer_t<gzFile>, int (*)(gzFile)> m_file;
};

} // namespace

NiftiHeader readNiftiHeader(const std::filesystem::path& path, const VolumeChoice& choice) {
  NiftiStream stream(findNiftiFiles(path).header);
  std::string bytes(nifti1Bytes, '\0');
  stream.read(bytes.data(), bytes.size());
  bytes.resize(countNiftiHeaderBytes(bytes));
  stream.read(&bytes[nifti1Bytes], bytes.size() - nifti1Bytes);
  return parseNiftiHeader(bytes, path, choice);
}

NiftiHeader readMghHeader(const std::filesystem::path& path) {
  NiftiStream stream(path);
  std::string bytes(mghHeaderBytes, '\0');
  stream.read(bytes.data(), bytes.size());
  return parseMghHeader(bytes, path);
}

std::string readNiftiExtensions(const std::filesystem::path& path, const NiftiHeader& header) {
  constexpr std::int64_t maxBytes = std::int64_t{4} << 20;
  if (header.end == 0)
    return {};
  const std::int64_t bytes = header.offset - header.end;
  std::string text(static_cast<std::size_t>(std::clamp<std::int64_t>(bytes, 0, maxBytes)), '\0');
  NiftiStream stream(path);
  stream.seek(header.end);
  stream.read(text.data(), text.size());
  // The first of four bytes states whether there are extensions.
  return text.size() > 4 && text[0] != 0 ? text.substr(4) : std::string();
}

SampleSource openNiftiSamples(const std::filesystem::path& path, const StoredSamples& stored,
                              const NiftiHeader& header, std::size_t count) {
  const auto offset = static_cast<std::uint64_t>(header.offset);
  checkDeclaredBytes(path, stored, count, bytesPerSample(header.type),
                     stored.isCompressed ? offset : offset - stored.offset);
  const auto stream = std::make_shared<NiftiStream>(stored.files.back());
  stream->seek(header.offset);
  return {
      .type = header.type,
      .count = count,
      .isSwapped = header.isSwapped,
      .rescaling = header.rescaling,
      .read = [stream](void* to, std::size_t bytes) { stream->read(to, bytes); },
      .skip = [stream](std::uint64_t bytes) { stream->skip(bytes); },
      .finish = [stream] { stream->checkEnd(); },
  };
}

} // namespace fenestra::core
