#include "model/masks/ThinParts.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <vector>

namespace fenestra {
namespace {

using Word = std::uint64_t;
constexpr std::int64_t wordBits = 64;

/// Set of voxels in a box, one bit each; rows along x are padded with zeros to complete words.
class VoxelSet {
public:
  VoxelSet(const Size3& size, const Vec3& spacing)
      : m_size(size),
        m_spacing(spacing),
        m_rowWords((size.x() + wordBits - 1) / wordBits),
        m_words(static_cast<std::size_t>(m_rowWords * size.y() * size.z())) {}

  const Size3& size() const { return m_size; }
  std::int64_t rowWords() const { return m_rowWords; }
  Word* row(std::int64_t y, std::int64_t z) {
    return m_words.data() + m_rowWords * (y + m_size.y() * z);
  }
  const Word* row(std::int64_t y, std::int64_t z) const {
    return m_words.data() + m_rowWords * (y + m_size.y() * z);
  }
  bool isEmpty() const {
    return std::ranges::all_of(m_words, [](Word word) { return word == 0; });
  }

  VoxelSet complement() const {
    VoxelSet result = *this;
    for (std::size_t i = 0; i < m_words.size(); ++i)
      result.m_words[i] = ~m_words[i] & findUsedBits(static_cast<std::int64_t>(i) % m_rowWords);
    return result;
  }

  /// Removes the voxels of another set.
  VoxelSet without(VoxelSet other) const {
    std::ranges::transform(m_words, other.m_words, other.m_words.begin(),
                           [](Word a, Word b) { return a & ~b; });
    return other;
  }

  /// Calls visit(linear index) for each voxel, in ascending order.
  template <typename Visit>
  void forEach(const Visit& visit) const {
    for (std::size_t i = 0; i < m_words.size(); ++i)
      for (Word word = m_words[i]; word != 0; word &= word - 1) {
        const auto row = static_cast<std::int64_t>(i) / m_rowWords;
        const auto x =
            static_cast<std::int64_t>(i) % m_rowWords * wordBits + std::countr_zero(word);
        visit(static_cast<std::size_t>(row * m_size.x() + x));
      }
  }

  void add(const VoxelSet& other) {
    std::ranges::transform(m_words, other.m_words, m_words.begin(), std::bit_or());
  }

  /// All voxels within `radius` mm of the set.
  VoxelSet dilate(double radius) const {
    VoxelSet result(m_size, m_spacing);
    const std::vector<RowOffset> offsets = findOffsets(radius);
    std::vector<char> isEmptyRow(static_cast<std::size_t>(m_size.y() * m_size.z()));
    for (std::size_t i = 0; i < isEmptyRow.size(); ++i) {
      const Word* const words = m_words.data() + static_cast<std::int64_t>(i) * m_rowWords;
      isEmptyRow[i] = std::all_of(words, words + m_rowWords, [](Word word) { return word == 0; });
    }
    tbb::parallel_for(std::int64_t{0}, m_size.z(), [&](std::int64_t z) {
      std::vector<Word> buffer(static_cast<std::size_t>(2 * m_rowWords));
      for (std::int64_t y = 0; y < m_size.y(); ++y)
        for (const RowOffset& offset : offsets) {
          const std::int64_t fromY = y + offset.y, fromZ = z + offset.z;
          if (fromY >= 0 && fromY < m_size.y() && fromZ >= 0 && fromZ < m_size.z() &&
              !isEmptyRow[static_cast<std::size_t>(fromY + m_size.y() * fromZ)])
            addDilatedRow(row(fromY, fromZ), offset.reach, buffer, result.row(y, z));
        }
    });
    return result;
  }

private:
  /// Bits of a word of a row that are voxels.
  Word findUsedBits(std::int64_t word) const {
    const std::int64_t bits = m_size.x() - wordBits * word;
    return bits >= wordBits ? ~Word{0} : (Word{1} << bits) - 1;
  }

  /// A row of a ball: its voxels are up to `reach` along x from its center.
  struct RowOffset {
    std::int64_t y, z, reach;
  };

  std::vector<RowOffset> findOffsets(double radius) const {
    constexpr double mostVoxels = 31.0; // limits time; shifts must be less than a word
    const Vec3 limits = (radius * m_spacing.cwiseInverse()).cwiseMin(mostVoxels);
    const auto floorToInt = [](double value) { return static_cast<std::int64_t>(value + 1e-6); };
    std::vector<RowOffset> offsets;
    for (std::int64_t z = -floorToInt(limits.z()); z <= floorToInt(limits.z()); ++z)
      for (std::int64_t y = -floorToInt(limits.y()); y <= floorToInt(limits.y()); ++y) {
        const double away = std::hypot(static_cast<double>(y) * m_spacing.y(),
                                       static_cast<double>(z) * m_spacing.z());
        if (away <= radius * (1.0 + 1e-6))
          offsets.push_back(
              {y, z,
               floorToInt(
                   std::min(std::sqrt(std::max(radius * radius - away * away, 0.0)) / m_spacing.x(),
                            mostVoxels))});
      }
    return offsets;
  }

  /// Adds a row, dilated by `reach` voxels in both directions.
  void addDilatedRow(const Word* from, std::int64_t reach, std::vector<Word>& buffer,
                     Word* to) const {
    Word* row = buffer.data();
    Word* next = row + m_rowWords;
    std::copy_n(from, m_rowWords, row);
    // [-a, a] shifted by up to 2 a + 1 in both directions covers a larger interval without gaps.
    for (std::int64_t done = 0; done < reach;) {
      const std::int64_t shift = std::min(reach - done, 2 * done + 1);
      for (std::int64_t i = 0; i < m_rowWords; ++i) {
        const Word before = i > 0 ? row[i - 1] : 0, after = i + 1 < m_rowWords ? row[i + 1] : 0;
        next[i] = row[i] | row[i] << shift | before >> (wordBits - shift) | row[i] >> shift |
                  after << (wordBits - shift);
      }
      std::swap(row, next);
      done += shift;
    }
    for (std::int64_t i = 0; i < m_rowWords; ++i)
      to[i] |= row[i] & findUsedBits(i);
  }

  Size3 m_size;
  Vec3 m_spacing;
  std::int64_t m_rowWords;
  std::vector<Word> m_words;
};

VoxelSet findInside(const Mask& mask, const Size3& first, const Size3& size) {
  VoxelSet inside(size, mask.grid.spacing());
  const Size3 last = mask.grid.size.array() - 1;
  tbb::parallel_for(std::int64_t{0}, size.z(), [&](std::int64_t z) {
    for (std::int64_t y = 0; y < size.y(); ++y) {
      Word* const row = inside.row(y, z);
      for (std::int64_t x = 0; x < size.x(); ++x) {
        const Size3 voxel = (first + Size3(x, y, z)).cwiseMax(0).cwiseMin(last);
        if (mask.voxels[linearIndex(voxel, mask.grid.size)] >= mask.threshold())
          row[x / wordBits] |= Word{1} << (x % wordBits);
      }
    }
  });
  return inside;
}

/// Voxels of the set that are more than 2 * radius from every center of a ball in it.
VoxelSet findNarrow(const VoxelSet& set, double radius) {
  const VoxelSet centers = set.complement().dilate(radius).complement();
  return set.without(centers.dilate(2.0 * radius));
}

} // namespace

ThinParts findThinParts(const Mask& mask, const Size3& first, const Size3& size, double radius) {
  const VoxelSet inside = findInside(mask, first, size);
  const VoxelSet parts = findNarrow(inside, radius), gaps = findNarrow(inside.complement(), radius);
  if (parts.isEmpty() && gaps.isEmpty())
    return {};
  VoxelSet places = parts;
  places.add(gaps);
  places = places.dilate(2.0 * radius);
  ThinParts result{std::vector<std::uint8_t>(static_cast<std::size_t>(size.prod())), {}};
  places.forEach([&](std::size_t voxel) { result.places[voxel] = 1; });
  parts.forEach([&](std::size_t voxel) { result.inside.push_back(voxel); });
  return result;
}

} // namespace fenestra
