#pragma once
// Streams samples from a file to a SampleStore block by block. Inflating, analyzing and storing
// overlap, and only the store is as large as the volume.

#include "files/medical/SampleStore.h"

#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <optional>
#include <variant>
#include <vector>

namespace fenestra::core {

/// Type of a sample: which alternative is active; its value is unused.
using SampleType =
    std::variant<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t, std::int32_t,
                 std::uint32_t, std::int64_t, std::uint64_t, float, double>;

inline std::size_t bytesPerSample(const SampleType& type) {
  return std::visit([](auto sample) { return sizeof sample; }, type);
}

struct Rescaling {
  double slope, intercept;
};

struct SampleSource {
  SampleType type = {};
  std::size_t count = 0;
  bool isSwapped = false; ///< byte order differs from the machine's
  std::optional<Rescaling> rescaling = {};
  /// Fills memory with the next bytes of the file, fewer than 2^30. Throws if the file ends early.
  std::function<void(void*, std::size_t)> read = {};
  /// Skips bytes of the file, faster than reading them. May be empty.
  std::function<void(std::uint64_t)> skip = {};
  /// Called after the last sample; throws if the file is damaged. May be empty.
  std::function<void()> finish = {};
};

template <typename T>
void swapBytes(T& x) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &x, sizeof(T));
  std::reverse(bytes.begin(), bytes.end());
  std::memcpy(&x, bytes.data(), sizeof(T));
}

/// Block of samples of the file's type T; rescaling converts them to `Rescaled`.
template <typename T>
class SampleBlock {
public:
  using Rescaled = std::conditional_t<sizeof(T) <= 2, float, double>;

  void read(const SampleSource& source, std::size_t count) {
    m_samples.resize(count);
    source.read(m_samples.data(), count * sizeof(T));
  }

  void prepare(const SampleSource& source) {
    if (source.isSwapped)
      std::for_each(m_samples.begin(), m_samples.end(), swapBytes<T>);
    if (!source.rescaling) {
      m_stats = computeStats(std::span<const T>(m_samples));
      return;
    }
    m_rescaled.resize(m_samples.size());
    std::transform(m_samples.begin(), m_samples.end(), m_rescaled.begin(),
                   [r = *source.rescaling](T x) {
                     return static_cast<Rescaled>(r.slope * static_cast<double>(x) + r.intercept);
                   });
    m_stats = computeStats(std::span<const Rescaled>(m_rescaled));
  }

  template <typename Store>
  void append(const SampleSource& source, Store& store) const {
    if (source.rescaling)
      store.append(std::span<const Rescaled>(m_rescaled), m_stats);
    else
      store.append(std::span<const T>(m_samples), m_stats);
  }

private:
  std::vector<T> m_samples;
  std::vector<Rescaled> m_rescaled;
  SampleStats m_stats;
};

/// Appends all samples to a SampleStore, in order. A pipeline overlaps reading (which inflates),
/// preparing and appending.
template <typename Store>
void readSamples(const SampleSource& source, Store& store) {
  constexpr std::size_t samplesInBlock = 1 << 18;
  constexpr std::size_t blocksInFlight = 4;
  const auto readAs = [&]<typename T>(T) {
    using Block = SampleBlock<T>;
    std::array<Block, blocksInFlight> blocks; // the pipeline reuses a block only after its append
    std::size_t started = 0;
    std::size_t remaining = source.count;
    const auto read = [&](tbb::flow_control& flow) -> Block* {
      if (remaining == 0) {
        flow.stop();
        return nullptr;
      }
      Block& block = blocks[started++ % blocksInFlight];
      const std::size_t count = std::min(remaining, samplesInBlock);
      block.read(source, count);
      remaining -= count;
      return &block;
    };
    const auto prepare = [&](Block* block) {
      block->prepare(source);
      return block;
    };
    const auto append = [&](const Block* block) { block->append(source, store); };
    using Mode = tbb::filter_mode;
    tbb::parallel_pipeline(blocksInFlight,
                           tbb::make_filter<void, Block*>(Mode::serial_in_order, read) &
                               tbb::make_filter<Block*, Block*>(Mode::parallel, prepare) &
                               tbb::make_filter<Block*, void>(Mode::serial_in_order, append));
  };
  std::visit(readAs, source.type);
  if (source.finish)
    source.finish();
}

} // namespace fenestra::core
