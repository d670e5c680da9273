#include "files/medical/DicomHeader.h"

#include "base/Error.h"
#include "base/safe/ApartBytes.h"

#include <gdcmMediaStorage.h>
#include <gdcmPixmapReader.h>
#include <gdcmReader.h>
#include <gdcmStringFilter.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <set>

namespace fenestra {
namespace {

using Path = std::filesystem::path;
using gdcm::Tag;

constexpr std::uint64_t longestFields = 1 << 20;
constexpr std::string_view padding(" \0", 2);

// ---- the fields: the child sends their texts in this order

/// Numbers of decimal strings between backslashes; empty: one is not a number.
std::vector<double> decimals(std::string text) {
  std::replace(text.begin(), text.end(), '\\', ' ');
  std::erase(text, '+');
  return parseNumbers(text).value_or(std::vector<double>{});
}

/// Number of a field; 0: not one number from 0 to 2^31.
unsigned fieldCount(const std::string& text) {
  const std::vector<double> numbers = decimals(text);
  const bool one = numbers.size() == 1 && numbers[0] >= 0.0 && numbers[0] <= 0x1p31;
  return one ? static_cast<unsigned>(numbers[0]) : 0;
}

using Keep = void (*)(DicomHeader&, const std::string&);

template <std::string DicomHeader::*field>
void keepText(DicomHeader& header, const std::string& text) {
  header.*field = text;
}
template <std::vector<double> DicomHeader::*field>
void keepNumbers(DicomHeader& header, const std::string& text) {
  header.*field = decimals(text);
}
/// Keeps slope or intercept; empty: missing; NaN: not one number.
template <std::vector<double> DicomHeader::*field>
void keepRescale(DicomHeader& header, const std::string& text) {
  const std::vector<double> numbers = decimals(text);
  if (!text.empty())
    header.*field = {numbers.size() == 1 ? numbers[0] : std::nan("")};
}
/// Keeps a number; if the field is missing, the default.
template <unsigned DicomHeader::*field>
void keepCount(DicomHeader& header, const std::string& text) {
  if (!text.empty())
    header.*field = fieldCount(text);
}

struct Field {
  std::uint16_t group, element;
  Keep keep;

  Tag tag() const { return {group, element}; }
};

constexpr std::array dicomFields = {
    Field{0x0008, 0x0060, keepText<&DicomHeader::modality>},
    Field{0x0008, 0x103e, keepText<&DicomHeader::seriesDescription>},
    Field{0x0020, 0x000e, keepText<&DicomHeader::seriesUid>},
    Field{0x0020, 0x0011, keepText<&DicomHeader::seriesNumber>},
    Field{0x0020, 0x0032, keepNumbers<&DicomHeader::position>},
    Field{0x0020, 0x0037, keepNumbers<&DicomHeader::orientation>},
    Field{0x0028, 0x0002, keepCount<&DicomHeader::samples>},
    Field{0x0028, 0x0004, keepText<&DicomHeader::photometric>},
    Field{0x0028, 0x0008, keepCount<&DicomHeader::frames>},
    Field{0x0028, 0x0010, keepCount<&DicomHeader::rows>},
    Field{0x0028, 0x0011, keepCount<&DicomHeader::columns>},
    Field{0x0028, 0x0030, keepNumbers<&DicomHeader::pixelSpacing>},
    Field{0x0028, 0x0100, keepCount<&DicomHeader::bits>},
    Field{0x0028, 0x0101, keepCount<&DicomHeader::bitsStored>},
    Field{0x0028, 0x0102, keepCount<&DicomHeader::highBit>},
    Field{0x0028, 0x0103, keepCount<&DicomHeader::isSigned>},
    Field{0x0028, 0x1052, keepRescale<&DicomHeader::intercept>},
    Field{0x0028, 0x1053, keepRescale<&DicomHeader::slope>},
};

// ---- in the child

bool isDicom(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 132> begin{};
  return file.read(begin.data(), begin.size()) && std::string_view(begin.data() + 128, 4) == "DICM";
}

std::string headerAnswer(const std::string& path) {
  if (!isDicom(path))
    return {};
  std::set<Tag> tags = {Tag(0x0008, 0x0016)}; // the kind of object
  for (const Field& field : dicomFields)
    tags.insert(field.tag());
  gdcm::Reader reader;
  reader.SetFileName(path.c_str());
  const bool read = reader.ReadSelectedTags(tags);
  const gdcm::File& file = reader.GetFile();
  const gdcm::TransferSyntax& syntax = file.GetHeader().GetDataSetTransferSyntax();
  gdcm::MediaStorage kind;
  kind.SetFromFile(file);
  const auto flag = [](bool value) { return value ? "1" : "0"; };
  AnswerWriter answer;
  answer.put(flag(gdcm::MediaStorage::IsImage(kind)));
  answer.put(flag(syntax.IsEncapsulated()));
  answer.put(flag(read && syntax != gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian));
  gdcm::StringFilter texts;
  texts.SetFile(file);
  for (const Field& field : dicomFields)
    answer.put(texts.ToString(field.tag()));
  return answer.bytes();
}

/// True if the file holds all `bytes` of the voxels: GDCM silently fills up what is cut off.
bool holdsVoxels(const std::string& path, std::uint64_t bytes) {
  const Tag pixelData(0x7fe0, 0x0010);
  gdcm::Reader reader;
  reader.SetFileName(path.c_str());
  return reader.ReadUpToTag(pixelData, {pixelData}) &&
         reader.GetStreamCurrentPosition() + bytes <= std::filesystem::file_size(path);
}

std::string voxelsAnswer(const std::string& path) {
  gdcm::PixmapReader reader;
  reader.SetFileName(path.c_str());
  if (!reader.Read())
    return {};
  const gdcm::Pixmap& image = reader.GetPixmap();
  const gdcm::SequenceOfFragments* fragments = image.GetDataElement().GetSequenceOfFragments();
  std::string voxels(image.GetBufferLength(), '\0');
  const bool whole = holdsVoxels(path, fragments ? fragments->ComputeByteLength() : voxels.size());
  return whole && image.GetBuffer(voxels.data()) ? voxels : std::string();
}

/// First character of a question; a path follows.
constexpr char wantsHeader = 'h', wantsVoxels = 'v';

std::string answerDicom(const std::string& question) {
  const std::string path = question.substr(1);
  return question[0] == wantsHeader ? headerAnswer(path) : voxelsAnswer(path);
}

const ApartJob dicomJob("dicom", answerDicom);

} // namespace

DicomFiles::DicomFiles() : m_child(dicomJob) {}

DicomHeader dicomHeader(std::string_view answer) {
  AnswerReader texts(answer);
  DicomHeader header;
  for (bool* flag : {&header.image, &header.compressed, &header.whole})
    *flag = texts.text() == "1";
  for (const Field& field : dicomFields)
    field.keep(header, std::string(trimmed(texts.text(), padding)));
  return header;
}

std::optional<DicomHeader> DicomFiles::header(const Path& path) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown))
    return std::nullopt;
  const auto answer = m_child.ask(wantsHeader + path.string(), longestFields);
  if (answer && answer->empty())
    return std::nullopt;
  try {
    if (answer)
      return dicomHeader(*answer);
  } catch (const std::runtime_error&) { // malformed answer
  }
  throw inputError(
      path,
      "DICOM header: cannot be read; export the series again, or take the file out of its folder");
}

std::string DicomFiles::voxels(const Path& path, const DicomHeader& h) {
  const std::uint64_t size = imageBytes(h);
  auto answer = m_child.ask(wantsVoxels + path.string(), size);
  if (answer && answer->size() == size)
    return std::move(*answer);
  if (h.compressed)
    throw inputError(path, "PixelData: cannot be decoded; export the series without compression");
  throw inputError(path, "PixelData: is damaged, truncated or deflated; export the series again");
}

} // namespace fenestra
