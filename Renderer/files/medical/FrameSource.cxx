#include "files/medical/FrameSource.h"

#include <memory>

namespace fenestra::core {
namespace {

constexpr std::size_t blockBytes = 1 << 20;

void skipBytes(const SampleSource& source, std::uint64_t bytes) {
  if (source.skip)
    return source.skip(bytes);
  std::vector<char> block(static_cast<std::size_t>(std::min<std::uint64_t>(bytes, blockBytes)));
  while (bytes > 0) {
    const std::uint64_t part = std::min<std::uint64_t>(bytes, block.size());
    source.read(block.data(), static_cast<std::size_t>(part));
    bytes -= part;
  }
}

/// Reads one sample of each voxel.
class InterleavedFrame {
public:
  InterleavedFrame(SampleSource all, const FrameChoice& choice)
      : m_all(std::move(all)),
        m_sampleBytes(bytesPerSample(m_all.type)),
        m_before(choice.frame * m_sampleBytes),
        m_voxelBytes(choice.count * m_sampleBytes) {}

  void read(void* to, std::size_t bytes) {
    auto* out = static_cast<char*>(to);
    for (char* const end = out + bytes; out < end;)
      out = m_voxelBytes > blockBytes ? readVoxel(out) : readBlock(out, end);
  }

private:
  char* readVoxel(char* out) const {
    skipBytes(m_all, m_before);
    m_all.read(out, m_sampleBytes);
    skipBytes(m_all, m_voxelBytes - m_before - m_sampleBytes);
    return out + m_sampleBytes;
  }

  char* readBlock(char* out, const char* end) {
    const std::size_t voxels =
        std::min(static_cast<std::size_t>(end - out) / m_sampleBytes, blockBytes / m_voxelBytes);
    m_block.resize(voxels * m_voxelBytes);
    m_all.read(m_block.data(), m_block.size());
    for (std::size_t at = m_before; at < m_block.size(); at += m_voxelBytes) {
      std::memcpy(out, &m_block[at], m_sampleBytes);
      out += m_sampleBytes;
    }
    return out;
  }

  SampleSource m_all;
  std::size_t m_sampleBytes, m_before, m_voxelBytes;
  std::vector<char> m_block;
};

} // namespace

SampleSource pickFrame(SampleSource all, const FrameChoice& choice) {
  if (choice.count == 1)
    return all;
  SampleSource one = all;
  one.count = all.count / choice.count;
  one.skip = nullptr;
  if (choice.isInterleaved) {
    const auto voxels = std::make_shared<InterleavedFrame>(std::move(all), choice);
    one.read = [voxels](void* to, std::size_t bytes) { voxels->read(to, bytes); };
    return one;
  }
  if (choice.frame + 1 < choice.count)
    one.finish = nullptr;
  const std::uint64_t before = std::uint64_t{choice.frame} * one.count * bytesPerSample(all.type);
  one.read = [all, before, isAtFrame = false](void* to, std::size_t bytes) mutable {
    if (!std::exchange(isAtFrame, true))
      skipBytes(all, before);
    all.read(to, bytes);
  };
  return one;
}

} // namespace fenestra::core
