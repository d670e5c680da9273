#include "clipping/FocusCells.h"

#include "clipping/CellCubic.h"
#include "volume/GridWalk.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>

namespace fenestra {

namespace {

double meetingInCell(unsigned corners, const Ray& ray, const Size3& cell,
                     const Interval& interval) {
  std::array<double, 8> level;
  for (unsigned i = 0; i < 8; ++i)
    level[i] = (corners >> i & 1U ? 1.0 : 0.0) - 0.5;
  const double length = interval.end - interval.begin;
  const Vec3 from = ray.at(interval.begin) - cell.cast<double>();
  const double s = firstNonNegative(cellCubic(level, from, ray.direction * length));
  return interval.begin + s * length;
}

} // namespace

FocusCells::FocusCells(const Mask& mask)
    : m_voxels(mask.voxels.data()),
      m_size(mask.grid.size),
      m_count(m_size.array() + 1),
      m_blocks((m_count.array() + blockSize - 1) / blockSize),
      m_worldToCell(Eigen::Translation3d(Vec3::Ones()) * mask.grid.worldToIndex) {
  markBlocks();
}

/// Row by row: the voxels of all rows at a row of blocks' corners, or-ed, and then block by block.
void FocusCells::markBlocks() {
  m_occupied.assign(static_cast<std::size_t>(m_blocks.prod()), 0);
  const auto corners = [this](std::int64_t block, int axis) { // first and end
    return std::pair(std::max<std::int64_t>(0, block * blockSize - 1),
                     std::min(m_size[axis], (block + 1) * blockSize));
  };
  tbb::parallel_for(std::int64_t{0}, m_blocks.z(), [&](std::int64_t bz) {
    std::vector<std::uint8_t> any(static_cast<std::size_t>(m_size.x()));
    for (std::int64_t by = 0; by < m_blocks.y(); ++by) {
      std::ranges::fill(any, std::uint8_t{0});
      const auto [firstZ, endZ] = corners(bz, 2);
      const auto [firstY, endY] = corners(by, 1);
      for (std::int64_t z = firstZ; z < endZ; ++z)
        for (std::int64_t y = firstY; y < endY; ++y)
          std::transform(any.begin(), any.end(), row(y, z), any.begin(), std::bit_or<>());
      std::uint8_t* const blocks =
          &m_occupied[static_cast<std::size_t>(m_blocks.x() * (by + m_blocks.y() * bz))];
      for (std::int64_t bx = 0; bx < m_blocks.x(); ++bx) {
        const auto [first, end] = corners(bx, 0);
        blocks[bx] = std::any_of(any.begin() + first, any.begin() + end, std::identity());
      }
    }
  });
}

double FocusCells::firstMeeting(const Ray& world, const Interval& range) const {
  constexpr int mostTogether = 4; // blocks: a ray through the focus ends in one of the first
  const Ray ray = transformed(m_worldToCell, world);
  const Ray blockRay{ray.origin / blockSize, ray.direction / blockSize};
  for (GridWalk block(blockRay, range, m_blocks); !block.done();) {
    if (!isOccupied(block.cell())) {
      block.next();
      continue;
    }
    Interval occupied = block.interval();
    for (int i = 0; i < mostTogether && !block.done() && isOccupied(block.cell()); ++i) {
      occupied.end = block.interval().end;
      block.next();
    }
    const double t = meetingInCells(ray, occupied);
    if (t < infinity)
      return t;
  }
  return infinity;
}

/// The first meeting of a ray in cell space.
double FocusCells::meetingInCells(const Ray& ray, const Interval& range) const {
  for (GridWalk cell(ray, range, m_count); !cell.done(); cell.next()) {
    const unsigned corners = cornerBits(cell.coordinates());
    if (corners == 0)
      continue;
    const double t = meetingInCell(corners, ray, cell.coordinates(), cell.interval());
    if (t < infinity)
      return t;
  }
  return infinity;
}

/// Bit i: the indicator at corner i of a cell (x fastest).
unsigned FocusCells::cornerBits(const Size3& cell) const {
  unsigned bits = 0;
  if (cell.minCoeff() > 0 && (cell.array() < m_size.array()).all()) {
    const std::uint8_t* corner = row(cell.y() - 1, cell.z() - 1) + cell.x() - 1;
    const std::int64_t up = m_size.x(), back = m_size.x() * m_size.y();
    unsigned bit = 0;
    for (const std::uint8_t* edge : {corner, corner + up, corner + back, corner + back + up}) {
      bits |= unsigned{edge[0]} << bit | unsigned{edge[1]} << (bit + 1);
      bit += 2;
    }
    return bits;
  }
  for (int i = 0; i < 8; ++i) { // those outside the mask are 0
    const Size3 voxel = cell + Size3((i & 1) - 1, (i >> 1 & 1) - 1, (i >> 2) - 1);
    if (voxel.minCoeff() >= 0 && (voxel.array() < m_size.array()).all())
      bits |= unsigned{row(voxel.y(), voxel.z())[voxel.x()]} << i;
  }
  return bits;
}

} // namespace fenestra
