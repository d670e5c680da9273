#include "files/medical/DicomReader.h"

#include "base/Error.h"
#include "files/medical/DicomFields.h"
#include "files/medical/DicomText.h"
#include "files/medical/SampleStore.h"
#include "io/MessageText.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

namespace fenestra::core {
namespace {

using Path = std::filesystem::path;

constexpr std::string_view padding(" \0", 2); ///< of values, to an even length

// ---- header fields

void parseField(const std::string& text, std::string& member) {
  if (!text.empty())
    member = text;
}
void parseField(const std::string& text, std::vector<double>& member) {
  if (!text.empty())
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
/// Accepts the first of several numbers. Any other text leaves the default.
void parseField(const std::string& text, std::optional<double>& member) {
  if (const std::vector<double> numbers = parseDecimals(text); !numbers.empty())
    member = numbers[0];
}

void takeField(ReplyReader& reply, const DicomField& field, DicomHeader& header) {
  const std::string text(trim(reply.text(), padding));
  std::visit([&](auto member) { parseField(text, header.*member); }, field.member);
}

/// Places frames without positions of their own along the normal, by the spacing that the file
/// states, in the order of the frames or of nuclear medicine's slices.
void placeFrames(std::vector<DicomHeader>& frames) {
  const DicomHeader first = frames.front();
  const std::optional<DicomAxes> axes = findAxes(first.orientation);
  const std::vector<double>& step =
      first.sliceSpacing.empty() ? first.sliceThickness : first.sliceSpacing;
  if (!axes || first.position.size() != 3 || step.size() != 1 || step[0] == 0.0)
    return;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const bool hasSlice = first.sliceVector.size() == frames.size();
    const double slice = hasSlice ? first.sliceVector[i] - 1.0 : static_cast<double>(i);
    for (int axis = 0; axis < 3; ++axis)
      frames[i].position[static_cast<std::size_t>(axis)] += slice * step[0] * axes->normal()[axis];
    frames[i].isPlacedByThickness = first.sliceSpacing.empty();
  }
}

// ---- the beginning of a file

unsigned getShort(std::string_view bytes, std::size_t at) {
  const auto getByte = [&](std::size_t i) -> unsigned {
    return static_cast<unsigned char>(bytes[i]);
  };
  return getByte(at) | getByte(at + 1) << 8;
}

/// Length of a whole element in little endian, its value included; nullopt: implausible.
std::optional<std::size_t> measureElement(std::string_view bytes) {
  constexpr std::size_t header = 8, longest = 256;
  if (bytes.size() < header || getShort(bytes, 2) > 0x0100)
    return std::nullopt;
  constexpr std::array<std::string_view, 12> types = {"AE", "CS", "DA", "DT", "IS", "LO",
                                                      "PN", "SH", "TM", "UI", "UL", "US"};
  const bool isExplicit = std::ranges::find(types, bytes.substr(4, 2)) != types.end();
  if (!isExplicit && getShort(bytes, 6) != 0)
    return std::nullopt;
  const std::size_t length = getShort(bytes, isExplicit ? 6 : 4);
  return length % 2 == 0 && length <= longest ? std::optional(header + length) : std::nullopt;
}

/// True for two elements of the meta information, or of the first group of a data set.
bool beginsWithElements(std::string_view bytes) {
  const auto first = measureElement(bytes);
  if (!first || *first > bytes.size())
    return false;
  const std::string_view next = bytes.substr(*first);
  const unsigned group = getShort(bytes, 0);
  return (group == 0x0002 || group == 0x0008) && measureElement(next) &&
         getShort(next, 0) == group && getShort(next, 2) > getShort(bytes, 2);
}

// ---- transfer syntaxes

/// Throws Error (input) about a transfer syntax that GDCM does not know.
[[noreturn]] void refuseSyntax(const std::string& source, const std::string& uid) {
  constexpr std::array<std::pair<std::string_view, const char*>, 6> names = {
      {{"1.2.840.10008.1.2.4.110", "JPEG XL"},
       {"1.2.840.10008.1.2.4.111", "JPEG XL"},
       {"1.2.840.10008.1.2.4.112", "JPEG XL"},
       {"1.2.840.10008.1.2.4.201", "HTJ2K"},
       {"1.2.840.10008.1.2.4.202", "HTJ2K"},
       {"1.2.840.10008.1.2.4.203", "HTJ2K"}}};
  const auto known = std::ranges::find(names, uid, [](const auto& name) { return name.first; });
  const std::string shown = sanitize(uid);
  throw inputError(ErrorCode::unsupportedFile, source, "is compressed as ",
                   known == names.end() ? concat("transfer syntax ", shown)
                                        : concat(known->second, " (", shown, ")"),
                   ", which is not supported; export the series without compression");
}

// ---- voxels

/// Stored values of voxels of `Word`s; `Stored` has their width and sign.
template <typename Stored, typename Word>
std::vector<Stored> extractVoxels(const DicomHeader& h, const std::string& voxels) {
  constexpr unsigned width = std::numeric_limits<std::make_unsigned_t<Stored>>::digits;
  const unsigned left = width - 1 - h.highBit, right = width - h.bitsStored;
  std::vector<Stored> stored(std::size_t{h.rows} * h.columns);
  for (std::size_t i = 0; i < stored.size(); ++i) {
    Word word;
    std::memcpy(&word, voxels.data() + i * sizeof word, sizeof word);
    stored[i] = static_cast<Stored>(static_cast<Stored>(word << left) >> right);
  }
  return stored;
}

template <typename Number, typename Stored>
std::vector<Number> rescale(const std::vector<Stored>& stored, Number slope, Number intercept) {
  std::vector<Number> scalars(stored.size());
  std::ranges::transform(stored, scalars.begin(), [=](Stored x) {
    if constexpr (std::is_floating_point_v<Number>)
      return slope * static_cast<Number>(x) + intercept;
    else // modulo 2^32, which the compiler narrows
      return static_cast<Number>(static_cast<std::uint32_t>(slope) * static_cast<std::uint32_t>(x) +
                                 static_cast<std::uint32_t>(intercept));
  });
  return scalars;
}

template <typename Stored, typename Word>
RescaledVoxels rescaleStored(const DicomHeader& h, const std::string& voxels) {
  const std::vector<Stored> stored = extractVoxels<Stored, Word>(h, voxels);
  const SampleStats stats = computeStats(std::span(stored));
  const double first = h.slope * stats.minimum + h.intercept,
               last = h.slope * stats.maximum + h.intercept;
  const auto fits = [&]<typename Number>(Number) {
    constexpr double lowest = std::numeric_limits<Number>::min(),
                     highest = std::numeric_limits<Number>::max();
    return std::min(first, last) >= lowest && std::max(first, last) <= highest &&
           h.slope == std::trunc(h.slope) && h.intercept == std::trunc(h.intercept) &&
           std::abs(h.slope) <= highest && std::abs(h.intercept) <= highest;
  };
  const auto make = [&]<typename Number>(Number) {
    return rescale(stored, static_cast<Number>(h.slope), static_cast<Number>(h.intercept));
  };
  if (fits(std::int16_t()))
    return make(std::int16_t());
  if (fits(std::int32_t()))
    return make(std::int32_t());
  return make(double());
}

} // namespace

bool isDicomFile(const Path& path) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown))
    return false; // a pipe would block
  std::ifstream file(path, std::ios::binary);
  std::array<char, 1024> begin{};
  file.read(begin.data(), begin.size());
  const std::string_view bytes(begin.data(), static_cast<std::size_t>(file.gcount()));
  return (bytes.size() >= 132 && bytes.substr(128, 4) == "DICM") || beginsWithElements(bytes);
}

std::vector<double> parseDecimals(std::string text) {
  std::replace(text.begin(), text.end(), '\\', ' ');
  std::erase(text, '+');
  return parseNumbers(text).value_or(std::vector<double>{});
}

std::optional<DicomAxes> findAxes(const std::vector<double>& o) {
  constexpr double tolerance = 1e-2; // real files round their direction cosines
  if (o.size() != 6)
    return std::nullopt;
  const Vec3 row(o[0], o[1], o[2]), column(o[3], o[4], o[5]);
  if (std::abs(row.norm() - 1.0) <= tolerance && std::abs(column.norm() - 1.0) <= tolerance &&
      std::abs(row.dot(column)) <= tolerance)
    return DicomAxes{row.normalized(), column.normalized()};
  return std::nullopt;
}

DicomAxes parseAxes(const std::vector<double>& orientation, const std::string& source) {
  if (const auto axes = findAxes(orientation))
    return *axes;
  throw fieldError(source, "ImageOrientationPatient",
                   "must be two orthogonal directions; export the series again");
}

bool isDicomSegmentation(const DicomHeader& header) {
  return header.modality == "SEG" || header.sopClass == "1.2.840.10008.5.1.4.1.1.66.4" ||
         header.sopClass == "1.2.840.10008.5.1.4.1.1.66.7" ||
         header.sopClass == "1.2.840.10008.5.1.4.1.1.481.3";
}

bool isImage(const DicomHeader& header) {
  return (header.isImageObject || header.rows > 0) && !isDicomSegmentation(header) &&
         header.modality != "RTDOSE";
}

DicomReader::DicomReader() : m_reader(dicomJob), m_frameReader(dicomFramesJob) {}

std::vector<DicomHeader> parseDicomHeaders(std::string_view reply, const std::string& source) {
  constexpr double maxFrames = 1 << 16;
  ReplyReader fields(reply);
  if (const std::string syntax = fields.text(); !syntax.empty())
    refuseSyntax(source, syntax);
  DicomHeader header;
  for (bool* flag :
       {&header.isImageObject, &header.isCompressed, &header.isComplete, &header.isDirectory})
    *flag = fields.text() == "1";
  for (const DicomField& field : dicomFields)
    takeField(fields, field, header);
  header.frames = std::max(1U, header.frames);
  header.seriesDescription = toUtf8(header.seriesDescription, header.characterSet);
  const std::vector<double> groups = fields.numbers();
  if (groups.size() != 1 || !(groups[0] >= 0.0 && groups[0] <= maxFrames))
    throw std::runtime_error("reply has an invalid number of frames");
  const auto count = static_cast<unsigned>(groups[0]);
  if (header.frames == 1 || !isImage(header))
    return {header};
  if (header.frames > maxFrames || (count != 0 && count != header.frames)) {
    header.isComplete = false;
    return {header};
  }
  std::vector<DicomHeader> frames(header.frames, header);
  for (unsigned i = 0; i < header.frames; ++i) {
    frames[i].frame = i;
    frames[i].instance = i;
    for (const DicomField& field : dicomFields)
      if (count != 0 && field.sequence != 0)
        takeField(fields, field, frames[i]);
  }
  if (count == 0)
    placeFrames(frames);
  return frames;
}

std::vector<DicomHeader> DicomReader::readHeaders(const Path& path) {
  constexpr std::uint64_t maxBytes = 1 << 27;
  if (!isDicomFile(path))
    return {};
  const auto reply = m_reader.request(dicomHeaderRequest + path.string(), maxBytes);
  if (reply && reply->empty())
    return {};
  try {
    if (reply)
      return parseDicomHeaders(*reply, path.string());
  } catch (const Error&) {
    throw;
  } catch (const std::runtime_error&) { // malformed reply
  }
  throw inputError(ErrorCode::unreadableFile, concat(path, ": DICOM header"),
                   "cannot be read; export the series again, or remove the file from its folder");
}

std::string DicomReader::readVoxels(const Path& path, const DicomHeader& h) {
  const std::uint64_t size = imageBytes(h);
  const std::uint32_t frame = h.frame;
  std::string request(1, dicomVoxelsRequest);
  request.append(reinterpret_cast<const char*>(&frame), sizeof frame).append(path.string());
  auto reply = (h.frames > 1 ? m_frameReader : m_reader).request(request, size);
  if (reply && reply->size() == size)
    return std::move(*reply);
  if (h.isCompressed)
    throw inputError(ErrorCode::damagedFile, concat(path, ": PixelData"),
                     "cannot be decoded; export the series without compression");
  throw inputError(ErrorCode::damagedFile, concat(path, ": PixelData"),
                   "is damaged or truncated; export the series again");
}

std::uint64_t countPixelBytes(const Path& path, bool isCompressed) {
  // Lossless codecs compress an empty image to almost nothing, and other images at most 1000 to 1.
  constexpr std::uint64_t ratio = 1000, emptyImageBytes = 1 << 24;
  const std::uint64_t stored = std::filesystem::file_size(path);
  return isCompressed ? std::max(emptyImageBytes, stored * ratio) : stored;
}

void checkDicomPixels(const Path& path, const DicomHeader& h) {
  const auto refuse = [&](const char* field, const char* what) {
    throw fieldError(path, field, what);
  };
  constexpr unsigned maxSide = 65535;
  if (h.rows == 0 || h.columns == 0 || h.rows > maxSide || h.columns > maxSide)
    refuse("Rows or Columns", "is missing; export the series again");
  const bool isSupported = h.bits == 8 || h.bits == 16 || h.bits == 32;
  if (!isSupported || h.bitsStored == 0 || h.highBit >= h.bits || h.bitsStored > h.highBit + 1 ||
      h.isSigned > 1)
    refuse("BitsAllocated, BitsStored or HighBit", "has an unsupported value; save the volume in "
                                                   "Slicer as .nrrd and use that");
  if (!std::isfinite(h.slope) || !std::isfinite(h.intercept))
    refuse("RescaleSlope or RescaleIntercept", "is not one finite number; export the series again");
  if (imageBytes(h) > countPixelBytes(path, h.isCompressed) / h.frames)
    refuse("PixelData",
           "is shorter than Rows, Columns and BitsAllocated say; export the series again");
}

RescaledVoxels rescaleVoxels(const DicomHeader& h, const std::string& voxels) {
  static_assert(std::endian::native == std::endian::little);
  if (h.bits == 8)
    return h.isSigned ? rescaleStored<std::int16_t, std::uint8_t>(h, voxels)
                      : rescaleStored<std::uint16_t, std::uint8_t>(h, voxels);
  if (h.bits == 16)
    return h.isSigned ? rescaleStored<std::int16_t, std::uint16_t>(h, voxels)
                      : rescaleStored<std::uint16_t, std::uint16_t>(h, voxels);
  return h.isSigned ? rescaleStored<std::int32_t, std::uint32_t>(h, voxels)
                    : rescaleStored<std::uint32_t, std::uint32_t>(h, voxels);
}

} // namespace fenestra::core
