#include "files/medical/NiftiSamples.h"

#include "base/Error.h"
#include "files/medical/MedicalHeader.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>

namespace fenestra {
namespace {

Error damaged(const std::filesystem::path& path) {
  return inputError(path, "is damaged or truncated; copy or write it again");
}

/// Reads plain and compressed files alike.
class Stream {
public:
  explicit Stream(const std::filesystem::path& path)
      : m_path(path), m_file(gzopen(path.c_str(), "rb"), gzclose) {
    if (!m_file)
      throw inputError(path, "cannot be read; check its permissions");
    gzbuffer(m_file.get(), 1 << 18);
  }

  void read(void* to, std::size_t bytes) {
    auto* at = static_cast<char*>(to);
    while (bytes > 0) {
      const auto part = static_cast<unsigned>(std::min<std::size_t>(bytes, 1 << 30));
      if (gzread(m_file.get(), at, part) != static_cast<int>(part))
        throw damaged(m_path);
      at += part;
      bytes -= part;
    }
  }

  void seek(std::int64_t offset) {
    if (gzseek(m_file.get(), offset, SEEK_SET) != offset)
      throw damaged(m_path);
  }

  /// Reads on, so that zlib compares checksums if the stream ends within 1024 bytes.
  void checkEnd() {
    std::array<char, 1024> rest;
    if (gzread(m_file.get(), rest.data(), rest.size()) < 0)
      throw damaged(m_path);
  }

private:
  std::filesystem::path m_path;
  std::unique_ptr<std::remove_pointer_t<gzFile>, int (*)(gzFile)> m_file;
};

using HeaderBytes = std::array<char, 348>;

/// A field of nifti_1_header, by its offset.
template <typename T>
T fieldAt(const HeaderBytes& bytes, std::size_t at, bool swapped) {
  T value;
  std::memcpy(&value, &bytes[at], sizeof(T));
  if (swapped)
    swapBytes(value);
  return value;
}

/// True if the geometry fields that apply are below 1e9: ITK ends the process for numbers that are
/// not finite, or whose squares are not.
bool isPlaced(const HeaderBytes& bytes, bool swapped) {
  const auto sane = [&](std::size_t at, std::size_t count) {
    for (std::size_t end = at + 4 * count; at < end; at += 4)
      if (!(std::abs(fieldAt<float>(bytes, at, swapped)) < 1e9f))
        return false;
    return true;
  };
  const bool qform = fieldAt<std::int16_t>(bytes, 252, swapped) != 0;
  const bool sform = fieldAt<std::int16_t>(bytes, 254, swapped) != 0;
  return sane(76, 4) && (!qform || sane(256, 6)) && (!sform || sane(280, 12));
}

/// Fields of nifti_1_header that samples depend on.
struct Header {
  bool swapped = false;
  std::int16_t type = 0;
  float offset = 0.0f, slope = 0.0f, intercept = 0.0f;

  bool rescales() const { return isScaled() && (slope != 1.0f || intercept != 0.0f); }
  /// False for a slope of 0 or NaN: samples as they are.
  bool isScaled() const { return !std::isnan(slope) && slope != 0.0f; }
};

Header readHeader(const std::filesystem::path& path, Stream& stream) {
  HeaderBytes bytes;
  stream.read(bytes.data(), bytes.size());
  Header header;
  const auto field = [&]<typename T>(std::size_t at, T& value) {
    value = fieldAt<T>(bytes, at, header.swapped);
  };
  std::int16_t axes = 0;
  field(40, axes); // 1 to 7 tells the byte order
  header.swapped = axes < 1 || axes > 7;
  field(40, axes);
  bool sized = axes >= 1 && axes <= 7;
  for (std::size_t axis = 1; sized && axis <= static_cast<std::size_t>(axes); ++axis) {
    std::int16_t voxels = 0;
    field(40 + 2 * axis, voxels);
    sized = voxels >= 1;
  }
  std::int32_t size = 0;
  field(0, size);
  field(70, header.type);
  field(108, header.offset);
  field(112, header.slope);
  field(116, header.intercept);
  constexpr float farthest = 1 << 30;
  if (size != static_cast<std::int32_t>(bytes.size()) || !sized ||
      std::memcmp(&bytes[344], "n+1", 4) != 0 || !(header.offset <= farthest))
    throw inputError(path, "is not a NIfTI-1 file of one part; write it again as .nii.gz");
  if (header.isScaled() && !(std::isfinite(header.slope) && std::isfinite(header.intercept)))
    throw inputError(path, "scl_slope or scl_inter: is not finite; write them again");
  if (!isPlaced(bytes, header.swapped))
    throw inputError(path, "qform, sform or pixdim: holds a number that is not finite or beyond "
                           "1e9 mm; write it again");
  return header;
}

/// Refuses more bytes of samples than the file can hold.
void checkBytes(const std::filesystem::path& path, std::int64_t offset, std::uint64_t count,
                std::uint64_t sampleBytes) {
  std::uint64_t end = 0;
  if (__builtin_mul_overflow(count, sampleBytes, &end) ||
      __builtin_add_overflow(end, static_cast<std::uint64_t>(offset) - 348, &end))
    end = UINT64_MAX;
  checkCapacity(path, locateSamples(path, MedicalFormat::nifti), end);
}

SampleType typeOf(const std::filesystem::path& path, const Header& header) {
  static const std::map<std::int16_t, SampleType> types = {
      // NIFTI_TYPE_… of nifti1.h
      {2, std::uint8_t()},    {4, std::int16_t()},    {8, std::int32_t()},
      {16, float()},          {64, double()},         {256, std::int8_t()},
      {512, std::uint16_t()}, {768, std::uint32_t()}, {1024, std::int64_t()},
      {1280, std::uint64_t()}};
  const auto type = types.find(header.type);
  if (type == types.end())
    throw inputError(path, "datatype: ", header.type,
                     " is no real scalar; convert it to 16-bit integers");
  return type->second;
}

} // namespace

void checkNiftiHeader(const std::filesystem::path& path) {
  Stream stream(path);
  typeOf(path, readHeader(path, stream));
}

SampleSource niftiSamples(const std::filesystem::path& path, std::size_t count) {
  const auto stream = std::make_shared<Stream>(path);
  const Header header = readHeader(path, *stream);
  SampleSource source{
      .type = typeOf(path, header),
      .count = count,
      .swapped = header.swapped,
      .read = [stream](void* to, std::size_t bytes) { stream->read(to, bytes); },
      .finish = [stream] { stream->checkEnd(); },
  };
  if (header.rescales())
    source.rescaling = {header.slope, header.intercept};
  // Samples follow the header and four bytes that announce extensions.
  const auto offset = static_cast<std::int64_t>(std::max(header.offset, 352.0f));
  checkBytes(path, offset, count, bytesOf(source.type));
  stream->seek(offset);
  return source;
}

} // namespace fenestra
