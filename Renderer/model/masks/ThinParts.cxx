#include "model/masks/ThinParts.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <map>
#include <utility>
#include <vector>

namespace fenestra::core {
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
    VoxelSet result(m_size, m_spacing), along = *this; // dilated along x
    std::int64_t reach = 0;
    for (const auto& ring : findOffsets(radius)) {
      const auto& offsets = ring.second; // clang 14 cannot capture a structured binding
      for (; reach < ring.first; ++reach)
        along.dilateRows();
      tbb::parallel_for(std::int64_t{0}, m_size.z(), [&](std::int64_t z) {
        for (std::int64_t y = 0; y < m_size.y(); ++y)
          for (const auto& [offsetY, offsetZ] : offsets) {
            const std::int64_t fromY = y + offsetY, fromZ = z + offsetZ;
            if (fromY < 0 || fromY >= m_size.y() || fromZ < 0 || fromZ >= m_size.z())
              continue;
            const Word* const from = along.row(fromY, fromZ);
            Word* const to = result.row(y, z);
            for (std::int64_t i = 0; i < m_rowWords; ++i)
              to[i] |= from[i];
          }
      });
    }
    return result;
  }

private:
  /// Bits of a word of a row that are voxels.
  Word findUsedBits(std::int64_t word) const {
    const std::int64_t bits = m_size.x() - wordBits * word;
    return bits >= wordBits ? ~Word{0} : (Word{1} << bits) - 1;
  }

  /// Rows of a ball, y and z from its center, by their half length in voxels.
  using BallRows = std::map<std::int64_t, std::vector<std::pair<std::int64_t, std::int64_t>>>;

  BallRows findOffsets(double radius) const {
    constexpr double mostVoxels = 31.0; // limits time
    const Vec3 limits = (radius * m_spacing.cwiseInverse()).cwiseMin(mostVoxels);
    const auto floorToInt = [](double value) { return static_cast<std::int64_t>(value + 1e-6); };
    BallRows rows;
    for (std::int64_t z = -floorToInt(limits.z()); z <= floorToInt(limits.z()); ++z)
      for (std::int64_t y = -floorToInt(limits.y()); y <= floorToInt(limits.y()); ++y) {
        const double away = std::hypot(static_cast<double>(y) * m_spacing.y(),
                                       static_cast<double>(z) * m_spacing.z());
        if (away > radius * (1.0 + 1e-6))
          continue;
        const double half = std::sqrt(std::max(radius * radius - away * away, 0.0));
        rows[floorToInt(std::min(half / m_spacing.x(), mostVoxels))].emplace_back(y, z);
      }
    return rows;
  }

  /// Adds the neighbors of the voxels along x.
  void dilateRows() {
    tbb::parallel_for(std::int64_t{0}, m_size.y() * m_size.z(), [&](std::int64_t y) {
      Word* const words = row(y, 0);
      Word before = 0;
      for (std::int64_t i = 0; i < m_rowWords; ++i) {
        const Word here = words[i], after = i + 1 < m_rowWords ? words[i + 1] : 0;
        words[i] =
            (here | here << 1 | before >> (wordBits - 1) | here >> 1 | after << (wordBits - 1)) &
            findUsedBits(i);
        before = here;
      }
    });
  }

  Size3 m_size;
  Vec3 m_spacing;
  std::int64_t m_rowWords;
  std::vector<Word> m_words;
};

VoxelSet findInside(const Mask& mask, const Size3& first, const Size3& size) {
  VoxelSet inside(size, mask.grid.spacing());
  const Size3 last = mask.grid.size.array() - 1;
  const std::uint8_t threshold = mask.threshold();
  tbb::parallel_for(std::int64_t{0}, size.z(), [&](std::int64_t z) {
    for (std::int64_t y = 0; y < size.y(); ++y) {
      const Size3 start = (first + Size3(0, y, z)).cwiseMax(0).cwiseMin(last);
      const std::uint8_t* const from =
          mask.voxels.data() + linearIndex({0, start.y(), start.z()}, mask.grid.size);
      Word* const to = inside.row(y, z);
      for (std::int64_t x = 0; x < size.x(); ++x) {
        const std::int64_t fromX = std::clamp<std::int64_t>(first.x() + x, 0, last.x());
        to[x / wordBits] |= Word{from[fromX] >= threshold} << (x % wordBits);
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

} // namespace fenestra::core
