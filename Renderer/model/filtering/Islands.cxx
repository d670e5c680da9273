#include "model/filtering/Islands.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fenestra::core {
namespace {

/// Runs of voxels above a level, row after row, and which of them are connected.
class Runs {
public:
  template <typename Voxels>
  Runs(const Size3& size, const Voxels& voxels, double level) : m_size(size) {
    const std::int64_t rows = size.y() * size.z();
    for (std::int64_t row = 0; row < rows; ++row) {
      m_firstOfRow.push_back(m_runs.size());
      addRow(voxels.data(), row * size.x(), level);
    }
    m_firstOfRow.push_back(m_runs.size());
    m_parents.resize(m_runs.size());
    std::iota(m_parents.begin(), m_parents.end(), std::size_t{0});
    for (std::int64_t z = 0; z < size.z(); ++z)
      for (std::int64_t y = 0; y < size.y(); ++y)
        connectRow(y, z);
  }

  /// Groups of less than `most` voxels, but neither the largest nor those with a preserved run;
  /// `voxelVolume` in mm^3.
  Islands findSmall(double most, double voxelVolume, const RunPredicate& isPreserved) {
    std::vector<std::int64_t> sizes(m_runs.size(), 0);
    for (std::size_t i = 0; i < m_runs.size(); ++i)
      sizes[findRoot(i)] += m_runs[i].end - m_runs[i].begin;
    const auto largest = static_cast<std::size_t>(std::ranges::max_element(sizes) - sizes.begin());
    std::vector<bool> isIsland(m_runs.size());
    for (std::size_t root = 0; root < m_runs.size(); ++root)
      isIsland[root] = root != largest && static_cast<double>(sizes[root]) < most;
    for (std::size_t i = 0; isPreserved && i < m_runs.size(); ++i)
      if (const std::size_t root = findRoot(i); isIsland[root] && isPreserved(m_runs[i]))
        isIsland[root] = false;
    Islands islands;
    for (std::size_t i = 0; i < m_runs.size(); ++i) {
      const std::size_t root = findRoot(i);
      if (!isIsland[root])
        continue;
      islands.runs.push_back(m_runs[i]);
      islands.volume += static_cast<double>(m_runs[i].end - m_runs[i].begin) * voxelVolume;
      islands.count += root == i;
    }
    return islands;
  }

private:
  template <typename Voxel>
  void addRow(const Voxel* voxels, std::int64_t first, double level) {
    const auto isAbove = [&](std::int64_t i) { return static_cast<double>(voxels[i]) > level; };
    const std::int64_t end = first + m_size.x();
    for (std::int64_t i = first; i < end; ++i) {
      if (!isAbove(i))
        continue;
      const std::int64_t begin = i;
      while (i < end && isAbove(i))
        ++i;
      m_runs.push_back({begin, i});
    }
  }

  /// Connects a row with the neighbors that precede it.
  void connectRow(std::int64_t y, std::int64_t z) {
    const std::int64_t row = y + m_size.y() * z;
    if (y > 0)
      connectRows(row, row - 1);
    if (z > 0)
      for (std::int64_t other = std::max<std::int64_t>(y - 1, 0);
           other <= std::min(y + 1, m_size.y() - 1); ++other)
        connectRows(row, other + m_size.y() * (z - 1));
  }

  void connectRows(std::int64_t row, std::int64_t other) {
    const auto first = [this](std::int64_t r) { return m_firstOfRow[static_cast<std::size_t>(r)]; };
    const std::int64_t shift = (row - other) * m_size.x();
    std::size_t a = first(row), b = first(other);
    while (a < first(row + 1) && b < first(other + 1)) {
      const RunOfIsland &here = m_runs[a], &there = m_runs[b];
      if (here.begin <= there.end + shift && there.begin + shift <= here.end) // also by a corner
        connect(a, b);
      ++(here.end < there.end + shift ? a : b);
    }
  }

  std::size_t findRoot(std::size_t i) {
    while (m_parents[i] != i)
      i = m_parents[i] = m_parents[m_parents[i]];
    return i;
  }

  void connect(std::size_t a, std::size_t b) {
    const std::size_t rootOfA = findRoot(a), rootOfB = findRoot(b);
    m_parents[std::max(rootOfA, rootOfB)] = std::min(rootOfA, rootOfB);
  }

  Size3 m_size;
  std::vector<RunOfIsland> m_runs;
  std::vector<std::size_t> m_firstOfRow, m_parents;
};

} // namespace

Islands findIslands(const Volume& volume, double onset, double largest,
                    const RunPredicate& isPreserved) {
  const double voxelVolume = std::abs(volume.grid.indexToWorld.linear().determinant());
  return std::visit(
      [&](const auto& voxels) {
        return Runs(volume.grid.size, voxels, onset)
            .findSmall(largest / voxelVolume, voxelVolume, isPreserved);
      },
      volume.voxels);
}

void removeIslands(Volume& volume, const Islands& islands, double onset) {
  const auto lower = [&](auto& voxels) {
    using Voxel = typename std::remove_cvref_t<decltype(voxels)>::value_type;
    const double value = std::is_integral_v<Voxel> ? std::floor(onset) : onset;
    const auto level = static_cast<Voxel>(std::max(value, volume.minimum));
    for (const RunOfIsland& run : islands.runs)
      std::fill(voxels.begin() + run.begin, voxels.begin() + run.end, level);
  };
  std::visit(lower, volume.voxels);
  computeRange(volume);
}

} // namespace fenestra::core
