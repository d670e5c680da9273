#include "clip/focus/FocusCells.h"

#include "base/Error.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>

namespace fenestra::core {
namespace {

constexpr std::int64_t edge = FocusCells::blockSize;
constexpr std::int64_t cornersPerEdge = edge + 1; ///< voxels along an edge of a block

/// Smallest voxel value above captureThreshold.
std::uint8_t voxelThreshold(const Mask& mask) {
  return static_cast<std::uint8_t>(std::floor(FocusCells::captureThreshold * mask.maxValue) + 1.0);
}

/// Reads the mask's voxels at the corners of a block's cells.
class Voxels {
public:
  explicit Voxels(const Mask& mask)
      : m_voxels(mask.voxels.data()), m_size(mask.grid.size), m_threshold(voxelThreshold(mask)) {}

  /// Compares the voxels of row (y, z) with the threshold, for a block's four cells along x.
  /// Returns one byte per cell, first cell lowest: bits 0 and 1 stand for its two corners along x.
  /// 0 outside the mask.
  std::uint32_t neighborPairs(std::int64_t blockX, std::int64_t y, std::int64_t z) const {
    if (y < 0 || z < 0 || y >= m_size.y() || z >= m_size.z())
      return 0;
    const std::int64_t first = blockX * edge - 1;
    const std::uint8_t* row = m_voxels + m_size.x() * (y + m_size.y() * z);
    std::uint64_t word = 0; // little-endian bytes, 0 or 1
    if (m_threshold == 1 && first >= 0 && first + 8 <= m_size.x()) {
      std::memcpy(&word, row + first, sizeof(word));
    } else {
      const std::int64_t end = std::min(first + cornersPerEdge, m_size.x());
      for (std::int64_t x = std::max<std::int64_t>(first, 0); x < end; ++x)
        word |= std::uint64_t{row[x] >= m_threshold} << (8 * (x - first));
    }
    return static_cast<std::uint32_t>(word | word >> 7);
  }

  std::uint8_t at(std::int64_t x, std::int64_t y, std::int64_t z) const {
    const Size3 voxel(x, y, z);
    const bool isInside = (voxel.array() >= 0).all() && (voxel.array() < m_size.array()).all();
    return isInside ? m_voxels[x + m_size.x() * (y + m_size.y() * z)] : std::uint8_t{0};
  }

private:
  const std::uint8_t* m_voxels;
  Size3 m_size;
  std::uint8_t m_threshold;
};

/// Per block of a layer, x fastest: 1 if any corner of its cells is above captureThreshold. First
/// reduces the rows of voxels around each row of blocks to their maxima.
std::vector<std::uint8_t> findOccupied(const Mask& mask, const Size3& blocks, std::int64_t blockZ) {
  const Size3& size = mask.grid.size;
  const auto range = [&](std::int64_t block, int axis) { // first and end
    return std::pair(std::max<std::int64_t>(0, block * edge - 1),
                     std::min(size[axis], (block + 1) * edge));
  };
  std::vector<std::uint8_t> result(static_cast<std::size_t>(blocks.x() * blocks.y()));
  std::vector<std::uint8_t> maxima(static_cast<std::size_t>(size.x()));
  const auto [firstZ, endZ] = range(blockZ, 2);
  for (std::int64_t by = 0; by < blocks.y(); ++by) {
    std::ranges::fill(maxima, std::uint8_t{0});
    const auto [firstY, endY] = range(by, 1);
    for (std::int64_t z = firstZ; z < endZ; ++z)
      for (std::int64_t y = firstY; y < endY; ++y)
        std::transform(maxima.begin(), maxima.end(),
                       mask.voxels.data() + size.x() * (y + size.y() * z), maxima.begin(),
                       [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); });
    for (std::int64_t bx = 0; bx < blocks.x(); ++bx) {
      const auto [first, end] = range(bx, 0);
      result[static_cast<std::size_t>(bx + blocks.x() * by)] =
          std::any_of(maxima.begin() + first, maxima.begin() + end,
                      [&](std::uint8_t voxel) { return voxel >= voxelThreshold(mask); });
    }
  }
  return result;
}

/// Fills a block's corner bits; returns true if all are set.
bool fillCorners(const Voxels& voxels, const Size3& block,
                 std::array<std::uint8_t, edge * edge * edge>& result) {
  std::array<std::array<std::uint32_t, cornersPerEdge>, cornersPerEdge> neighborPairs;
  for (std::int64_t k = 0; k < cornersPerEdge; ++k)
    for (std::int64_t j = 0; j < cornersPerEdge; ++j)
      neighborPairs[static_cast<std::size_t>(k)][static_cast<std::size_t>(j)] =
          voxels.neighborPairs(block.x(), block.y() * edge + j - 1, block.z() * edge + k - 1);
  bool isFull = true;
  for (std::size_t k = 0; k < edge; ++k)
    for (std::size_t j = 0; j < edge; ++j) {
      const std::uint32_t both = 0x03030303U; // bits 0 and 1 of each cell
      const std::uint32_t row =
          (neighborPairs[k][j] & both) | (neighborPairs[k][j + 1] & both) << 2 |
          (neighborPairs[k + 1][j] & both) << 4 | (neighborPairs[k + 1][j + 1] & both) << 6;
      isFull = isFull && row == 0xffffffffU;
      std::memcpy(&result[edge * (j + edge * k)], &row, sizeof(row));
    }
  return isFull;
}

/// Fills a block's corner values (5 x 5 x 5, then padding) and returns their minimum.
std::uint8_t fillValues(const Voxels& voxels, const Size3& block,
                        std::array<std::uint8_t, 128>& result) {
  std::uint8_t least = 255;
  std::size_t i = 0;
  for (std::int64_t z = 0; z < cornersPerEdge; ++z)
    for (std::int64_t y = 0; y < cornersPerEdge; ++y)
      for (std::int64_t x = 0; x < cornersPerEdge; ++x) {
        const Size3 voxel = edge * block + Size3(x, y, z) - Size3::Ones();
        result[i] = voxels.at(voxel.x(), voxel.y(), voxel.z());
        least = std::min(least, result[i++]);
      }
  return least;
}

} // namespace

FocusCells::FocusCells(const Mask& mask)
    : m_count(mask.grid.size.array() + 1),
      m_blocks((m_count.array() + blockSize - 1) / blockSize),
      m_worldToCell(makeTranslation(Vec3::Ones()) * mask.grid.worldToIndex),
      m_valueScale(1.0 / mask.maxValue) {
  const std::int64_t bytes = m_blocks.prod() * static_cast<std::int64_t>(sizeof(BlockValues));
  if (bytes > std::numeric_limits<std::int32_t>::max())
    throw inputError(ErrorCode::limitExceeded, "focus",
                     "spans more than 2^30 voxels; crop the segmentation");
  m_blockCorners.resize(static_cast<std::size_t>(m_blocks.prod()), emptyBlock);
  m_corners.resize(2);
  m_corners[emptyBlock].fill(0);
  m_corners[fullBlock].fill(0xff);
  const bool isSmooth = mask.maxValue != 1;
  if (isSmooth) {
    m_values.resize(2);
    m_values[emptyBlock].fill(0);
    m_values[fullBlock].fill(mask.maxValue);
  }
  std::vector<std::vector<Block>> layers(static_cast<std::size_t>(m_blocks.z()));
  tbb::parallel_for(std::int64_t{0}, m_blocks.z(), [&](std::int64_t z) {
    layers[static_cast<std::size_t>(z)] = buildLayer(mask, z);
  });
  const std::size_t perLayer = static_cast<std::size_t>(m_blocks.x() * m_blocks.y());
  for (std::size_t z = 0; z < layers.size(); ++z) {
    // buildLayer numbers the mixed blocks of its layer -1, -2, …; make the indices global.
    const auto firstIndex = static_cast<std::int32_t>(m_corners.size());
    for (std::size_t i = z * perLayer; i < (z + 1) * perLayer; ++i)
      if (m_blockCorners[i] < 0)
        m_blockCorners[i] = firstIndex - 1 - m_blockCorners[i];
    for (const Block& block : layers[z]) {
      m_corners.push_back(block.corners);
      if (isSmooth)
        m_values.push_back(block.values);
    }
  }
  m_corners.emplace_back(); // padding: gathers read four bytes per cell
}

double FocusCells::indicator(const Vec3& point) const {
  if (!(point.array() >= 0.0).all() || !(point.array() < m_count.cast<double>().array()).all())
    return 0.0;
  const Size3 cell = point.cast<std::int64_t>();
  const Vec3 f = point - cell.cast<double>();
  const Size3 block = cell / blockSize, local = cell - blockSize * block;
  const auto which =
      static_cast<std::size_t>(m_blockCorners[static_cast<std::size_t>(blockIndex(block))]);
  const auto corner = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
    if (m_values.empty()) {
      const std::int64_t at = local.x() + blockSize * (local.y() + blockSize * local.z());
      return static_cast<double>(
          m_corners[which][static_cast<std::size_t>(at)] >> (x + 2 * y + 4 * z) & 1);
    }
    const std::int64_t at =
        local.x() + x + cornersPerEdge * (local.y() + y + cornersPerEdge * (local.z() + z));
    return m_valueScale * m_values[which][static_cast<std::size_t>(at)];
  };
  const auto row = [&](std::int64_t y, std::int64_t z) {
    return corner(0, y, z) + f.x() * (corner(1, y, z) - corner(0, y, z));
  };
  const double front = row(0, 0) + f.y() * (row(1, 0) - row(0, 0));
  const double back = row(0, 1) + f.y() * (row(1, 1) - row(0, 1));
  return front + f.z() * (back - front);
}

FocusCells::Layout FocusCells::layout() const {
  return {m_blockCorners.data(),
          m_corners.front().data(),
          m_blocks,
          m_values.empty() ? nullptr : m_values.front().data(),
          m_valueScale,
          m_corners.size() - 1}; // without the padding
}

/// Returns the mixed blocks of a layer, which m_blockCorners numbers -1, -2, … within the layer.
std::vector<FocusCells::Block> FocusCells::buildLayer(const Mask& mask, std::int64_t z) {
  const Voxels voxels(mask);
  const std::vector<std::uint8_t> isOccupied = findOccupied(mask, m_blocks, z);
  std::vector<Block> result;
  for (std::int64_t y = 0; y < m_blocks.y(); ++y)
    for (std::int64_t x = 0; x < m_blocks.x(); ++x) {
      const Size3 at(x, y, z);
      if (!isOccupied[static_cast<std::size_t>(x + m_blocks.x() * y)])
        continue;
      Block block{};
      bool isFull = fillCorners(voxels, at, block.corners);
      if (mask.maxValue != 1)
        isFull = fillValues(voxels, at, block.values) >= mask.threshold();
      std::int32_t& where = m_blockCorners[static_cast<std::size_t>(blockIndex(at))];
      if (isFull) {
        where = fullBlock;
      } else {
        result.push_back(block);
        where = -static_cast<std::int32_t>(result.size());
      }
    }
  return result;
}

} // namespace fenestra::core
