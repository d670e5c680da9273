#include "FenestraFrame.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>

namespace SlicerExport {
namespace {

using Word = std::uint64_t;
static_assert(sizeof(std::atomic<Word>) == sizeof(Word) && std::atomic<Word>::is_always_lock_free);

constexpr std::size_t headerWords = 64, sequenceWord = 2, firstLayer = 14, layerWords = 4,
                      cameraWord = 46;
using Header = std::array<Word, headerWords>;

/// Acquire order: whoever reads a new word also sees that the sequence is odd.
Word load(const void* memory, std::size_t word) {
  return static_cast<const std::atomic<Word>*>(memory)[word].load(std::memory_order_acquire);
}

template <typename Value>
Value as(Word word) {
  static_assert(sizeof(Value) == sizeof word);
  Value value;
  std::memcpy(&value, &word, sizeof value);
  return value;
}

template <typename Value>
std::vector<Value> copy(const void* memory, std::size_t firstWord, std::size_t count) {
  std::vector<Value> values(count);
  auto* bytes = reinterpret_cast<unsigned char*>(values.data());
  std::size_t left = count * sizeof(Value);
  for (std::size_t i = firstWord; left > 0; ++i) {
    const Word word = load(memory, i);
    const std::size_t part = std::min(left, sizeof word);
    std::memcpy(bytes, &word, part);
    bytes += part;
    left -= part;
  }
  return values;
}

/// A layer of the header, checked against the memory. Throws std::runtime_error.
class Layers {
public:
  Layers(const void* memory, std::size_t size, const Header& header, std::size_t pixels)
      : m_memory(memory), m_size(size), m_header(header), m_pixels(pixels) {}

  template <typename Value>
  std::optional<std::vector<Value>> read(const char* name, std::size_t components) const {
    const std::size_t count = std::min<Word>(m_header[firstLayer - 1], 8);
    for (std::size_t i = 0; i < count; ++i) {
      const Word* const entry = &m_header[firstLayer + i * layerWords];
      Word key = 0;
      std::memcpy(&key, name, std::min(std::strlen(name), sizeof key));
      if (entry[0] != key)
        continue;
      const std::size_t values = m_pixels * components, bytes = values * sizeof(Value);
      if (entry[2] != components || entry[3] != sizeof(Value) || entry[1] % sizeof(Word) != 0 ||
          entry[1] > m_size || (bytes + 7) / 8 * 8 > m_size - entry[1])
        throw std::runtime_error("The image of the renderer has a wrong layer.");
      return copy<Value>(m_memory, entry[1] / sizeof(Word), values);
    }
    return std::nullopt;
  }

private:
  const void* m_memory;
  std::size_t m_size;
  const Header& m_header;
  std::size_t m_pixels;
};

Header readHeader(const void* memory) {
  Header header{};
  for (std::size_t i = 0; i < headerWords; ++i)
    header[i] = load(memory, i);
  return header;
}

int toSide(Word word) {
  constexpr Word most = 1 << 16;
  if (word == 0 || word > most)
    throw std::runtime_error("The image of the renderer has a wrong size.");
  return static_cast<int>(word);
}

Frame readImage(const void* memory, std::size_t size, const Header& header) {
  Frame frame;
  frame.request = as<std::int64_t>(header[4]);
  frame.width = toSide(header[5]);
  frame.height = toSide(header[6]);
  frame.fullWidth = toSide(header[7]);
  frame.fullHeight = toSide(header[8]);
  frame.samples = header[9];
  frame.noise = as<double>(header[11]);
  if (std::isnan(frame.noise))
    frame.noise = as<double>(header[10]);
  frame.isLast = header[12] != 0;
  const Word* camera = &header[cameraWord];
  for (auto* vector : {&frame.position, &frame.target, &frame.up})
    for (double& coordinate : *vector)
      coordinate = as<double>(*camera++);
  frame.isOrthographic = *camera++ != 0;
  frame.extent = as<double>(*camera);
  const std::size_t pixels =
      static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  const Layers layers(memory, size, header, pixels);
  auto display = layers.read<std::uint8_t>("display", 4);
  auto depth = layers.read<float>("depth", 1);
  if (!display || !depth)
    throw std::runtime_error("The image of the renderer lacks a layer.");
  frame.display = std::move(*display);
  frame.depth = std::move(*depth);
  if (const auto middle = layers.read<float>("depth50", 1))
    for (std::size_t i = 0; i < pixels; ++i)
      if (std::isfinite((*middle)[i]))
        frame.depth[i] = (*middle)[i];
  return frame;
}

} // namespace

FrameState readFrame(const void* memory, std::size_t size, Frame& frame) {
  if (size < sizeof(Header))
    throw std::runtime_error("The renderer's file has no image.");
  const Header header = readHeader(memory);
  if (std::memcmp(header.data(), "FENFRAME", sizeof(Word)) != 0 || header[1] != 1)
    throw std::runtime_error("The renderer's image is of another version.");
  if (header[sequenceWord] == 0)
    return FrameState::empty;
  if (header[sequenceWord] % 2 != 0 || load(memory, sequenceWord) != header[sequenceWord])
    return FrameState::busy;
  if (header[3] > size)
    return FrameState::outgrown;
  Frame image;
  std::optional<std::runtime_error> failure;
  try {
    image = readImage(memory, size, header);
  } catch (const std::runtime_error& error) {
    failure = error;
  }
  if (load(memory, sequenceWord) != header[sequenceWord])
    return FrameState::busy;
  if (failure)
    throw *failure;
  frame = std::move(image);
  return FrameState::complete;
}

} // namespace SlicerExport
