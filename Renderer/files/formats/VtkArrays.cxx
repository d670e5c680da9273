#include "files/formats/VtkArrays.h"

#include "io/Base64.h"

#include <pugixml.hpp>
#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <string_view>
#include <utility>

namespace fenestra::core {

std::optional<VtkEncoding> findVtkEncoding(const pugi::xml_node& file) {
  const std::string_view order = file.attribute("byte_order").value(),
                         compressor = file.attribute("compressor").value();
  if ((order != "LittleEndian" && order != "BigEndian") ||
      (!compressor.empty() && compressor != "vtkZLibDataCompressor"))
    return std::nullopt;
  return VtkEncoding{order == "BigEndian" ? std::endian::big : std::endian::little,
                     std::string_view(file.attribute("header_type").value()) == "UInt64",
                     !compressor.empty()};
}

VtkBytes openInlineBytes(const pugi::xml_node& array) {
  const std::string_view text = array.text().get();
  const auto read = [text, at = std::size_t(0)](char* to, std::size_t bytes) mutable {
    std::size_t count = 0;
    for (; count < bytes && at < text.size(); ++at)
      if (!std::isspace(static_cast<unsigned char>(text[at])))
        to[count++] = text[at];
    return count;
  };
  return {read, text.size(), true};
}

VtkArrayReader::VtkArrayReader(VtkBytes stored, const VtkEncoding& encoding)
    : m_stored(std::move(stored)), m_encoding(encoding) {
  if (encoding.isDeflated) {
    readBlockSizes();
    return;
  }
  m_size = readWord();
  if (m_size > m_stored.size)
    throw VtkArrayError();
}

void VtkArrayReader::read(void* to, std::size_t bytes) {
  auto* out = static_cast<char*>(to);
  if (!m_encoding.isDeflated)
    return readStored(out, bytes);
  while (bytes > 0) {
    if (m_position == m_block.size())
      inflateBlock();
    const std::size_t part = std::min(bytes, m_block.size() - m_position);
    std::memcpy(out, m_block.data() + m_position, part);
    m_position += part;
    out += part;
    bytes -= part;
  }
}

/// Of base64, reads no group of digits beyond the last byte: the next group may be of another run.
void VtkArrayReader::readStored(char* to, std::size_t bytes) {
  const auto readAll = [this](char* out, std::size_t count) {
    if (m_stored.read(out, count) != count)
      throw VtkArrayError();
  };
  if (!m_stored.isBase64)
    return readAll(to, bytes);
  constexpr std::size_t mostGroups = 1 << 14;
  while (bytes > 0) {
    if (m_decoded.empty()) {
      m_digits.resize(4 * std::min((bytes + 2) / 3, mostGroups));
      readAll(m_digits.data(), m_digits.size());
      auto decoded = fromBase64(m_digits);
      if (!decoded || decoded->empty())
        throw VtkArrayError();
      m_decoded = *std::move(decoded);
    }
    const std::size_t part = std::min(bytes, m_decoded.size());
    std::memcpy(to, m_decoded.data(), part);
    m_decoded.erase(0, part);
    to += part;
    bytes -= part;
  }
}

std::uint64_t VtkArrayReader::readWord() {
  std::string bytes(m_encoding.has64BitHeaders ? 8 : 4, '\0');
  readStored(bytes.data(), bytes.size());
  if (m_encoding.order == std::endian::little)
    std::ranges::reverse(bytes);
  std::uint64_t word = 0;
  for (const char byte : bytes)
    word = word << 8 | static_cast<unsigned char>(byte);
  return word;
}

/// The header has the number of blocks, the sizes of a block and of the last one (0: complete), and
/// the deflated size of each block. In base64 it is a run of its own, and the blocks are another.
void VtkArrayReader::readBlockSizes() {
  const std::uint64_t blocks = readWord();
  m_blockSize = readWord();
  m_lastSize = readWord();
  if (blocks > m_stored.size)
    throw VtkArrayError();
  for (std::uint64_t block = 0; block < blocks; ++block)
    m_lengths.push_back(readWord());
  m_decoded.clear();
  if (blocks > 0 && m_lastSize == 0)
    m_lastSize = m_blockSize;
  if (blocks > 0 && (__builtin_mul_overflow(blocks - 1, m_blockSize, &m_size) ||
                     __builtin_add_overflow(m_size, m_lastSize, &m_size)))
    throw VtkArrayError();
}

void VtkArrayReader::inflateBlock() {
  constexpr std::uint64_t ratio = 1032, slack = 64; // maximum of deflate
  if (m_nextBlock == m_lengths.size())
    throw VtkArrayError();
  const std::uint64_t length = m_lengths[m_nextBlock++];
  const std::uint64_t size = m_nextBlock == m_lengths.size() ? m_lastSize : m_blockSize;
  if (length > m_stored.size || size > length * ratio + slack)
    throw VtkArrayError();
  m_packed.resize(static_cast<std::size_t>(length));
  readStored(m_packed.data(), m_packed.size());
  m_block.resize(static_cast<std::size_t>(size));
  m_position = 0;
  auto written = static_cast<uLongf>(size);
  if (uncompress(reinterpret_cast<Bytef*>(m_block.data()), &written,
                 reinterpret_cast<const Bytef*>(m_packed.data()),
                 static_cast<uLong>(length)) != Z_OK ||
      written != size)
    throw VtkArrayError();
}

} // namespace fenestra::core
