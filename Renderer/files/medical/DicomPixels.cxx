#include "files/medical/DicomPixels.h"

#include "base/Error.h"

#include <algorithm>
#include <cmath>

namespace fenestra {
namespace {

using Path = std::filesystem::path;

/// Values of the voxels' stored bits.
class StoredValues {
public:
  StoredValues(const DicomHeader& h, const std::string& voxels)
      : m_voxels(voxels),
        m_size(h.bits / 8),
        m_shift(h.highBit + 1 - h.bitsStored),
        m_mask((std::uint64_t{1} << h.bitsStored) - 1),
        m_sign(h.isSigned ? std::int64_t{1} << (h.bitsStored - 1) : 0) {}

  std::int64_t operator[](std::size_t i) const {
    std::uint64_t bits = 0;
    for (std::size_t byte = 0; byte < m_size; ++byte) {
      const std::size_t at = i * m_size + m_size - 1 - byte;
      bits = bits << 8 | static_cast<unsigned char>(m_voxels[at]);
    }
    const auto value = static_cast<std::int64_t>(bits >> m_shift & m_mask);
    return (value ^ m_sign) - m_sign;
  }

private:
  const std::string& m_voxels;
  std::size_t m_size;
  unsigned m_shift;
  std::uint64_t m_mask;
  std::int64_t m_sign;
};

} // namespace

void checkDicomPixels(const Path& path, const DicomHeader& h) {
  const auto refuse = [&](const char* what) { throw inputError(path, what); };
  if (h.rows == 0 || h.columns == 0)
    refuse("Rows or Columns: is missing; export the series again");
  const bool known = h.bits == 8 || h.bits == 16 || h.bits == 32;
  if (!known || h.bitsStored == 0 || h.highBit >= h.bits || h.bitsStored > h.highBit + 1 ||
      h.isSigned > 1)
    refuse("BitsAllocated, BitsStored or HighBit: has a value that is not read; save the volume in "
           "Slicer as .nrrd and name that");
  if (!std::isfinite(h.slope) || !std::isfinite(h.intercept))
    refuse("RescaleSlope or RescaleIntercept: is not one finite number; export the series again");
  // Lossless codecs pack an empty picture into next to nothing, and any other 1000 to 1 at most.
  constexpr std::uint64_t ratio = 1000, emptyPicture = 1 << 24;
  const std::uint64_t stored = std::filesystem::file_size(path);
  const std::uint64_t most = h.compressed ? std::max(emptyPicture, stored * ratio) : stored;
  if (imageBytes(h) > most)
    refuse(
        "PixelData: is shorter than Rows, Columns and BitsAllocated say; export the series again");
}

DicomSamples rescaledVoxels(const DicomHeader& h, const std::string& voxels) {
  const StoredValues stored(h, voxels);
  const double slope = h.slope, intercept = h.intercept;
  const std::size_t count = std::size_t{h.rows} * h.columns;
  const auto fill = [&](auto values, auto value) -> DicomSamples {
    for (std::size_t i = 0; i < count; ++i)
      values[i] = value(stored[i]);
    return values;
  };
  const double greatest =
      std::abs(slope) * std::ldexp(1.0, static_cast<int>(h.bitsStored)) + std::abs(intercept);
  if (slope == std::trunc(slope) && intercept == std::trunc(intercept) && greatest < 0x1p31)
    return fill(std::vector<std::int32_t>(count),
                [a = static_cast<std::int64_t>(slope), b = static_cast<std::int64_t>(intercept)](
                    std::int64_t x) { return static_cast<std::int32_t>(a * x + b); });
  return fill(std::vector<double>(count),
              [=](std::int64_t x) { return slope * static_cast<double>(x) + intercept; });
}

} // namespace fenestra
