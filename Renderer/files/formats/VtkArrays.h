#pragma once
// Data arrays of VTK's XML files (.vtp, .vti): inline or appended, raw or as base64, plain or
// deflated. VTK's own reader trusts the sizes that a file declares, so it is not used.

#include <bit>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace pugi {
class xml_node;
}

namespace fenestra::core {

/// The array is truncated or contradicts itself.
struct VtkArrayError : std::runtime_error {
  VtkArrayError() : std::runtime_error("damaged array") {}
};

/// Encoding of a file's arrays.
struct VtkEncoding {
  std::endian order = std::endian::little;
  bool has64BitHeaders = false; ///< header words have 64 bits, not 32
  bool isDeflated = false;
};

/// Encoding that the root element states; nullopt: another byte order, or another compressor than
/// zlib.
std::optional<VtkEncoding> findVtkEncoding(const pugi::xml_node& file);

/// Bytes of an array as they are stored.
struct VtkBytes {
  /// Reads this many bytes; of base64, digits without whitespace. Returns fewer at the end.
  std::function<std::size_t(char*, std::size_t)> read;
  std::uint64_t size = 0; ///< at least as many as there are
  bool isBase64 = false;
};

/// Content of an inline array of format "binary". The node must outlive the result.
VtkBytes openInlineBytes(const pugi::xml_node& array);

/// Decodes an array, block by block if it is deflated. All methods throw VtkArrayError.
class VtkArrayReader {
public:
  /// Reads the header of the array.
  VtkArrayReader(VtkBytes stored, const VtkEncoding& encoding);

  /// Declared size, bytes; not more than stored, unless the array is deflated.
  std::uint64_t size() const { return m_size; }
  /// Fills memory with the next bytes, in the byte order of the file. Inflates no block to more
  /// than deflate can pack into its stored size.
  void read(void* to, std::size_t bytes);

private:
  void readStored(char* to, std::size_t bytes);
  std::uint64_t readWord();
  void readBlockSizes();
  void inflateBlock();

  VtkBytes m_stored;
  VtkEncoding m_encoding;
  std::string m_digits, m_decoded;      ///< of base64: digits, and bytes that are not read yet
  std::uint64_t m_size = 0;             ///< of the decoded array
  std::vector<std::uint64_t> m_lengths; ///< stored bytes of each block
  std::uint64_t m_blockSize = 0, m_lastSize = 0;
  std::size_t m_nextBlock = 0;
  std::string m_packed, m_block; ///< the current block
  std::size_t m_position = 0;    ///< in m_block
};

} // namespace fenestra::core
