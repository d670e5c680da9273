#include "io/transforms/Hdf5File.h"

#include <zlib.h>

#include <bit>
#include <fstream>
#include <iterator>
#include <utility>

namespace fenestra {
namespace {

constexpr std::size_t mostLinks = 4096;

[[noreturn]] void damaged(const char* what) {
  throw Hdf5Error(what);
}

/// Takes little-endian numbers and bytes off the front.
class Cursor {
public:
  explicit Cursor(std::string_view bytes) : m_bytes(bytes) {}

  bool empty() const { return m_bytes.empty(); }
  std::size_t left() const { return m_bytes.size(); }
  std::string_view take(std::uint64_t count) {
    if (count > m_bytes.size())
      damaged("a field goes beyond its end");
    const std::string_view taken = m_bytes.substr(0, static_cast<std::size_t>(count));
    m_bytes.remove_prefix(static_cast<std::size_t>(count));
    return taken;
  }
  void skip(std::uint64_t count) { take(count); }
  std::uint64_t number(int bytes) {
    std::uint64_t value = 0;
    int shift = 0;
    for (const char byte : take(static_cast<std::uint64_t>(bytes)))
      value |= std::uint64_t{static_cast<unsigned char>(byte)} << std::exchange(shift, shift + 8);
    return value;
  }
  unsigned byte() { return static_cast<unsigned>(number(1)); }
  unsigned two() { return static_cast<unsigned>(number(2)); }
  std::uint32_t four() { return static_cast<std::uint32_t>(number(4)); }
  std::uint64_t eight() { return number(8); }
  void expect(std::string_view signature) {
    if (take(signature.size()) != signature)
      damaged("a signature is missing");
  }

private:
  std::string_view m_bytes;
};

// Types of messages in an object's header.
enum : unsigned {
  dataSpace = 0x01,
  dataType = 0x03,
  link = 0x06,
  dataLayout = 0x08,
  filterPipeline = 0x0B,
  continuation = 0x10,
  symbolTable = 0x11,
};

std::string inflated(std::string_view bytes, std::uint64_t size) {
  std::string out(static_cast<std::size_t>(size), '\0');
  auto length = static_cast<uLongf>(size);
  if (uncompress(reinterpret_cast<Bytef*>(out.data()), &length,
                 reinterpret_cast<const Bytef*>(bytes.data()),
                 static_cast<uLong>(bytes.size())) != Z_OK ||
      length != size)
    damaged("a compressed chunk is broken");
  return out;
}

std::uint64_t elementCount(std::string_view message) {
  Cursor cursor(message);
  const unsigned version = cursor.byte();
  const unsigned rank = cursor.byte();
  cursor.skip(version == 1 ? 6 : 2);
  if ((version != 1 && version != 2) || rank > 1)
    damaged("a data space is not a list");
  return rank == 0 ? 1 : cursor.eight();
}

bool isDeflated(std::string_view filters) {
  if (filters.empty())
    return false;
  Cursor cursor(filters);
  cursor.skip(1);
  const unsigned count = cursor.byte();
  cursor.skip(filters[0] == 1 ? 6 : 0);
  constexpr unsigned deflate = 1;
  if (count != 1 || cursor.two() != deflate)
    damaged("a filter is unknown");
  return true;
}

template <typename Real, typename Bits>
double real(std::string_view bytes) {
  return static_cast<double>(
      std::bit_cast<Real>(static_cast<Bits>(Cursor(bytes).number(sizeof(Bits)))));
}

} // namespace

Hdf5File::Hdf5File(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  m_bytes.assign(std::istreambuf_iterator<char>(file), {});
  Cursor cursor(m_bytes);
  cursor.expect("\211HDF\r\n\032\n");
  const unsigned version = cursor.byte();
  if (version > 3)
    damaged("the version is unknown");
  cursor.skip(version < 2 ? 4 : 0);
  if (cursor.byte() != 8 || cursor.byte() != 8)
    damaged("addresses are not of 8 bytes");
  cursor.skip(version == 0 ? 9 : version == 1 ? 13 : 1);
  if (cursor.eight() != 0)
    damaged("the base is not the file's begin");
  cursor.skip(version < 2 ? 3 * 8 + 8 : 2 * 8);
  m_root = cursor.eight();
}

std::string_view Hdf5File::at(Address address, std::uint64_t size) const {
  if (address > m_bytes.size() || size > m_bytes.size() - address)
    damaged("an address is outside the file");
  return std::string_view(m_bytes).substr(static_cast<std::size_t>(address),
                                          static_cast<std::size_t>(size));
}

/// All of an object's, over its header's blocks.
std::vector<Hdf5File::Message> Hdf5File::messages(Address object) const {
  constexpr std::uint64_t longestBlock = 1 << 14;
  constexpr std::size_t mostBlocks = 8;
  const bool second = at(object, 4) == "OHDR"; // version 2
  Cursor header(at(object, m_bytes.size() - std::min<Address>(object, m_bytes.size())));
  unsigned flags = 0;
  std::uint64_t size = 0;
  if (second) {
    header.skip(5);
    flags = header.byte();
    header.skip((flags & 0x20 ? 16 : 0) + (flags & 0x10 ? 4 : 0));
    size = header.number(1 << (flags & 3));
  } else {
    if (header.byte() != 1)
      damaged("an object's version is unknown");
    header.skip(7);
    size = header.four();
    header.skip(4);
  }
  std::vector<std::string_view> blocks = {header.take(size)};
  std::vector<Message> all;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (i == mostBlocks || blocks[i].size() > longestBlock)
      damaged("an object's header is too long");
    Cursor block(blocks[i]);
    const std::size_t shortest = second ? 4 : 8;
    while (block.left() >= shortest) {
      const unsigned type = second ? block.byte() : block.two();
      const unsigned length = block.two();
      const unsigned messageFlags = block.byte();
      block.skip(second ? (flags & 4 ? 2 : 0) : 3);
      const std::string_view data = block.take(length);
      constexpr unsigned shared = 2;
      if (messageFlags & shared)
        damaged("a message is kept elsewhere");
      if (type == continuation) {
        Cursor place(data);
        const Address address = place.eight();
        std::string_view next = at(address, place.eight());
        if (second) {
          if (next.size() < 8 || !next.starts_with("OCHK"))
            damaged("a signature is missing");
          next = next.substr(4, next.size() - 8); // a checksum ends it
        }
        blocks.push_back(next);
      } else
        all.push_back({type, data});
    }
  }
  return all;
}

Hdf5File::Links Hdf5File::links(Address group) const {
  Links links;
  for (const Message& message : messages(group)) {
    Cursor cursor(message.data);
    if (message.type == symbolTable) {
      const Address tree = cursor.eight();
      addSymbols(tree, cursor.eight(), 0, links);
    } else if (message.type == link) {
      cursor.skip(1);
      const unsigned flags = cursor.byte();
      const bool hard = !(flags & 8) || cursor.byte() == 0;
      cursor.skip((flags & 4 ? 8 : 0) + (flags & 16 ? 1 : 0));
      const std::string name(cursor.take(cursor.number(1 << (flags & 3))));
      if (hard)
        links[name] = cursor.eight();
    }
  }
  return links;
}

/// Of a B-tree of version 1 whose leaves are symbol nodes.
void Hdf5File::addSymbols(Address tree, Address heap, int depth, Links& links) const {
  constexpr int deepest = 4;
  Cursor node(at(tree, 24));
  node.expect("TREE");
  const unsigned kind = node.byte(), level = node.byte(), children = node.two();
  if (kind != 0 || depth > deepest)
    damaged("a group's tree is not one");
  Cursor entries(at(tree + 24, std::uint64_t{children} * 16));
  for (unsigned i = 0; i < children; ++i) {
    entries.skip(8);
    const Address child = entries.eight();
    if (level > 0) {
      addSymbols(child, heap, depth + 1, links);
      continue;
    }
    Cursor leaf(at(child, 8));
    leaf.expect("SNOD");
    leaf.skip(2);
    const unsigned symbols = leaf.two();
    Cursor symbol(at(child + 8, std::uint64_t{symbols} * 40));
    for (unsigned s = 0; s < symbols; ++s) {
      const std::string_view name = heapText(heap, symbol.eight());
      const Address object = symbol.eight();
      constexpr std::uint32_t symbolic = 2;
      if (symbol.four() != symbolic)
        links[std::string(name)] = object;
      symbol.skip(4 + 16);
      if (links.size() > mostLinks)
        damaged("a group is too large");
    }
  }
}

std::string_view Hdf5File::heapText(Address heap, std::uint64_t offset) const {
  Cursor header(at(heap, 32));
  header.expect("HEAP");
  header.skip(4);
  const std::uint64_t size = header.eight();
  header.skip(8);
  const std::string_view data = at(header.eight(), size);
  constexpr std::uint64_t longest = 256;
  if (offset >= data.size())
    damaged("a name is outside its heap");
  const std::string_view text = data.substr(static_cast<std::size_t>(offset), longest);
  return text.substr(0, text.find('\0'));
}

Hdf5File::Array Hdf5File::array(Address dataSet, std::size_t most) const {
  Array array;
  std::string_view layout, filters;
  for (const Message& message : messages(dataSet))
    switch (message.type) {
    case dataSpace:
      array.count = elementCount(message.data);
      break;
    case dataType:
      array.type = message.data;
      break;
    case dataLayout:
      layout = message.data;
      break;
    case filterPipeline:
      filters = message.data;
      break;
    default:
      break;
    }
  Cursor type(array.type);
  type.skip(4);
  array.size = type.four();
  constexpr std::uint32_t largest = 16;
  if (array.count > most || array.size > largest)
    damaged("a data set is too large");
  if (array.count > 0)
    array.bytes = stored(layout, filters, array.count * array.size);
  return array;
}

std::string Hdf5File::stored(std::string_view layout, std::string_view filters,
                             std::uint64_t size) const {
  Cursor cursor(layout);
  if (cursor.byte() != 3)
    damaged("a layout's version is unknown");
  switch (cursor.byte()) {
  case 0: // compact
    return std::string(Cursor(cursor.take(cursor.two())).take(size));
  case 1: // contiguous
    return std::string(at(cursor.eight(), size));
  case 2:
    return chunk(layout, isDeflated(filters), size);
  default:
    damaged("a layout is unknown");
  }
}

/// The only one of a list.
std::string Hdf5File::chunk(std::string_view layout, bool deflated, std::uint64_t size) const {
  Cursor cursor(layout);
  cursor.skip(2);
  if (cursor.byte() != 2) // the list's axis, and the bytes of an element
    damaged("chunks are not of a list");
  const Address tree = cursor.eight();
  const std::uint64_t chunkSize = std::uint64_t{cursor.four()} * cursor.four();
  Cursor node(at(tree, 24 + 24 + 8));
  node.expect("TREE");
  const unsigned kind = node.byte(), level = node.byte(), children = node.two();
  node.skip(16);
  if (kind != 1 || level != 0 || children != 1 || chunkSize < size || chunkSize > 2 * size + 4096)
    damaged("a list has several chunks");
  const std::uint32_t bytes = node.four();
  const std::uint32_t filtersLeftOut = node.four();
  node.skip(16);
  const std::string_view kept = at(node.eight(), bytes);
  const std::string all =
      deflated && filtersLeftOut == 0 ? inflated(kept, chunkSize) : std::string(kept);
  return std::string(Cursor(all).take(size));
}

std::vector<double> Hdf5File::numbers(Address dataSet, std::size_t most) const {
  const Array array = this->array(dataSet, most);
  Cursor type(array.type);
  const unsigned kind = type.byte() & 15, order = type.byte();
  constexpr unsigned floats = 1, bigEndian = 1, vax = 64;
  if (kind != floats || order & vax || (array.size != 4 && array.size != 8))
    damaged("a data set does not hold floats");
  std::vector<double> numbers;
  Cursor cursor(array.bytes);
  for (std::uint64_t i = 0; i < array.count; ++i) {
    std::string bytes(cursor.take(array.size));
    if (order & bigEndian)
      bytes.assign(bytes.rbegin(), bytes.rend());
    numbers.push_back(array.size == 4 ? real<float, std::uint32_t>(bytes)
                                      : real<double, std::uint64_t>(bytes));
  }
  return numbers;
}

std::string Hdf5File::text(Address dataSet, std::size_t longest) const {
  const Array array = this->array(dataSet, 1);
  Cursor type(array.type);
  const unsigned kind = type.byte() & 15, content = type.byte() & 15;
  constexpr unsigned variableLength = 9, characters = 1;
  if (kind != variableLength || content != characters || array.count != 1)
    damaged("a data set does not hold one text");
  Cursor element(array.bytes);
  const std::uint32_t length = element.four();
  const Address collection = element.eight();
  if (length > longest)
    damaged("a text is too long");
  const std::string_view text = Cursor(heapObject(collection, element.four())).take(length);
  return std::string(text.substr(0, text.find('\0')));
}

/// Of the global heap.
std::string_view Hdf5File::heapObject(Address collection, std::uint32_t index) const {
  Cursor header(at(collection, 16));
  header.expect("GCOL");
  header.skip(4);
  const std::uint64_t size = header.eight();
  constexpr std::uint64_t longest = 1 << 20;
  if (size > longest)
    damaged("a heap is too large");
  Cursor objects(at(collection, size));
  objects.skip(16);
  while (objects.left() >= 16) {
    const unsigned number = objects.two();
    objects.skip(6);
    const std::uint64_t length = objects.eight();
    if (number == 0)
      break; // the space that is left
    const std::string_view object = objects.take(length);
    if (number == index)
      return object;
    objects.skip(std::min<std::uint64_t>((8 - length % 8) % 8, objects.left()));
  }
  damaged("a text is missing from its heap");
}

} // namespace fenestra
