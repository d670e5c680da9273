#include "io/medical/DicomHeader.h"

#include "io/NumberText.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>

namespace fenestra {
namespace {

/// A length that cannot be true, or a structure that is none.
struct Damaged {};

using Tag = std::uint32_t; // group, element
constexpr Tag item = 0xFFFEE000, itemEnd = 0xFFFEE00D, sequenceEnd = 0xFFFEE0DD;
constexpr Tag pixelData = 0x7FE00010;
constexpr std::uint32_t undefined = 0xFFFFFFFF;

struct Encoding {
  bool explicitTypes = true, bigEndian = false;
};

struct Element {
  Tag tag = 0;
  std::array<char, 2> type = {}; ///< zeros where it is implicit
  std::uint32_t length = 0;
};

std::string trimmed(std::string text) {
  const auto blank = [](char c) { return c == ' ' || c == '\0'; };
  while (!text.empty() && blank(text.back()))
    text.pop_back();
  text.erase(text.begin(), std::find_if_not(text.begin(), text.end(), blank));
  return text;
}

/// Decimal strings between backslashes; none where one is no number.
std::vector<double> decimals(std::string text) {
  std::replace(text.begin(), text.end(), '\\', ' ');
  std::erase(text, '+');
  return parseNumbers(text).value_or(std::vector<double>{});
}

/// Walks a file's elements, and keeps what a DicomHeader has.
class Walk {
public:
  explicit Walk(const std::filesystem::path& path) : m_file(path, std::ios::binary) {
    m_file.seekg(0, std::ios::end);
    const auto end = m_file.tellg();
    m_size = end < 0 ? 0 : static_cast<std::uint64_t>(end);
    m_file.seekg(0);
  }

  std::optional<DicomHeader> header() {
    constexpr std::uint64_t preamble = 128;
    if (m_size < preamble + 4)
      return std::nullopt;
    seek(preamble);
    if (text(4) != "DICM")
      return std::nullopt;
    try {
      readMeta();
      if (m_header.transferSyntax != "1.2.840.10008.1.2.1.99") { // deflated
        elements(m_size, encoding(), 0);
        m_header.whole = true;
      }
    } catch (const Damaged&) { // whole stays false
    }
    return m_header;
  }

private:
  Encoding encoding() const {
    const std::string& syntax = m_header.transferSyntax;
    const bool implicit =
        syntax == "1.2.840.10008.1.2" || syntax == "1.2.840.113619.5.2" || syntax.empty();
    return {!implicit, syntax == "1.2.840.10008.1.2.2"};
  }

  void seek(std::uint64_t position) {
    if (position > m_size)
      throw Damaged();
    m_at = position;
    m_file.seekg(static_cast<std::streamoff>(position));
  }

  std::string text(std::uint64_t length) {
    if (length > m_size - m_at)
      throw Damaged();
    std::string bytes(static_cast<std::size_t>(length), '\0');
    if (!m_file.read(bytes.data(), static_cast<std::streamsize>(length)))
      throw Damaged();
    m_at += length;
    return bytes;
  }

  std::uint32_t number(int bytes, bool bigEndian) {
    std::string digits = text(static_cast<std::uint64_t>(bytes));
    if (!bigEndian)
      std::reverse(digits.begin(), digits.end());
    std::uint32_t value = 0;
    for (const char byte : digits)
      value = value << 8 | static_cast<unsigned char>(byte);
    return value;
  }

  Element element(Encoding encoding) {
    Element element;
    const Tag group = number(2, encoding.bigEndian);
    element.tag = group << 16 | number(2, encoding.bigEndian);
    if (group == item >> 16 || !encoding.explicitTypes) {
      element.length = number(4, encoding.bigEndian);
      return element;
    }
    const std::string type = text(2);
    element.type = {type[0], type[1]};
    const auto isLetter = [](char c) { return c >= 'A' && c <= 'Z'; };
    if (!isLetter(type[0]) || !isLetter(type[1]))
      throw Damaged();
    constexpr std::array longOnes = {"OB", "OD", "OF", "OL", "OV", "OW", "SQ",
                                     "SV", "UC", "UN", "UR", "UT", "UV"};
    const bool isLong = std::find(longOnes.begin(), longOnes.end(), type) != longOnes.end();
    if (isLong)
      text(2);
    element.length = number(isLong ? 4 : 2, encoding.bigEndian);
    return element;
  }

  /// Group 2, which is always explicit and little-endian.
  void readMeta() {
    while (m_size - m_at >= 8) {
      const std::uint64_t begin = m_at;
      const bool meta = number(2, false) == 2;
      seek(begin);
      if (!meta)
        return;
      const Element element = this->element({});
      if (element.tag == 0x00020010)
        m_header.transferSyntax = trimmed(value(element));
      else
        seek(m_at + element.length);
    }
  }

  /// Up to `end`, or in a sequence's item to what ends it.
  void elements(std::uint64_t end, Encoding encoding, int depth) {
    constexpr int deepest = 16;
    if (depth > deepest)
      throw Damaged();
    while (m_at < end) {
      if (depth == 0 && end - m_at < 8)
        return; // padding
      const Element element = this->element(encoding);
      if (m_at > end)
        throw Damaged();
      if (element.tag == itemEnd)
        return;
      if (element.tag == pixelData && depth == 0)
        readPixels(element, encoding);
      else if (element.length == undefined || isSequence(element, encoding, end))
        sequence(element, encoding, end, depth);
      else if (element.length > end - m_at)
        throw Damaged();
      else if (depth == 0)
        keep(element, encoding);
      else
        seek(m_at + element.length);
    }
  }

  bool isSequence(const Element& element, Encoding encoding, std::uint64_t end) {
    if (element.type == std::array{'S', 'Q'})
      return true;
    if (encoding.explicitTypes || element.length < 8 || end - m_at < 8)
      return false;
    const std::uint64_t begin = m_at;
    const Tag group = number(2, encoding.bigEndian);
    const Tag tag = group << 16 | number(2, encoding.bigEndian);
    seek(begin);
    return tag == item;
  }

  void sequence(const Element& element, Encoding encoding, std::uint64_t end, int depth) {
    if (element.type == std::array{'U', 'N'})
      encoding = {false, false}; // what is of unknown type is implicit inside
    if (element.length != undefined) {
      if (element.length > end - m_at)
        throw Damaged();
      end = m_at + element.length;
    }
    while (m_at < end) {
      const Element entry = this->element(encoding);
      if (entry.tag == sequenceEnd)
        return;
      if (entry.tag != item || m_at > end)
        throw Damaged();
      if (entry.length != undefined && entry.length > end - m_at)
        throw Damaged();
      elements(entry.length == undefined ? end : m_at + entry.length, encoding, depth + 1);
    }
  }

  void readPixels(const Element& element, Encoding encoding) {
    m_header.pixels.clear();
    m_header.compressed = element.length == undefined;
    m_header.bigEndian =
        encoding.bigEndian || m_header.transferSyntax == "1.2.840.113619.5.2"; // GE's
    if (!m_header.compressed) {
      m_header.pixels = {{m_at, element.length}};
      seek(m_at + element.length);
      return;
    }
    for (;;) {
      const Element fragment = this->element(encoding);
      if (fragment.tag == sequenceEnd)
        break;
      if (fragment.tag != item)
        throw Damaged();
      m_header.pixels.push_back({m_at, fragment.length});
      seek(m_at + fragment.length);
    }
    if (!m_header.pixels.empty()) // the first is a table of where the frames begin
      m_header.pixels.erase(m_header.pixels.begin());
  }

  std::string value(const Element& element) {
    constexpr std::uint32_t longest = 4096;
    if (element.length > longest)
      throw Damaged();
    return text(element.length);
  }

  void keep(const Element& element, Encoding encoding) {
    const std::uint64_t end = m_at + element.length;
    const auto words = [&] { return trimmed(value(element)); };
    const auto count = [&] { return element.length == 2 ? number(2, encoding.bigEndian) : 0; };
    switch (element.tag) {
    case 0x00080060:
      m_header.modality = words();
      break;
    case 0x0008103E:
      m_header.seriesDescription = words();
      break;
    case 0x0020000E:
      m_header.seriesUid = words();
      break;
    case 0x00200011:
      m_header.seriesNumber = words();
      break;
    case 0x00200032:
      m_header.position = decimals(words());
      break;
    case 0x00200037:
      m_header.orientation = decimals(words());
      break;
    case 0x00280002:
      m_header.samples = count();
      break;
    case 0x00280004:
      m_header.photometric = words();
      break;
    case 0x00280008:
      readFrames(words());
      break;
    case 0x00280010:
      m_header.rows = count();
      break;
    case 0x00280011:
      m_header.columns = count();
      break;
    case 0x00280030:
      m_header.pixelSpacing = decimals(words());
      break;
    case 0x00280100:
      m_header.bits = count();
      break;
    case 0x00280101:
      m_header.bitsStored = count();
      break;
    case 0x00280102:
      m_header.highBit = count();
      break;
    case 0x00280103:
      m_header.isSigned = count();
      break;
    case 0x00281052:
      m_header.intercept = decimals(words());
      break;
    case 0x00281053:
      m_header.slope = decimals(words());
      break;
    default:
      break;
    }
    seek(end);
  }

  void readFrames(const std::string& digits) {
    const auto [end, failure] =
        std::from_chars(digits.data(), digits.data() + digits.size(), m_header.frames);
    if (failure != std::errc() || end != digits.data() + digits.size())
      throw Damaged();
  }

  std::ifstream m_file;
  std::uint64_t m_size = 0, m_at = 0;
  DicomHeader m_header;
};

} // namespace

std::optional<DicomHeader> readDicomHeader(const std::filesystem::path& path) {
  return Walk(path).header();
}

} // namespace fenestra
