#include "io/medical/DicomPixels.h"

#include "core/Error.h"
#include "io/Apart.h"

#include <gdcmFragment.h>
#include <gdcmImage.h>
#include <gdcmSequenceOfFragments.h>

#include <cmath>
#include <fstream>
#include <optional>

namespace fenestra {
namespace {

using Path = std::filesystem::path;

std::uint64_t imageBytes(const DicomHeader& h) {
  return std::uint64_t{h.rows} * h.columns * (h.bits / 8);
}

std::uint64_t storedBytes(const DicomHeader& h) {
  std::uint64_t bytes = 0;
  for (const DicomFragment& fragment : h.pixels)
    bytes += fragment.length;
  return bytes;
}

[[noreturn]] void throwUndecodable(const Path& path) {
  throw inputError(path.string(),
                   "PixelData: cannot be decoded; export the series without compression");
}

// ---- compressed voxels
// --------------------------------------------------------------------------

struct PictureSize {
  std::uint64_t rows = 0, columns = 0;
};

/// Of a JPEG, JPEG-LS or JPEG 2000 codestream; nothing where it is none.
std::optional<PictureSize> codestreamSize(const std::string& bytes) {
  const auto number = [&](std::size_t at, int count) {
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i)
      value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]);
    return value;
  };
  if (bytes.starts_with("\xff\x4f\xff\x51") && bytes.size() >= 24) // SIZ begins with extents
    return PictureSize{number(12, 4) - number(20, 4), number(8, 4) - number(16, 4)};
  if (!bytes.starts_with("\xff\xd8"))
    return std::nullopt;
  for (std::size_t at = 2; at + 9 <= bytes.size() && number(at, 1) == 0xff;) {
    const std::uint64_t marker = number(at + 1, 1);
    const bool isTable = marker == 0xc4 || marker == 0xc8 || marker == 0xcc;
    if ((marker >= 0xc0 && marker <= 0xcf && !isTable) || marker == 0xf7) // SOF, JPEG-LS's
      return PictureSize{number(at + 5, 2), number(at + 7, 2)};
    at += 2 + number(at + 2, 2);
  }
  return std::nullopt;
}

/// The compressed parts, one after the other in the file.
std::vector<std::string> fragmentsOf(const Path& path, const DicomHeader& h, std::ifstream& file) {
  std::vector<std::string> parts;
  for (const DicomFragment& place : h.pixels) {
    std::string part(static_cast<std::size_t>(place.length), '\0');
    file.seekg(static_cast<std::streamoff>(place.begin));
    if (!file.read(part.data(), static_cast<std::streamsize>(part.size())))
      throwUndecodable(path);
    parts.push_back(std::move(part));
  }
  return parts;
}

/// GDCM's work; false where it cannot.
bool decode(const DicomHeader& h, const std::vector<std::string>& parts, std::uint64_t size,
            char* voxels) {
  const gdcm::SmartPointer<gdcm::SequenceOfFragments> fragments = new gdcm::SequenceOfFragments;
  for (const std::string& part : parts) {
    gdcm::Fragment fragment;
    fragment.SetByteValue(part.data(), static_cast<std::uint32_t>(part.size()));
    fragments->AddFragment(fragment);
  }
  gdcm::DataElement element(gdcm::Tag(0x7fe0, 0x0010), gdcm::VL(0xffffffff), gdcm::VR::OB);
  element.SetValue(*fragments);
  gdcm::Image image;
  image.SetNumberOfDimensions(2);
  image.SetDimension(0, h.columns);
  image.SetDimension(1, h.rows);
  image.SetTransferSyntax(gdcm::TransferSyntax::GetTSType(h.transferSyntax.c_str()));
  const auto two = [](unsigned value) { return static_cast<std::uint16_t>(value); };
  image.SetPixelFormat(
      gdcm::PixelFormat(1, two(h.bits), two(h.bitsStored), two(h.highBit), two(h.isSigned)));
  image.SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
  image.SetDataElement(element);
  return image.GetBufferLength() == size && image.GetBuffer(voxels);
}

std::string decompressed(const Path& path, const DicomHeader& h, std::ifstream& file) {
  const std::vector<std::string> parts = fragmentsOf(path, h, file);
  std::string bytes;
  for (const std::string& part : parts)
    bytes += part;
  const bool isRle = h.transferSyntax == "1.2.840.10008.1.2.5";
  const auto size = codestreamSize(bytes);
  if (gdcm::TransferSyntax::GetTSType(h.transferSyntax.c_str()) == gdcm::TransferSyntax::TS_END)
    throwUndecodable(path);
  if (!isRle && (!size || size->rows != h.rows || size->columns != h.columns))
    throwUndecodable(path);
  const std::uint64_t expected = imageBytes(h);
  auto voxels = filledApart(static_cast<std::size_t>(expected), [&](char* place) {
    return decode(h, parts, expected, place); // damaged streams crash it
  });
  if (!voxels)
    throwUndecodable(path);
  return std::move(*voxels);
}

// ---- stored values
// ------------------------------------------------------------------------------

std::string rawVoxels(const Path& path, const DicomHeader& h) {
  std::ifstream file(path, std::ios::binary);
  if (h.compressed)
    return decompressed(path, h, file);
  std::string voxels(static_cast<std::size_t>(imageBytes(h)), '\0');
  file.seekg(static_cast<std::streamoff>(h.pixels.front().begin));
  if (!file.read(voxels.data(), static_cast<std::streamsize>(voxels.size())))
    throwUndecodable(path);
  return voxels;
}

/// The value in the stored bits of each voxel.
class StoredValues {
public:
  StoredValues(const DicomHeader& h, const std::string& voxels)
      : m_voxels(voxels),
        m_size(h.bits / 8),
        m_reversed(h.bigEndian && !h.compressed),
        m_shift(h.highBit + 1 - h.bitsStored),
        m_mask((std::uint64_t{1} << h.bitsStored) - 1),
        m_sign(h.isSigned ? std::int64_t{1} << (h.bitsStored - 1) : 0) {}

  std::int64_t operator[](std::size_t i) const {
    std::uint64_t bits = 0;
    for (std::size_t byte = 0; byte < m_size; ++byte) {
      const std::size_t at = i * m_size + (m_reversed ? byte : m_size - 1 - byte);
      bits = bits << 8 | static_cast<unsigned char>(m_voxels[at]);
    }
    const auto value = static_cast<std::int64_t>(bits >> m_shift & m_mask);
    return (value ^ m_sign) - m_sign;
  }

private:
  const std::string& m_voxels;
  std::size_t m_size;
  bool m_reversed;
  unsigned m_shift;
  std::uint64_t m_mask;
  std::int64_t m_sign;
};

double only(const std::vector<double>& numbers, double fallback) {
  return numbers.size() == 1 ? numbers[0] : fallback;
}

} // namespace

void checkDicomPixels(const Path& path, const DicomHeader& h) {
  const auto refuse = [&](const char* what) { throw inputError(path.string(), what); };
  if (h.rows == 0 || h.columns == 0)
    refuse("Rows or Columns: is missing; export the series again");
  const bool known = h.bits == 8 || h.bits == 16 || h.bits == 32;
  if (!known || (h.bits == 8 && h.bigEndian) || h.bitsStored == 0 || h.highBit >= h.bits ||
      h.bitsStored > h.highBit + 1 || h.isSigned > 1)
    refuse("BitsAllocated, BitsStored or HighBit: is none that is read; save the volume in Slicer "
           "as .nrrd and name that");
  // Lossless codecs make next to nothing of an empty picture; beyond that, a thousandth at most.
  constexpr std::uint64_t ratio = 1000, emptyPicture = 1 << 24;
  const std::uint64_t most =
      h.compressed ? std::max(emptyPicture, storedBytes(h) * ratio) : storedBytes(h);
  if (imageBytes(h) > most)
    refuse(
        "PixelData: is shorter than Rows, Columns and BitsAllocated say; export the series again");
}

DicomSamples readDicomPixels(const Path& path, const DicomHeader& h) {
  const std::string voxels = rawVoxels(path, h);
  const StoredValues stored(h, voxels);
  const double slope = only(h.slope, 1.0), intercept = only(h.intercept, 0.0);
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
