#include "files/medical/NiftiSamples.h"

#include "base/Error.h"
#include "files/medical/MedicalHeader.h"

#include <nifti1.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <span>
#include <utility>

namespace fenestra {
namespace {

Error damaged(const std::filesystem::path& path) {
  return inputError(path, "is damaged or truncated; copy or write it again");
}

/// Reads plain and compressed files alike.
class NiftiStream {
public:
  explicit NiftiStream(const std::filesystem::path& path)
      : m_path(path), m_file(gzopen(path.c_str(), "rb"), gzclose) {
    if (!m_file)
      throw inputError(path, "cannot be read; check its permissions");
    gzbuffer(m_file.get(), 1 << 18);
  }

  void read(void* to, std::size_t bytes) {
    if (gzfread(to, 1, bytes, m_file.get()) != bytes)
      throw damaged(m_path);
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

/// True if the geometry fields that apply are below 1e9: ITK ends the process for numbers that are
/// not finite, or whose squares are not.
bool isPlaced(const nifti_1_header& h) {
  const auto sane = [](std::span<const float> numbers) {
    return std::ranges::all_of(numbers, [](float x) { return std::abs(x) < 1e9f; });
  };
  const bool isQuaternion = sane(
      std::array{h.quatern_b, h.quatern_c, h.quatern_d, h.qoffset_x, h.qoffset_y, h.qoffset_z});
  const bool isMatrix = sane(h.srow_x) && sane(h.srow_y) && sane(h.srow_z);
  return sane(std::span(h.pixdim).first(4)) && (h.qform_code == 0 || isQuaternion) &&
         (h.sform_code == 0 || isMatrix);
}

/// False for a slope of 0 or NaN: samples as they are.
bool isScaled(const nifti_1_header& h) {
  return !std::isnan(h.scl_slope) && h.scl_slope != 0.0f;
}

struct NiftiHeader : nifti_1_header {
  bool swapped = false;
};

/// Swaps the bytes of the fields that are used here.
void swapFields(nifti_1_header& h) {
  const auto swapEach = [](auto&... fields) { (swapBytes(fields), ...); };
  swapEach(h.sizeof_hdr, h.datatype, h.vox_offset, h.scl_slope, h.scl_inter, h.qform_code,
           h.sform_code, h.quatern_b, h.quatern_c, h.quatern_d, h.qoffset_x, h.qoffset_y,
           h.qoffset_z);
  std::ranges::for_each(h.dim, swapBytes<short>);
  for (const std::span<float> numbers : {std::span<float>(h.pixdim), std::span<float>(h.srow_x),
                                         std::span<float>(h.srow_y), std::span<float>(h.srow_z)})
    std::ranges::for_each(numbers, swapBytes<float>);
}

NiftiHeader readNiftiHeader(const std::filesystem::path& path, NiftiStream& stream) {
  NiftiHeader h{};
  static_assert(sizeof(nifti_1_header) == niftiHeaderBytes);
  stream.read(static_cast<nifti_1_header*>(&h), niftiHeaderBytes);
  const auto isAxes = [&h] { return h.dim[0] >= 1 && h.dim[0] <= 7; };
  h.swapped = !isAxes();
  if (h.swapped)
    swapFields(h);
  const bool sized = isAxes() && std::all_of(h.dim + 1, h.dim + 1 + h.dim[0],
                                             [](short voxels) { return voxels >= 1; });
  constexpr float farthest = 1 << 30;
  if (std::cmp_not_equal(h.sizeof_hdr, niftiHeaderBytes) || !sized ||
      std::memcmp(h.magic, "n+1", 4) != 0 || !(h.vox_offset <= farthest))
    throw inputError(path, "is not a NIfTI-1 file of one part; write it again as .nii.gz");
  if (isScaled(h) && !(std::isfinite(h.scl_slope) && std::isfinite(h.scl_inter)))
    throw inputError(path, "scl_slope or scl_inter: is not finite; write them again");
  if (!isPlaced(h))
    throw inputError(path, "qform, sform or pixdim: holds a number that is not finite or beyond "
                           "1e9 mm; write it again");
  return h;
}

SampleType niftiType(const std::filesystem::path& path, const NiftiHeader& header) {
  static const std::map<int, SampleType> types = {
      {DT_UINT8, std::uint8_t()},   {DT_INT16, std::int16_t()},   {DT_INT32, std::int32_t()},
      {DT_FLOAT32, float()},        {DT_FLOAT64, double()},       {DT_INT8, std::int8_t()},
      {DT_UINT16, std::uint16_t()}, {DT_UINT32, std::uint32_t()}, {DT_INT64, std::int64_t()},
      {DT_UINT64, std::uint64_t()}};
  const auto type = types.find(header.datatype);
  if (type == types.end())
    throw inputError(path, "datatype: ", header.datatype,
                     " is no real scalar; convert it to 16-bit integers");
  return type->second;
}

} // namespace

void checkNiftiHeader(const std::filesystem::path& path) {
  NiftiStream stream(path);
  niftiType(path, readNiftiHeader(path, stream));
}

SampleSource niftiSamples(const std::filesystem::path& path, std::size_t count) {
  const auto stream = std::make_shared<NiftiStream>(path);
  const NiftiHeader header = readNiftiHeader(path, *stream);
  SampleSource source{
      .type = niftiType(path, header),
      .count = count,
      .swapped = header.swapped,
      .read = [stream](void* to, std::size_t bytes) { stream->read(to, bytes); },
      .finish = [stream] { stream->checkEnd(); },
  };
  if (isScaled(header) && (header.scl_slope != 1.0f || header.scl_inter != 0.0f))
    source.rescaling = {header.scl_slope, header.scl_inter};
  // Samples follow the header and four bytes that announce extensions.
  const auto offset = static_cast<std::int64_t>(std::max(header.vox_offset, 352.0f));
  checkedBytes(path, locateSamples(path, MedicalFormat::nifti), count, bytesOf(source.type),
               static_cast<std::uint64_t>(offset) - niftiHeaderBytes);
  stream->seek(offset);
  return source;
}

} // namespace fenestra
