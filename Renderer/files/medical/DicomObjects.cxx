#include "files/medical/DicomObjects.h"

#include "base/Error.h"
#include "files/medical/DicomDataSet.h"
#include "files/medical/DicomText.h"
#include "io/MessageText.h"

#include <gdcmPixmap.h>
#include <gdcmReader.h>

#include <cmath>
#include <cstring>
#include <map>

namespace fenestra::core {
namespace {

using Path = std::filesystem::path;
using gdcm::DataSet;
using gdcm::Tag;

/// First word of the child's description.
constexpr std::string_view segmentationKind = "segmentation", structureSetKind = "structure set";

// ---- in the child process: segmentations

/// Code of the first item of a code sequence, like "SCT^39607008"; empty: missing.
std::string getCode(const DataSet& data, const Tag& tag) {
  const DicomItems codes(data, tag);
  const std::string value = codes.size() > 0 ? getText(codes[0], {0x0008, 0x0100}) : "";
  return value.empty() ? value : concat(getText(codes[0], {0x0008, 0x0102}), '^', value);
}

void describeSegments(const DataSet& data, ReplyWriter& reply) {
  const DicomItems segments(data, {0x0062, 0x0002});
  reply.put(std::vector{static_cast<double>(segments.size())});
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const DataSet& segment = segments[i];
    reply.put(getShorts(segment, {0x0062, 0x0004}));
    reply.put(getText(segment, {0x0062, 0x0005}));
    reply.put(getShorts(segment, {0x0062, 0x000d}));
    reply.put(getCode(segment, {0x0062, 0x0003}));
    reply.put(getCode(segment, {0x0062, 0x000f}));
    reply.put(getCode(segment, {0x0008, 0x2218}));
  }
}

/// Functional groups of one frame: its own, else those that all frames share.
class FunctionalGroups {
public:
  FunctionalGroups(const DataSet& own, const DicomItems& shared) : m_own(own), m_shared(shared) {}

  /// get(item, tag) of the first item of a group's sequence.
  template <typename Get>
  auto find(const Tag& sequence, const Tag& tag, const Get& get) const {
    if (const DicomItems group(m_own, sequence); group.size() > 0)
      return get(group[0], tag);
    if (m_shared.size() > 0)
      if (const DicomItems group(m_shared[0], sequence); group.size() > 0)
        return get(group[0], tag);
    return get(DataSet(), tag);
  }

private:
  const DataSet& m_own;
  const DicomItems& m_shared;
};

void describeFrames(const DataSet& data, ReplyWriter& reply) {
  const DicomItems shared(data, {0x5200, 0x9229}), frames(data, {0x5200, 0x9230});
  reply.put(std::vector{static_cast<double>(frames.size())});
  const Tag measures(0x0028, 0x9110);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FunctionalGroups groups(frames[i], shared);
    reply.put(groups.find({0x0062, 0x000a}, {0x0062, 0x000b}, getShorts));
    reply.put(groups.find({0x0020, 0x9113}, {0x0020, 0x0032}, getDecimals));
    reply.put(groups.find({0x0020, 0x9116}, {0x0020, 0x0037}, getDecimals));
    reply.put(groups.find(measures, {0x0028, 0x0030}, getDecimals));
    reply.put(groups.find(measures, {0x0018, 0x0088}, getDecimals));
    reply.put(groups.find(measures, {0x0018, 0x0050}, getDecimals));
  }
}

void describeSegmentation(const gdcm::File& file, ReplyWriter& reply) {
  const DataSet& data = file.GetDataSet();
  const auto& syntax = file.GetHeader().GetDataSetTransferSyntax();
  reply.put(syntax.IsEncapsulated() || isDeflated(file) ? "1" : "0");
  reply.put(getText(data, {0x0062, 0x0001}));
  for (const Tag& tag : {Tag(0x0028, 0x0010), Tag(0x0028, 0x0011), Tag(0x0028, 0x0100)})
    reply.put(getShorts(data, tag));
  reply.put(getShorts(data, {0x0062, 0x000e}));
  describeSegments(data, reply);
  describeFrames(data, reply);
}

// ---- in the child process: structure sets

void describeContours(const DataSet& roi, ReplyWriter& reply) {
  const DicomItems contours(roi, {0x3006, 0x0040});
  std::vector<std::size_t> closed;
  for (std::size_t i = 0; i < contours.size(); ++i)
    if (const std::string type = getText(contours[i], {0x3006, 0x0042});
        type.starts_with("CLOSED_PLANAR") || type == "CLOSEDPLANAR_XOR") // the former: or a suffix
      closed.push_back(i);
  reply.put(std::vector{static_cast<double>(closed.size())});
  for (const std::size_t i : closed)
    reply.put(getDecimals(contours[i], {0x3006, 0x0050}));
}

void describeStructureSet(const DataSet& data, ReplyWriter& reply) {
  const DicomItems names(data, {0x3006, 0x0020}), rois(data, {0x3006, 0x0039});
  reply.put(std::vector{static_cast<double>(names.size())});
  for (std::size_t i = 0; i < names.size(); ++i) {
    reply.put(getDecimals(names[i], {0x3006, 0x0022}));
    reply.put(getText(names[i], {0x3006, 0x0026}));
  }
  reply.put(std::vector{static_cast<double>(rois.size())});
  for (std::size_t i = 0; i < rois.size(); ++i) {
    reply.put(getDecimals(rois[i], {0x3006, 0x0084}));
    reply.put(getDecimals(rois[i], {0x3006, 0x002a}));
    describeContours(rois[i], reply);
  }
}

// ---- in the child process: requests

std::string describeObject(const std::string& path) {
  limitMemoryByFile(path);
  gdcm::Reader partial, complete;
  gdcm::Reader* reader = &partial;
  partial.SetFileName(path.c_str());
  if (!partial.ReadUpToTag(pixelData, {pixelData})) {
    if (!isDeflated(partial.GetFile()))
      return {};
    reader = &complete; // GDCM reads deflated data sets only as a whole
    complete.SetFileName(path.c_str());
    if (!complete.Read())
      return {};
  }
  const gdcm::File& file = reader->GetFile();
  const DataSet& data = file.GetDataSet();
  const std::string uid = getText(data, {0x0008, 0x0016});
  ReplyWriter reply;
  if (uid == "1.2.840.10008.5.1.4.1.1.66.4" || uid == "1.2.840.10008.5.1.4.1.1.66.7") {
    reply.put(segmentationKind);
    reply.put(getText(data, {0x0008, 0x0005}));
    describeSegmentation(file, reply);
  } else if (uid == "1.2.840.10008.5.1.4.1.1.481.3") {
    reply.put(structureSetKind);
    reply.put(getText(data, {0x0008, 0x0005}));
    describeStructureSet(data, reply);
  } else {
    reply.put(getText(data, {0x0008, 0x0060})); // modality, for the message
  }
  return reply.bytes();
}

/// True if the file contains all `bytes` of pixels that are not compressed. GDCM silently pads
/// truncated data.
bool hasAllBytes(const std::string& path, std::uint64_t bytes) {
  gdcm::Reader reader;
  reader.SetFileName(path.c_str());
  return reader.ReadUpToTag(pixelData, {pixelData}) &&
         reader.GetStreamCurrentPosition() + bytes <= std::filesystem::file_size(path);
}

/// Compressed pixels. Not by gdcm::PixmapReader, which does not know label maps.
std::string decodePixels(const gdcm::File& file, const gdcm::TransferSyntax& syntax) {
  const DataSet& data = file.GetDataSet();
  const auto getNumber = [](const std::vector<double>& numbers) {
    return numbers.size() == 1 ? static_cast<unsigned>(numbers[0]) : 0U;
  };
  const unsigned bits = getNumber(getShorts(data, {0x0028, 0x0100}));
  if ((bits != 8 && bits != 16) || !data.FindDataElement(pixelData))
    return {};
  gdcm::Pixmap image;
  image.SetNumberOfDimensions(3);
  image.SetDimension(0, getNumber(getShorts(data, {0x0028, 0x0011})));
  image.SetDimension(1, getNumber(getShorts(data, {0x0028, 0x0010})));
  image.SetDimension(2, getNumber(getDecimals(data, {0x0028, 0x0008})));
  const auto depth = static_cast<unsigned short>(bits);
  image.SetPixelFormat(gdcm::PixelFormat(1, depth, depth, static_cast<unsigned short>(depth - 1)));
  image.SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
  image.SetTransferSyntax(syntax);
  image.SetDataElement(data.GetDataElement(pixelData));
  std::string bytes(image.GetBufferLength(), '\0');
  return image.GetBuffer(bytes.data()) ? bytes : std::string();
}

/// All pixels of a file, decompressed; empty: unreadable.
std::string readPixels(const std::string& path) {
  gdcm::Reader reader;
  reader.SetFileName(path.c_str());
  if (!reader.Read())
    return {};
  const gdcm::File& file = reader.GetFile();
  const auto& syntax = file.GetHeader().GetDataSetTransferSyntax();
  if (!syntax.IsEncapsulated()) {
    std::string bytes = getBytes(file.GetDataSet(), pixelData);
    return isDeflated(file) || hasAllBytes(path, bytes.size()) ? bytes : std::string();
  }
  return decodePixels(file, syntax);
}

struct FramesRequest {
  std::uint64_t firstBit, bits;
};

/// First character of a request.
constexpr char descriptionRequest = 'd', framesRequest = 'f';

/// Handles the requests to one reader. Keeps the pixels of a file for the next requests.
class ObjectHandler {
public:
  std::string operator()(const std::string& request) {
    const SuppressGdcmOutput suppress;
    if (request[0] == descriptionRequest)
      return describeObject(request.substr(1));
    FramesRequest part{};
    std::memcpy(&part, request.data() + 1, sizeof part);
    return makeFramesReply(part, request.substr(1 + sizeof part));
  }

private:
  std::string makeFramesReply(const FramesRequest& part, const std::string& path) {
    if (m_read != path) {
      limitMemoryByFile(path);
      m_pixels = readPixels(path);
      m_read = path;
    }
    const std::uint64_t first = part.firstBit / 8, end = (part.firstBit + part.bits + 7) / 8;
    return end <= m_pixels.size() ? m_pixels.substr(first, end - first) : std::string();
  }

  std::string m_read, m_pixels;
};

} // namespace

const SandboxJob objectJob("dicom-objects", ObjectHandler(),
                           {.seconds = 10, .bytes = std::uint64_t{4} << 30});

namespace {

// ---- in the parent: parses descriptions

std::int32_t toInteger(const std::vector<double>& numbers) {
  const bool isInteger = numbers.size() == 1 && std::abs(numbers[0]) <= 0x7fffffff;
  return isInteger ? static_cast<std::int32_t>(numbers[0]) : 0;
}

/// Number of items that follow in the reply.
std::size_t takeCount(ReplyReader& reply) {
  const std::int32_t count = toInteger(reply.numbers());
  if (count < 0)
    throw std::runtime_error("reply has a negative count");
  return static_cast<std::size_t>(count);
}

DicomSegmentation takeSegmentation(ReplyReader& reply, const std::string& characterSet) {
  DicomSegmentation object;
  object.isCompressed = reply.text() == "1";
  object.type = reply.text();
  object.rows = toInteger(reply.numbers());
  object.columns = toInteger(reply.numbers());
  object.bits = toInteger(reply.numbers());
  object.maximum = toInteger(reply.numbers());
  for (std::size_t i = takeCount(reply); i > 0; --i) {
    DicomSegment& segment = object.segments.emplace_back();
    segment.number = toInteger(reply.numbers());
    segment.label = toUtf8(reply.text(), characterSet);
    segment.color = reply.numbers();
    for (std::string* code : {&segment.category, &segment.type, &segment.region})
      *code = toOneLine(reply.text());
  }
  for (std::size_t i = takeCount(reply); i > 0; --i) {
    DicomFrame& frame = object.frames.emplace_back();
    frame.segment = toInteger(reply.numbers());
    for (std::vector<double>* list : {&frame.position, &frame.orientation, &frame.pixelSpacing,
                                      &frame.spacingBetweenSlices, &frame.sliceThickness})
      *list = reply.numbers();
  }
  return object;
}

/// Contours refer to names by number; if no number is stated, the order decides.
DicomStructureSet takeStructureSet(ReplyReader& reply, const std::string& characterSet) {
  DicomStructureSet object;
  for (std::size_t i = takeCount(reply); i > 0; --i) {
    DicomRoi& roi = object.rois.emplace_back();
    roi.number = toInteger(reply.numbers());
    roi.name = toUtf8(reply.text(), characterSet);
  }
  std::map<std::int32_t, std::size_t> indices;
  for (std::size_t i = 0; i < object.rois.size(); ++i)
    indices.emplace(object.rois[i].number, i);
  const std::size_t count = takeCount(reply);
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<double> number = reply.numbers();
    const auto found = indices.find(toInteger(number));
    std::size_t index = found == indices.end() ? object.rois.size() : found->second;
    if (number.empty() && i < indices.size())
      index = i;
    if (index == object.rois.size())
      object.rois.push_back({.number = toInteger(number)});
    object.rois[index].color = reply.numbers();
    for (std::size_t left = takeCount(reply); left > 0; --left)
      object.rois[index].contours.push_back(reply.numbers());
  }
  return object;
}

} // namespace

DicomObject parseDicomObject(std::string_view bytes, const std::string& source) {
  ReplyReader reply(bytes);
  const std::string kind = reply.text();
  if (kind != segmentationKind && kind != structureSetKind)
    throw inputError(ErrorCode::unsupportedFile, source, "is a DICOM object of modality ",
                     kind.empty() ? "unknown" : sanitize(kind),
                     ", not a segmentation; give a SEG or RTSTRUCT file");
  const std::string characterSet = reply.text();
  if (kind == segmentationKind)
    return takeSegmentation(reply, characterSet);
  return takeStructureSet(reply, characterSet);
}

DicomObjectReader::DicomObjectReader() : m_reader(objectJob) {}

DicomObject DicomObjectReader::read(const Path& path) {
  constexpr std::uint64_t maxBytes = std::uint64_t{1} << 30;
  const auto reply = m_reader.request(descriptionRequest + path.string(), maxBytes);
  try {
    if (reply && !reply->empty())
      return parseDicomObject(*reply, path.string());
  } catch (const std::runtime_error& error) {
    if (dynamic_cast<const Error*>(&error))
      throw;
  }
  throw inputError(ErrorCode::damagedFile, path,
                   "is damaged, truncated or too large; export the segmentation again");
}

std::string DicomObjectReader::readFrames(const Path& path, const DicomSegmentation& object,
                                          std::uint64_t first, std::uint64_t count) {
  const std::uint64_t frameBits = std::uint64_t{1} * static_cast<std::uint64_t>(object.rows) *
                                  static_cast<std::uint64_t>(object.columns) *
                                  static_cast<std::uint64_t>(object.bits);
  const FramesRequest part{first * frameBits, count * frameBits};
  const std::uint64_t bytes = (part.firstBit + part.bits + 7) / 8 - part.firstBit / 8;
  std::string request(1, framesRequest);
  request.append(reinterpret_cast<const char*>(&part), sizeof part).append(path.string());
  auto reply = m_reader.request(request, bytes);
  if (!reply || reply->size() != bytes)
    throw inputError(ErrorCode::damagedFile, concat(path, ": PixelData"),
                     "is damaged, truncated or cannot be decoded; export the segmentation again, "
                     "without compression");
  return std::move(*reply);
}

} // namespace fenestra::core
