#include "files/medical/ArraySource.h"

#include <tbb/parallel_for.h>

#include <memory>

namespace fenestra::core {
namespace {

/// Reads an array in the order of its indices, x fastest. Slices are gathered several at a time,
/// since in an array whose last axis is fastest their samples share cache lines.
class ArrayReader {
public:
  explicit ArrayReader(const SampleArray& array)
      : m_array(array),
        m_sampleBytes(static_cast<std::int64_t>(bytesPerSample(array.type))),
        m_sliceBytes(array.size.x() * array.size.y() * m_sampleBytes) {
    constexpr std::int64_t cacheLine = 64, mostBytes = std::int64_t{64} << 20;
    m_slabSlices = std::clamp<std::int64_t>(mostBytes / m_sliceBytes, 1, cacheLine / m_sampleBytes);
  }

  void read(void* to, std::size_t bytes) {
    auto* next = static_cast<char*>(to);
    while (bytes > 0) {
      if (m_begin == m_slab.size())
        gather();
      const std::size_t count = std::min(bytes, m_slab.size() - m_begin);
      next = std::copy_n(m_slab.data() + m_begin, count, next);
      m_begin += count;
      bytes -= count;
    }
  }

private:
  void gather() {
    const std::int64_t slices = std::min(m_slabSlices, m_array.size.z() - m_nextSlice);
    m_slab.resize(static_cast<std::size_t>(slices * m_sliceBytes));
    tbb::parallel_for(std::int64_t{0}, m_array.size.y(), [&](std::int64_t y) {
      for (std::int64_t x = 0; x < m_array.size.x(); ++x)
        for (std::int64_t z = 0; z < slices; ++z) {
          const Size3 at(x, y, m_nextSlice + z);
          std::memcpy(m_slab.data() + z * m_sliceBytes + (y * m_array.size.x() + x) * m_sampleBytes,
                      m_array.data + at.dot(m_array.steps),
                      static_cast<std::size_t>(m_sampleBytes));
        }
    });
    m_nextSlice += slices;
    m_begin = 0;
  }

  SampleArray m_array;
  std::int64_t m_sampleBytes, m_sliceBytes, m_slabSlices, m_nextSlice = 0;
  std::vector<char> m_slab;
  std::size_t m_begin = 0; ///< of what is not read yet, in the slab
};

bool isPacked(const SampleArray& array, std::int64_t sampleBytes) {
  return array.steps.x() == sampleBytes && array.steps.y() == array.steps.x() * array.size.x() &&
         array.steps.z() == array.steps.y() * array.size.y();
}

} // namespace

SampleSource makeArraySource(const SampleArray& array) {
  SampleSource source{.type = array.type,
                      .count = static_cast<std::size_t>(array.size.prod()),
                      .isSwapped = array.isSwapped};
  if (isPacked(array, static_cast<std::int64_t>(bytesPerSample(array.type))))
    source.read = [next = array.data](void* to, std::size_t bytes) mutable {
      std::memcpy(to, next, bytes);
      next += bytes;
    };
  else
    source.read = [reader = std::make_shared<ArrayReader>(array)](void* to, std::size_t bytes) {
      reader->read(to, bytes);
    };
  return source;
}

} // namespace fenestra::core
