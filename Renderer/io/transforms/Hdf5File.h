#pragma once
// The part of HDF5 that ITK's transform files use, read without the HDF5 library, which does not
// survive damaged files. For io's own sources. Source: HDF5 File Format Specification, version 3.0.

#include <cstdint>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

/// The file is damaged, or uses what is not read here.
struct Hdf5Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Superblocks of version 0 to 3; groups as symbol tables or compact links (eight at most); data
/// sets of few numbers or of one string, compact, contiguous or in one chunk, whole or deflated.
/// All of them throw Hdf5Error.
class Hdf5File {
public:
  using Address = std::uint64_t;
  using Links = std::map<std::string, Address>; ///< hard ones

  explicit Hdf5File(const std::filesystem::path& path);

  Address root() const { return m_root; }
  Links links(Address group) const;
  /// IEEE floats of 4 or 8 bytes, at most `most` of them.
  std::vector<double> numbers(Address dataSet, std::size_t most) const;
  /// One string of variable length, of at most `longest` bytes.
  std::string text(Address dataSet, std::size_t longest) const;

private:
  struct Message {
    unsigned type;
    std::string_view data;
  };
  struct Array {
    std::uint64_t count = 1; ///< elements
    std::string_view type;   ///< the message
    std::uint32_t size = 0;  ///< bytes of an element
    std::string bytes;       ///< of all elements
  };

  std::string_view at(Address address, std::uint64_t size) const;
  std::vector<Message> messages(Address object) const;
  void addSymbols(Address tree, Address heap, int depth, Links& links) const;
  std::string_view heapText(Address heap, std::uint64_t offset) const;
  Array array(Address dataSet, std::size_t most) const;
  std::string stored(std::string_view layout, std::string_view filters, std::uint64_t size) const;
  std::string chunk(std::string_view layout, bool deflated, std::uint64_t size) const;
  std::string_view heapObject(Address collection, std::uint32_t index) const;

  std::string m_bytes;
  Address m_root = 0;
};

} // namespace fenestra
