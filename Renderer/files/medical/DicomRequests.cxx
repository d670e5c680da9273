// What the child processes of DicomReader do.

#include "files/medical/DicomDataSet.h"
#include "files/medical/DicomFields.h"

#include <gdcmFileMetaInformation.h>
#include <gdcmMediaStorage.h>
#include <gdcmPixmapReader.h>
#include <gdcmPreamble.h>
#include <gdcmReader.h>

#include <cstring>
#include <fstream>
#include <set>

namespace fenestra::core {
namespace {

using gdcm::DataSet;
using gdcm::Tag;

const Tag sharedGroups(0x5200, 0x9229), frameGroups(0x5200, 0x9230);

Tag toTag(std::uint32_t tag) {
  return {static_cast<std::uint16_t>(tag >> 16), static_cast<std::uint16_t>(tag & 0xffffU)};
}

// ---- headers

/// Meta information of a file, which need not have it nor the preamble.
struct FileMeta {
  gdcm::TransferSyntax::TSType syntax = gdcm::TransferSyntax::TS_END; ///< TS_END: unknown
  std::string uid;                                                    ///< as the file states it
};

FileMeta readMeta(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  try {
    gdcm::Preamble().Read(stream);
  } catch (const std::exception&) { // there is none
    stream.clear();
    stream.seekg(0);
  }
  gdcm::FileMetaInformation meta;
  FileMeta read;
  try {
    meta.ReadCompat(stream);
    read.syntax = meta.GetDataSetTransferSyntax();
  } catch (const std::exception&) { // the transfer syntax is unknown
  }
  read.uid = getText(meta, {0x0002, 0x0010});
  return read;
}

/// Reads a data set up to its voxels. Files of one frame are read up to the last field only.
class HeaderFile {
public:
  HeaderFile(const std::string& path, const FileMeta& meta) {
    std::set<Tag> tags;
    for (const DicomField& field : dicomFields) {
      tags.insert(toTag(field.sequence != 0 ? field.sequence : field.tag));
      tags.insert(toTag(field.tag));
      if (*field.creator != '\0')
        tags.insert(Tag(toTag(field.tag).GetGroup(), 0x0010));
    }
    if (meta.syntax ==
        gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian) { // whose parts GDCM cannot read
      m_isRead = open(path).Read();
      return;
    }
    m_isRead = open(path).ReadSelectedTags(tags);
    if (const auto frames = getDecimals(data(), {0x0028, 0x0008});
        frames.size() == 1 && frames[0] > 1.0)
      m_isRead = open(path).ReadUpToTag(pixelData, {pixelData});
  }

  bool isRead() const { return m_isRead; }
  const gdcm::File& file() const { return m_reader->GetFile(); }
  const DataSet& data() const { return file().GetDataSet(); }

private:
  gdcm::Reader& open(const std::string& path) {
    m_reader = std::make_unique<gdcm::Reader>();
    m_reader->SetFileName(path.c_str());
    return *m_reader;
  }

  std::unique_ptr<gdcm::Reader> m_reader;
  bool m_isRead = false;
};

/// The value as text; numbers as decimals, separated by backslashes.
std::string getValue(const DataSet& data, const DicomField& field) {
  const Tag tag = toTag(field.tag);
  constexpr int exact = 17; // digits
  switch (field.value) {
  case DicomValue::us:
    return joinNumbers(getShorts(data, tag), "\\", exact);
  case DicomValue::ul:
    return joinNumbers(getLongs(data, tag), "\\", exact);
  case DicomValue::fl:
    return joinNumbers(getFloats(data, tag), "\\", exact);
  case DicomValue::fd:
    return joinNumbers(getDoubles(data, tag), "\\", exact);
  case DicomValue::text:
    break;
  }
  return getText(data, tag);
}

std::string getGroupValue(const DataSet& groups, const DicomField& field) {
  const DicomItems group(groups, toTag(field.sequence));
  return group.size() > 0 ? getValue(group[0], field) : std::string();
}

/// Value of the whole file.
std::string getFileValue(const DataSet& data, const DicomField& field) {
  if (*field.creator != '\0' &&
      getText(data, {toTag(field.tag).GetGroup(), 0x0010}) != field.creator)
    return {};
  std::string value = field.isInSequenceOnly ? std::string() : getValue(data, field);
  return value.empty() && field.sequence != 0 ? getGroupValue(data, field) : value;
}

/// Values of the functional groups, frame by frame.
void putFrames(const DataSet& data, ReplyWriter& reply) {
  const DicomItems shared(data, sharedGroups), frames(data, frameGroups);
  const std::string sopClass = getText(data, {0x0008, 0x0016});
  const bool isImage = !sopClass.starts_with("1.2.840.10008.5.1.4.1.1.66."); // segmentations
  reply.put(std::vector{static_cast<double>(isImage ? frames.size() : 0)});
  for (std::size_t i = 0; isImage && i < frames.size(); ++i)
    for (const DicomField& field : dicomFields)
      if (field.sequence != 0) {
        const std::string own = getGroupValue(frames[i], field);
        reply.put(own.empty() && shared.size() > 0 ? getGroupValue(shared[0], field) : own);
      }
}

std::string makeHeaderReply(const std::string& path) {
  limitMemoryByFile(path);
  const FileMeta meta = readMeta(path);
  ReplyWriter reply;
  if (meta.syntax == gdcm::TransferSyntax::TS_END && !meta.uid.empty()) {
    reply.put(meta.uid);
    return reply.bytes();
  }
  const HeaderFile read(path, meta);
  const gdcm::TransferSyntax& syntax = read.file().GetHeader().GetDataSetTransferSyntax();
  gdcm::MediaStorage kind;
  kind.SetFromFile(read.file());
  const auto flag = [](bool value) { return value ? "1" : "0"; };
  reply.put(""); // the transfer syntax is supported
  reply.put(flag(gdcm::MediaStorage::IsImage(kind)));
  reply.put(flag(syntax.IsEncapsulated() || isDeflated(read.file())));
  reply.put(flag(read.isRead()));
  reply.put(flag(kind == gdcm::MediaStorage::MediaStorageDirectoryStorage));
  for (const DicomField& field : dicomFields)
    reply.put(getFileValue(read.data(), field));
  putFrames(read.data(), reply);
  return reply.bytes();
}

// ---- voxels

/// True if the file contains all `bytes` of the voxels. GDCM silently pads truncated data.
bool hasAllVoxels(const std::string& path, const gdcm::PixmapReader& whole, std::uint64_t bytes) {
  if (isDeflated(whole.GetFile()))
    return getBytes(whole.GetFile().GetDataSet(), pixelData).size() >= bytes;
  gdcm::Reader reader;
  reader.SetFileName(path.c_str());
  return reader.ReadUpToTag(pixelData, {pixelData}) &&
         reader.GetStreamCurrentPosition() + bytes <= std::filesystem::file_size(path);
}

struct DecodedFile {
  std::string voxels; ///< empty: unreadable
  std::size_t frames = 1;
};

DecodedFile decodeFile(const std::string& path) {
  gdcm::PixmapReader reader;
  reader.SetFileName(path.c_str());
  if (!reader.Read())
    return {};
  const gdcm::Pixmap& image = reader.GetPixmap();
  const gdcm::SequenceOfFragments* fragments = image.GetDataElement().GetSequenceOfFragments();
  DecodedFile decoded{std::string(image.GetBufferLength(), '\0')};
  if (image.GetNumberOfDimensions() == 3)
    decoded.frames = image.GetDimension(2);
  const bool isComplete = hasAllVoxels(
      path, reader, fragments ? fragments->ComputeByteLength() : decoded.voxels.size());
  if (!isComplete || !image.GetBuffer(decoded.voxels.data()))
    return {};
  return decoded;
}

/// Handles the requests to one reader. Keeps the frames of a file for the next requests.
class DicomHandler {
public:
  std::string operator()(const std::string& request) {
    const SuppressGdcmOutput suppress;
    if (request[0] == dicomHeaderRequest)
      return makeHeaderReply(request.substr(1));
    std::uint32_t frame = 0;
    std::memcpy(&frame, request.data() + 1, sizeof frame);
    return makeVoxelsReply(frame, request.substr(1 + sizeof frame));
  }

private:
  std::string makeVoxelsReply(std::uint32_t frame, const std::string& path) {
    if (m_read != path) {
      m_read.clear();
      m_decoded = {};
      limitMemoryByFile(path);
      m_decoded = decodeFile(path);
      m_read = path;
    }
    if (m_decoded.frames <= 1) {
      m_read.clear();
      return std::move(m_decoded.voxels);
    }
    const std::size_t bytes = m_decoded.voxels.size() / m_decoded.frames;
    return frame < m_decoded.frames ? m_decoded.voxels.substr(frame * bytes, bytes) : std::string();
  }

  std::string m_read; ///< path of the file; empty: none
  DecodedFile m_decoded;
};

} // namespace

const SandboxJob dicomJob("dicom", DicomHandler());
const SandboxJob dicomFramesJob("dicom-frames", DicomHandler(),
                                {.seconds = 60, .bytes = std::uint64_t{8} << 30});

} // namespace fenestra::core
