#include "clipping/FocusDepth.h"

#include "clipping/CellCubic.h"
#include "volume/GridWalk.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <cstring>

namespace fenestra {

namespace {

/// A mask's dual cells: cell c lies between the voxel centres c - 1 and c of each axis, so that the
/// outermost cells hold the fall to 0 outside the mask's grid.
class DualCells {
public:
  explicit DualCells(const Mask& mask)
      : m_voxels(mask.voxels.data()),
        m_size(mask.grid.size),
        m_count(m_size.array() + 1),
        m_blocks((m_count.array() + blockSize - 1) / blockSize),
        m_worldToCell(Eigen::Translation3d(Vec3::Ones()) * mask.grid.worldToIndex) {
    markBlocks();
  }

  /// The least t in the range at which a world ray is in the mask (indicator >= 0.5), else
  /// infinity.
  double firstMeeting(const Ray& world, const Interval& range) const {
    const Ray ray = transformed(m_worldToCell, world);
    const Ray blockRay{ray.origin / blockSize, ray.direction / blockSize};
    for (GridWalk block(blockRay, range, m_blocks); !block.done(); block.next()) {
      if (!m_occupied[static_cast<std::size_t>(block.cell())])
        continue;
      for (GridWalk cell(ray, block.interval(), m_count); !cell.done(); cell.next()) {
        const unsigned corners = cornerBits(cell.coordinates());
        if (corners == 0)
          continue;
        const double t = meetingInCell(corners, ray, cell.coordinates(), cell.interval());
        if (t < infinity)
          return t;
      }
    }
    return infinity;
  }

private:
  static constexpr std::int64_t blockSize = 8;

  /// Marks the blocks of cells that have a voxel of the mask at any corner.
  void markBlocks() {
    m_occupied.assign(static_cast<std::size_t>(m_blocks.prod()), 0);
    tbb::parallel_for(std::int64_t{0}, m_blocks.z(), [this](std::int64_t bz) {
      for (std::int64_t by = 0; by < m_blocks.y(); ++by)
        for (std::int64_t bx = 0; bx < m_blocks.x(); ++bx) {
          const std::int64_t block = bx + m_blocks.x() * (by + m_blocks.y() * bz);
          m_occupied[static_cast<std::size_t>(block)] = hasVoxel(Size3(bx, by, bz) * blockSize);
        }
    });
  }

  /// Whether any corner of the block of cells that begins at `cell` is a voxel of the mask.
  bool hasVoxel(const Size3& cell) const {
    const Size3 first = (cell.array() - 1).max(0);
    const Size3 end = (cell.array() + blockSize).min(m_size.array());
    for (std::int64_t z = first.z(); z < end.z(); ++z)
      for (std::int64_t y = first.y(); y < end.y(); ++y)
        if (std::memchr(row(y, z) + first.x(), 1, static_cast<std::size_t>(end.x() - first.x())))
          return true;
    return false;
  }

  const std::uint8_t* row(std::int64_t y, std::int64_t z) const {
    return m_voxels + m_size.x() * (y + m_size.y() * z);
  }

  /// Bit i: the indicator at corner i of a cell (x fastest).
  unsigned cornerBits(const Size3& cell) const {
    unsigned bits = 0;
    for (int i = 0; i < 4; ++i) {
      const std::int64_t y = cell.y() - 1 + (i & 1), z = cell.z() - 1 + (i >> 1);
      if (y < 0 || z < 0 || y >= m_size.y() || z >= m_size.z())
        continue;
      const std::uint8_t* voxels = row(y, z);
      if (cell.x() > 0)
        bits |= unsigned{voxels[cell.x() - 1]} << (2 * i);
      if (cell.x() < m_size.x())
        bits |= unsigned{voxels[cell.x()]} << (2 * i + 1);
    }
    return bits;
  }

  static double meetingInCell(unsigned corners, const Ray& ray, const Size3& cell,
                              const Interval& interval) {
    std::array<double, 8> level;
    for (unsigned i = 0; i < 8; ++i)
      level[i] = (corners >> i & 1U ? 1.0 : 0.0) - 0.5;
    const double length = interval.end - interval.begin;
    const Vec3 from = ray.at(interval.begin) - cell.cast<double>();
    const double s = firstNonNegative(cellCubic(level, from, ray.direction * length));
    return interval.begin + s * length;
  }

  const std::uint8_t* m_voxels;
  Size3 m_size;   ///< voxels
  Size3 m_count;  ///< cells
  Size3 m_blocks; ///< blocks of cells
  Affine m_worldToCell;
  std::vector<std::uint8_t> m_occupied;
};

} // namespace

FocusDepth traceFocus(const Camera& camera, const Domain& volume, const Mask& focus) {
  FocusDepth result{DepthBuffer(camera, volume.grid()), {}};
  DepthBuffer& depth = result.depth;
  result.regions.assign(static_cast<std::size_t>(depth.size()), Region::outside);
  const DualCells cells(focus);

  const auto traceSample = [&](std::int64_t column, std::int64_t row) {
    const Ray ray = camera.rayThrough(depth.position(column, row));
    const Interval inVolume = volume.clip(transformed(volume.grid().worldToIndex, ray));
    if (inVolume.empty())
      return;
    const std::int64_t sample = depth.sample(column, row);
    const double t = cells.firstMeeting(ray, inVolume);
    if (t < infinity)
      depth.set(sample, t * camera.depthPerLength(ray));
    result.regions[static_cast<std::size_t>(sample)] =
        t < infinity ? Region::focus : Region::context;
  };
  tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, depth.rows()), [&](const auto& rows) {
    for (std::int64_t row = rows.begin(); row < rows.end(); ++row)
      for (std::int64_t column = 0; column < depth.columns(); ++column)
        traceSample(column, row);
  });
  return result;
}

} // namespace fenestra
