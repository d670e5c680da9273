#pragma once
// Writes DICOM files byte by byte, without the library that reads them.

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace fenestra::core::dicom {

struct Element;
using Item = std::vector<Element>; ///< sorted by tag

struct Element {
  std::uint32_t tag; ///< group and element
  std::string vr;
  std::string value = {}; ///< numbers are little-endian
  std::vector<Item> items = {};
  std::vector<std::string> fragments = {}; ///< of compressed pixels, after an empty offset table
};

enum class Syntax { implicitLittle, explicitLittle, explicitBig, deflated, rle, htj2k };

// ---- values

inline Element makeText(std::uint32_t tag, const std::string& vr, const std::string& text) {
  return {tag, vr, text};
}
inline Element makeShorts(std::uint32_t tag, const std::vector<unsigned>& numbers) {
  Element element{tag, "US"};
  for (const unsigned number : numbers) {
    element.value += static_cast<char>(number & 255U);
    element.value += static_cast<char>(number >> 8);
  }
  return element;
}
template <typename Numbers>
Element makeDecimals(std::uint32_t tag, const Numbers& numbers) {
  Element element{tag, "DS"};
  for (const double number : numbers) {
    char text[32];
    std::snprintf(text, sizeof text, "%.10g", number);
    element.value += (element.value.empty() ? "" : "\\") + std::string(text);
  }
  return element;
}
inline Element makeSequence(std::uint32_t tag, std::vector<Item> items) {
  return {tag, "SQ", {}, std::move(items)};
}
inline Element makeCode(std::uint32_t tag, const std::string& scheme, const std::string& value) {
  return makeSequence(tag, {{makeText(0x00080100, "SH", value), makeText(0x00080102, "SH", scheme),
                             makeText(0x00080104, "LO", "meaning")}});
}

// ---- encoding

class Encoder {
public:
  Encoder(Syntax syntax, bool hasLengths) : m_syntax(syntax), m_hasLengths(hasLengths) {}

  std::string encode(const Item& elements) const {
    std::string bytes;
    for (const Element& element : elements)
      bytes += encode(element);
    return bytes;
  }

private:
  std::string encodeNumber(std::uint32_t number, int size) const {
    std::string bytes;
    for (int i = 0; i < size; ++i)
      bytes += static_cast<char>(number >> 8 * (isBig() ? size - 1 - i : i) & 255U);
    return bytes;
  }
  std::string encodeTag(std::uint32_t tag) const {
    return encodeNumber(tag >> 16, 2) + encodeNumber(tag & 0xffffU, 2);
  }
  bool isBig() const { return m_syntax == Syntax::explicitBig; }

  /// Content with its length, or with an undefined one and a delimiter.
  std::string delimit(const std::string& content, bool hasLength, std::uint32_t delimiter) const {
    if (hasLength)
      return encodeNumber(static_cast<std::uint32_t>(content.size()), 4) + content;
    return encodeNumber(0xffffffff, 4) + content + encodeTag(delimiter) + encodeNumber(0, 4);
  }

  std::string encodeValue(const Element& element) const {
    std::string value = element.value;
    if (value.size() % 2 == 1)
      value += element.vr == "OB" || element.vr == "UI" ? '\0' : ' ';
    if (isBig() && (element.vr == "US" || element.vr == "OW"))
      for (std::size_t i = 0; i + 1 < value.size(); i += 2)
        std::swap(value[i], value[i + 1]);
    if (isBig() && (element.vr == "UL" || element.vr == "FD"))
      std::ranges::reverse(value); // of one number
    return value;
  }

  std::string encode(const Element& element) const {
    std::string content, tag = encodeTag(element.tag);
    const bool isLong = element.vr == "SQ" || element.vr == "OB" || element.vr == "OW";
    if (m_syntax != Syntax::implicitLittle)
      tag += element.vr + (isLong ? std::string(2, '\0') : "");
    if (element.vr == "SQ") {
      for (const Item& item : element.items)
        content += encodeTag(0xfffee000) + delimit(encode(item), m_hasLengths, 0xfffee00d);
      return tag + delimit(content, m_hasLengths, 0xfffee0dd);
    }
    if (!element.fragments.empty()) {
      content = encodeTag(0xfffee000) + encodeNumber(0, 4);
      for (const std::string& fragment : element.fragments)
        content += encodeTag(0xfffee000) + delimit(fragment, true, 0);
      return tag + delimit(content, false, 0xfffee0dd);
    }
    const std::string value = encodeValue(element);
    const bool isShort = m_syntax != Syntax::implicitLittle && !isLong;
    return tag + encodeNumber(static_cast<std::uint32_t>(value.size()), isShort ? 2 : 4) + value;
  }

  Syntax m_syntax;
  bool m_hasLengths;
};

inline std::string deflate(const std::string& bytes) {
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  ::deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

/// One frame of RLE-compressed pixels of `bytesPerPixel` bytes (DICOM PS3.5, annex G), as literals.
inline std::string encodeRle(const std::string& pixels, std::size_t bytesPerPixel) {
  std::string header(64, '\0'), segments;
  header[0] = static_cast<char>(bytesPerPixel);
  for (std::size_t plane = 0; plane < bytesPerPixel; ++plane) {
    const auto offset = static_cast<std::uint32_t>(64 + segments.size());
    for (std::size_t i = 0; i < 4; ++i)
      header[4 + 4 * plane + i] = static_cast<char>(offset >> 8 * i & 255U);
    std::string bytes; // the most significant byte comes first
    for (std::size_t i = bytesPerPixel - 1 - plane; i < pixels.size(); i += bytesPerPixel)
      bytes += pixels[i];
    for (std::size_t i = 0; i < bytes.size(); i += 128) {
      const std::string part = bytes.substr(i, 128);
      segments += static_cast<char>(part.size() - 1) + part;
    }
    if (segments.size() % 2 == 1)
      segments += '\x80';
  }
  return header + segments;
}

/// A file with its meta information. `hasLengths`: sequences have defined lengths. `sopClass`: of a
/// data set that does not state it.
inline std::string makeFile(const Item& elements, Syntax syntax, bool hasLengths = true,
                            std::string sopClass = {}) {
  const char* const uids[] = {"1.2.840.10008.1.2",   "1.2.840.10008.1.2.1",
                              "1.2.840.10008.1.2.2", "1.2.840.10008.1.2.1.99",
                              "1.2.840.10008.1.2.5", "1.2.840.10008.1.2.4.201"};
  for (const Element& element : elements)
    if (element.tag == 0x00080016)
      sopClass = element.value;
  const Item meta = {makeText(0x00020002, "UI", sopClass), makeText(0x00020003, "UI", "1.2.3.4"),
                     makeText(0x00020010, "UI", uids[static_cast<int>(syntax)])};
  const std::string header = Encoder(Syntax::explicitLittle, true).encode(meta);
  std::string length = std::string("\x02\0\0\0UL\x04\0", 8);
  for (int i = 0; i < 4; ++i)
    length += static_cast<char>(header.size() >> 8 * i & 255U);
  const std::string data = Encoder(syntax, hasLengths).encode(elements);
  return std::string(128, '\0') + "DICM" + length + header +
         (syntax == Syntax::deflated ? deflate(data) : data);
}

} // namespace fenestra::core::dicom
