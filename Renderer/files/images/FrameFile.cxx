#include "files/images/FrameFile.h"

#include "base/Error.h"
#include "io/platform/OutputTarget.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstring>

namespace fenestra::core {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t wordBytes = sizeof(std::uint64_t);
constexpr std::size_t headerWords = 64, firstLayer = 14, layerWords = 4;
constexpr std::size_t sequenceWord = 2, cameraWord = 46;

std::size_t countWords(std::size_t bytes) {
  return (bytes + wordBytes - 1) / wordBytes;
}

std::uint64_t toWord(std::string_view text) {
  std::uint64_t word = 0;
  std::memcpy(&word, text.data(), std::min(text.size(), wordBytes));
  return word;
}

std::uint64_t toWord(double value) {
  return std::bit_cast<std::uint64_t>(value);
}

using Header = std::array<std::uint64_t, headerWords>;

Header makeHeader(std::size_t fileBytes) {
  return {toWord("FENFRAME"), 1, 0, fileBytes};
}

void addCamera(const FrameCamera& camera, Header& header) {
  std::size_t word = cameraWord;
  for (const Vec3& vector : {camera.position, camera.target, camera.up})
    for (const double coordinate : vector)
      header[word++] = toWord(coordinate);
  header[word++] = camera.isOrthographic ? 1 : 0;
  header[word] = toWord(camera.extent);
}

/// Creates the file, so that it is in place before it is mapped.
const std::filesystem::path& create(const std::filesystem::path& path, Outputs& outputs) {
  if (findStream(path))
    throw outputError(path, "is a stream, which cannot be mapped; name a file");
  const Header header = makeHeader(sizeof(Header));
  outputs.write(path, {reinterpret_cast<const char*>(header.data()), sizeof header});
  outputs.commit(Durability::none);
  return path;
}

} // namespace

FrameFile::FrameFile(const std::filesystem::path& path, Outputs& outputs)
    : m_file(create(path, outputs)) {
  m_file.extend(sizeof(Header));
}

/// Release order: a reader that sees a new word also sees the odd sequence before it.
void FrameFile::store(std::size_t word, std::uint64_t value) {
  auto* const words = reinterpret_cast<std::uint64_t*>(m_file.bytes().data());
  std::atomic_ref(words[word]).store(value, std::memory_order_release);
}

void FrameFile::store(std::size_t word, std::span<const std::byte> bytes) {
  for (; !bytes.empty(); ++word) {
    std::uint64_t value = 0;
    const std::size_t count = std::min(bytes.size(), wordBytes);
    std::memcpy(&value, bytes.data(), count);
    store(word, value);
    bytes = bytes.subspan(count);
  }
}

void FrameFile::publish(const FrameInfo& info, std::span<const FrameLayer> layers) {
  std::size_t words = headerWords;
  for (const FrameLayer& layer : layers)
    words += countWords(layer.values.size());
  m_file.extend(words * wordBytes);
  Header header = makeHeader(m_file.bytes().size());
  const auto integer = [](auto value) { return static_cast<std::uint64_t>(value); };
  const std::uint64_t values[] = {integer(info.request),    integer(info.width),
                                  integer(info.height),     integer(info.fullWidth),
                                  integer(info.fullHeight), info.samples,
                                  toWord(info.noise),       toWord(info.denoisedNoise),
                                  integer(info.isLast),     layers.size()};
  std::ranges::copy(values, &header[4]);
  addCamera(info.camera, header);
  header[sequenceWord] = m_sequence + 1;
  store(sequenceWord, header[sequenceWord]);
  std::size_t offset = headerWords, entry = firstLayer;
  for (const FrameLayer& layer : layers) {
    header.at(entry) = toWord(layer.name);
    header.at(entry + 1) = offset * wordBytes;
    header.at(entry + 2) = integer(layer.components);
    header.at(entry + 3) = integer(layer.bytesPerValue);
    store(offset, layer.values);
    offset += countWords(layer.values.size());
    entry += layerWords;
  }
  store(0, std::as_bytes(std::span(header)));
  m_sequence += 2;
  store(sequenceWord, m_sequence);
}

} // namespace fenestra::core
