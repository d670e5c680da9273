#include "files/medical/DicomReader.h"

#include "base/Error.h"

#include <gdcmMediaStorage.h>
#include <gdcmPixmapReader.h>
#include <gdcmReader.h>
#include <gdcmStringFilter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <set>
#include <variant>

namespace fenestra {
namespace {

using Path = std::filesystem::path;
using gdcm::Tag;

constexpr std::uint64_t maxHeaderBytes = 1 << 20;
constexpr std::string_view padding(" \0", 2); ///< of values, to an even length

// ---- header fields, in the order in which the child sends them

void parseField(const std::string& text, std::string& member) {
  member = text;
}
void parseField(const std::string& text, std::vector<double>& member) {
  member = parseDecimals(text);
}
/// Accepts any number. A missing field leaves the default; any other text gives NaN.
void parseField(const std::string& text, double& member) {
  const std::vector<double> numbers = parseDecimals(text);
  if (!text.empty())
    member = numbers.size() == 1 ? numbers[0] : std::nan("");
}
/// Accepts a number from 0 to 2^31. A missing field leaves the default; any other text gives 0.
void parseField(const std::string& text, unsigned& member) {
  double number = member;
  parseField(text, number);
  member = number >= 0.0 && number <= 0x1p31 ? static_cast<unsigned>(number) : 0;
}

struct HeaderField {
  std::uint16_t group, element;
  std::variant<std::string DicomHeader::*, std::vector<double> DicomHeader::*,
               double DicomHeader::*, unsigned DicomHeader::*>
      member;

  Tag tag() const { return {group, element}; }
};

constexpr std::array dicomFields = {
    HeaderField{0x0008, 0x0060, &DicomHeader::modality},
    HeaderField{0x0008, 0x103e, &DicomHeader::seriesDescription},
    HeaderField{0x0018, 0x0010, &DicomHeader::contrastAgent},
    HeaderField{0x0020, 0x000e, &DicomHeader::seriesUid},
    HeaderField{0x0020, 0x0011, &DicomHeader::seriesNumber},
    HeaderField{0x0020, 0x0032, &DicomHeader::position},
    HeaderField{0x0020, 0x0037, &DicomHeader::orientation},
    HeaderField{0x0028, 0x0002, &DicomHeader::samples},
    HeaderField{0x0028, 0x0004, &DicomHeader::photometric},
    HeaderField{0x0028, 0x0008, &DicomHeader::frames},
    HeaderField{0x0028, 0x0010, &DicomHeader::rows},
    HeaderField{0x0028, 0x0011, &DicomHeader::columns},
    HeaderField{0x0028, 0x0030, &DicomHeader::pixelSpacing},
    HeaderField{0x0028, 0x0100, &DicomHeader::bits},
    HeaderField{0x0028, 0x0101, &DicomHeader::bitsStored},
    HeaderField{0x0028, 0x0102, &DicomHeader::highBit},
    HeaderField{0x0028, 0x0103, &DicomHeader::isSigned},
    HeaderField{0x0028, 0x1052, &DicomHeader::intercept},
    HeaderField{0x0028, 0x1053, &DicomHeader::slope},
};

// ---- in the child process

std::string makeHeaderReply(const std::string& path) {
  if (!isDicomFile(path))
    return {};
  std::set<Tag> tags = {Tag(0x0008, 0x0016)}; // SOPClassUID
  for (const HeaderField& field : dicomFields)
    tags.insert(field.tag());
  gdcm::Reader reader;
  reader.SetFileName(path.c_str());
  const bool read = reader.ReadSelectedTags(tags);
  const gdcm::File& file = reader.GetFile();
  const gdcm::TransferSyntax& syntax = file.GetHeader().GetDataSetTransferSyntax();
  gdcm::MediaStorage kind;
  kind.SetFromFile(file);
  const auto flag = [](bool value) { return value ? "1" : "0"; };
  ReplyWriter reply;
  reply.put(flag(gdcm::MediaStorage::IsImage(kind)));
  reply.put(flag(syntax.IsEncapsulated()));
  reply.put(flag(read && syntax != gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian));
  gdcm::StringFilter texts;
  texts.SetFile(file);
  for (const HeaderField& field : dicomFields)
    reply.put(texts.ToString(field.tag()));
  return reply.bytes();
}

/// True if the file contains all `bytes` of the voxels. GDCM silently pads truncated data.
bool hasAllVoxels(const std::string& path, std::uint64_t bytes) {
  const Tag pixelData(0x7fe0, 0x0010);
  gdcm::Reader reader;
  reader.SetFileName(path.c_str());
  return reader.ReadUpToTag(pixelData, {pixelData}) &&
         reader.GetStreamCurrentPosition() + bytes <= std::filesystem::file_size(path);
}

std::string makeVoxelsReply(const std::string& path) {
  gdcm::PixmapReader reader;
  reader.SetFileName(path.c_str());
  if (!reader.Read())
    return {};
  const gdcm::Pixmap& image = reader.GetPixmap();
  const gdcm::SequenceOfFragments* fragments = image.GetDataElement().GetSequenceOfFragments();
  std::string voxels(image.GetBufferLength(), '\0');
  const bool isComplete =
      hasAllVoxels(path, fragments ? fragments->ComputeByteLength() : voxels.size());
  return isComplete && image.GetBuffer(voxels.data()) ? voxels : std::string();
}

/// First character of a request; the path follows.
constexpr char headerRequest = 'h', voxelsRequest = 'v';

std::string handleDicomRequest(const std::string& request) {
  const std::string path = request.substr(1);
  return request[0] == headerRequest ? makeHeaderReply(path) : makeVoxelsReply(path);
}

const SandboxJob dicomJob("dicom", handleDicomRequest);

// ---- voxels

/// Extracts the stored bits of a voxel, sign-extended if signed.
std::int64_t extractStoredValue(const DicomHeader& h, const std::string& voxels,
                                std::size_t voxel) {
  const std::size_t size = h.bits / 8;
  std::uint64_t bits = 0;
  for (std::size_t byte = size; byte-- > 0;)
    bits = bits << 8 | static_cast<unsigned char>(voxels[voxel * size + byte]);
  const std::uint64_t mask = (std::uint64_t{1} << h.bitsStored) - 1;
  const std::int64_t sign = h.isSigned ? std::int64_t{1} << (h.bitsStored - 1) : 0;
  const auto value = static_cast<std::int64_t>(bits >> (h.highBit + 1 - h.bitsStored) & mask);
  return (value ^ sign) - sign;
}

} // namespace

bool isDicomFile(const Path& path) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown))
    return false; // a pipe would block
  std::ifstream file(path, std::ios::binary);
  std::array<char, 132> begin{};
  return file.read(begin.data(), begin.size()) && std::string_view(begin.data() + 128, 4) == "DICM";
}

std::vector<double> parseDecimals(std::string text) {
  std::replace(text.begin(), text.end(), '\\', ' ');
  std::erase(text, '+');
  return parseNumbers(text).value_or(std::vector<double>{});
}

DicomAxes parseAxes(const std::vector<double>& o, const std::string& source) {
  constexpr double tolerance = 1e-2; // real files round their direction cosines
  if (o.size() == 6) {
    const Vec3 row(o[0], o[1], o[2]), column(o[3], o[4], o[5]);
    if (std::abs(row.norm() - 1.0) <= tolerance && std::abs(column.norm() - 1.0) <= tolerance &&
        std::abs(row.dot(column)) <= tolerance)
      return {row.normalized(), column.normalized()};
  }
  throw fieldError(source, "ImageOrientationPatient",
                   "must be two orthogonal directions; export the series again");
}

DicomReader::DicomReader() : m_reader(dicomJob) {}

DicomHeader parseDicomHeader(std::string_view reply) {
  ReplyReader fields(reply);
  DicomHeader header;
  for (bool* flag : {&header.isImageObject, &header.isCompressed, &header.isComplete})
    *flag = fields.text() == "1";
  for (const HeaderField& field : dicomFields)
    std::visit(
        [&](auto member) { parseField(std::string(trim(fields.text(), padding)), header.*member); },
        field.member);
  return header;
}

std::optional<DicomHeader> DicomReader::readHeader(const Path& path) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown))
    return std::nullopt;
  const auto reply = m_reader.request(headerRequest + path.string(), maxHeaderBytes);
  if (reply && reply->empty())
    return std::nullopt;
  try {
    if (reply)
      return parseDicomHeader(*reply);
  } catch (const std::runtime_error&) { // malformed reply
  }
  throw inputError(ErrorCode::unreadableFile, concat(path, ": DICOM header"),
                   "cannot be read; export the series again, or remove the file from its folder");
}

std::string DicomReader::readVoxels(const Path& path, const DicomHeader& h) {
  const std::uint64_t size = imageBytes(h);
  auto reply = m_reader.request(voxelsRequest + path.string(), size);
  if (reply && reply->size() == size)
    return std::move(*reply);
  if (h.isCompressed)
    throw inputError(ErrorCode::damagedFile, concat(path, ": PixelData"),
                     "cannot be decoded; export the series without compression");
  throw inputError(ErrorCode::damagedFile, concat(path, ": PixelData"),
                   "is damaged, truncated or deflated; export the series again");
}

void checkDicomPixels(const Path& path, const DicomHeader& h) {
  const auto refuse = [&](const char* field, const char* what) {
    throw fieldError(path, field, what);
  };
  if (h.rows == 0 || h.columns == 0)
    refuse("Rows or Columns", "is missing; export the series again");
  const bool isSupported = h.bits == 8 || h.bits == 16 || h.bits == 32;
  if (!isSupported || h.bitsStored == 0 || h.highBit >= h.bits || h.bitsStored > h.highBit + 1 ||
      h.isSigned > 1)
    refuse("BitsAllocated, BitsStored or HighBit", "has an unsupported value; save the volume in "
                                                   "Slicer as .nrrd and use that");
  if (!std::isfinite(h.slope) || !std::isfinite(h.intercept))
    refuse("RescaleSlope or RescaleIntercept", "is not one finite number; export the series again");
  // Lossless codecs compress an empty image to almost nothing, and other images at most 1000 to 1.
  constexpr std::uint64_t ratio = 1000, emptyImageBytes = 1 << 24;
  const std::uint64_t stored = std::filesystem::file_size(path);
  const std::uint64_t maxBytes =
      h.isCompressed ? std::max(emptyImageBytes, stored * ratio) : stored;
  if (imageBytes(h) > maxBytes)
    refuse("PixelData",
           "is shorter than Rows, Columns and BitsAllocated say; export the series again");
}

std::vector<double> rescaleVoxels(const DicomHeader& h, const std::string& voxels) {
  std::vector<double> scalars(std::size_t{h.rows} * h.columns);
  for (std::size_t i = 0; i < scalars.size(); ++i)
    scalars[i] = h.slope * static_cast<double>(extractStoredValue(h, voxels, i)) + h.intercept;
  return scalars;
}

} // namespace fenestra
