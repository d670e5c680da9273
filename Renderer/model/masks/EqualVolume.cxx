#include "model/masks/EqualVolume.h"

#include "model/masks/MaskShaping.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

namespace fenestra {
namespace {

/// A function of voxel values.
using VoxelValues = std::array<std::uint8_t, 256>;

/// Lengths inside a surface of lines between neighboring voxels, as a function of the voxel value
/// that defines the surface. Values are linear on a line.
class LevelLengths {
public:
  static constexpr std::int64_t unit = 1 << 24; ///< length of a line

  void add(std::uint8_t a, std::uint8_t b) {
    if (a == b) {
      if (a == 255)
        m_alwaysInside += unit;
      else if (a > 0)
        addDensity(a - 1, a + 1, unit / 2);
    } else {
      const int low = std::min(a, b), high = std::max(a, b);
      addDensity(low, high, unit / (high - low));
    }
  }

  void add(const LevelLengths& more) {
    std::ranges::transform(m_steps, more.m_steps, m_steps.begin(), std::plus());
    m_alwaysInside += more.m_alwaysInside;
  }

  /// Level at which the length is `length`: the middle if it is so for a range of levels.
  double findLevel(std::int64_t length) const {
    const std::array<std::int64_t, 256> lengths = integrate();
    double highest = 0.0, lowest = 255.0;
    for (std::size_t level = 0; level < 255; ++level) {
      const std::int64_t here = lengths[level], next = lengths[level + 1];
      const auto at = static_cast<double>(level);
      const double fraction =
          here == next ? 0.0
                       : static_cast<double>(here - length) / static_cast<double>(here - next);
      if (here >= length)
        highest = here == next ? at + 1.0 : at + std::min(fraction, 1.0);
      if (next <= length && lowest == 255.0)
        lowest = at + std::clamp(fraction, 0.0, 1.0);
    }
    return 0.5 * (lowest + highest);
  }

  /// Length inside for a level, in lines.
  double findLength(double level) const {
    const std::array<std::int64_t, 256> lengths = integrate();
    const auto below = static_cast<std::size_t>(level);
    const double fraction = level - static_cast<double>(below);
    return (static_cast<double>(lengths[below]) * (1.0 - fraction) +
            static_cast<double>(lengths[below + 1]) * fraction) /
           static_cast<double>(unit);
  }

private:
  void addDensity(int begin, int end, std::int64_t density) {
    m_steps[static_cast<std::size_t>(begin)] += density;
    m_steps[static_cast<std::size_t>(end)] -= density;
  }

  /// Length inside for each integral level.
  std::array<std::int64_t, 256> integrate() const {
    std::array<std::int64_t, 256> densities{}, lengths{};
    std::int64_t density = 0;
    for (std::size_t level = 0; level < 256; ++level)
      densities[level] = density += m_steps[level];
    lengths[255] = m_alwaysInside;
    for (std::size_t level = 255; level-- > 0;)
      lengths[level] = lengths[level + 1] + densities[level];
    return lengths;
  }

  std::array<std::int64_t, 257> m_steps{}; ///< of the length per level
  std::int64_t m_alwaysInside = 0;
};

/// Compares a smoothed mask with the labels from which it was made, by the lengths inside of the
/// lines between neighboring voxels along all axes.
class VolumeComparison {
public:
  /// `first`: voxel of the labels where `smooth` begins.
  VolumeComparison(const Mask& labels, const Mask& smooth, const Size3& first, const Grid& volume)
      : m_labels(labels),
        m_smooth(smooth),
        m_first(first),
        m_volumeSize(volume.size.cast<double>()),
        m_toVolume(volume.worldToIndex * smooth.grid.indexToWorld) {}

  struct Result {
    LevelLengths smooth;
    std::int64_t labels = 0; ///< in half lines
  };

  /// `values`: replacements of the smoothed mask's voxel values.
  Result measure(const VoxelValues& values) const {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::int64_t>(0, m_smooth.grid.size.z()), Result(),
        [&](const tbb::blocked_range<std::int64_t>& slices, Result result) {
          for (std::int64_t z = slices.begin(); z < slices.end(); ++z)
            for (std::int64_t y = 0; y < m_smooth.grid.size.y(); ++y)
              addRow(y, z, values, result);
          return result;
        },
        [](Result sum, const Result& more) {
          sum.smooth.add(more.smooth);
          sum.labels += more.labels;
          return sum;
        });
  }

private:
  /// A range of voxels in a row, [begin, end).
  struct Range {
    std::int64_t begin, end;
  };

  /// Voxels of a row that are in the volume. Others do not count.
  Range findInVolume(std::int64_t y, std::int64_t z) const {
    const Vec3 start = m_toVolume * Size3(0, y, z).cast<double>(),
               step = m_toVolume.linear().col(0);
    double lower = 0.0, upper = static_cast<double>(m_smooth.grid.size.x() - 1);
    for (int axis = 0; axis < 3; ++axis) {
      const double enter = -0.5 - start[axis], leave = m_volumeSize[axis] - 0.5 - start[axis];
      if (std::abs(step[axis]) < 1e-9) {
        if (enter > 0.0 || leave < 0.0)
          return {0, 0};
        continue;
      }
      lower = std::max(lower, std::min(enter / step[axis], leave / step[axis]));
      upper = std::min(upper, std::max(enter / step[axis], leave / step[axis]));
    }
    return {static_cast<std::int64_t>(std::ceil(lower)),
            static_cast<std::int64_t>(std::floor(upper)) + 1};
  }

  void addRow(std::int64_t y, std::int64_t z, const VoxelValues& values, Result& result) const {
    const Range range = findInVolume(y, z);
    addLines({y, z}, {y, z}, {range.begin, range.end - 1}, 1, values, result);
    for (const auto& [otherY, otherZ] : {std::pair(y + 1, z), std::pair(y, z + 1)})
      if (otherY < m_smooth.grid.size.y() && otherZ < m_smooth.grid.size.z()) {
        const Range other = findInVolume(otherY, otherZ);
        addLines({y, z}, {otherY, otherZ},
                 {std::max(range.begin, other.begin), std::min(range.end, other.end)}, 0, values,
                 result);
      }
  }

  /// Adds the lines from voxels `range` of a row to the voxels of another, `shift` further.
  void addLines(const std::pair<std::int64_t, std::int64_t>& row,
                const std::pair<std::int64_t, std::int64_t>& other, const Range& range,
                std::int64_t shift, const VoxelValues& values, Result& result) const {
    const auto findSmooth = [&](const auto& at) {
      return m_smooth.voxels.data() + linearIndex({0, at.first, at.second}, m_smooth.grid.size);
    };
    const std::uint8_t *const a = findSmooth(row), *const b = findSmooth(other) + shift;
    for (std::int64_t x = range.begin; x < range.end; ++x)
      if (a[x] != 0 || b[x] != 0)
        result.smooth.add(values[a[x]], values[b[x]]);
    result.labels += countLabels(row, range.begin, range.end) +
                     countLabels(other, range.begin + shift, range.end + shift);
  }

  /// Number of labels in a range of a row of the smoothed mask. Beyond them, the nearest repeats.
  std::int64_t countLabels(const std::pair<std::int64_t, std::int64_t>& row, std::int64_t begin,
                           std::int64_t end) const {
    const Size3& size = m_labels.grid.size;
    const Size3 start = m_first + Size3(0, row.first, row.second);
    const Size3 nearest = start.cwiseMax(0).cwiseMin((size.array() - 1).matrix());
    const std::uint8_t* const labels =
        m_labels.voxels.data() + linearIndex({0, nearest.y(), nearest.z()}, size);
    const std::int64_t first = m_first.x() + begin, last = m_first.x() + std::max(begin, end);
    const auto repeat = [&](std::int64_t x, std::int64_t times) {
      return labels[x] == m_labels.maxValue ? std::max<std::int64_t>(times, 0) : 0;
    };
    return std::count(labels + std::clamp<std::int64_t>(first, 0, size.x()),
                      labels + std::clamp<std::int64_t>(last, 0, size.x()), m_labels.maxValue) +
           repeat(0, std::min<std::int64_t>(last, 0) - first) +
           repeat(size.x() - 1, last - std::max(first, size.x()));
  }

  const Mask &m_labels, &m_smooth;
  Size3 m_first;
  Vec3 m_volumeSize;
  Affine m_toVolume;
};

/// Values whose odds inside : outside are multiplied. The function is smooth: a kink would move the
/// surface between voxels.
VoxelValues multiplyOdds(double factor) {
  VoxelValues values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double inside = factor * static_cast<double>(i), outside = 255.0 - static_cast<double>(i);
    values[i] = static_cast<std::uint8_t>(255.0 * inside / (inside + outside) + 0.5);
  }
  return values;
}

} // namespace

double measureVolumeChange(const Mask& labels, const Mask& smooth, const Grid& volume) {
  if (smooth.smoothing == 0.0)
    return labels.volumeChange;
  const auto [lengths, inLabels] =
      VolumeComparison(labels, smooth, findOffset(smooth, labels), volume)
          .measure(multiplyOdds(1.0));
  const double before = 0.5 * static_cast<double>(inLabels) / (1.0 + labels.volumeChange);
  return before == 0.0 ? 0.0 : lengths.findLength(127.5) / before - 1.0;
}

void equalizeVolume(const Mask& labels, const Grid& volume, Mask& smooth) {
  const VolumeComparison comparison(labels, smooth, findOffset(smooth, labels), volume);
  VoxelValues values = multiplyOdds(1.0);
  double factor = 1.0;
  for (int i = 0; i < 3; ++i) { // values change not only the level, but also lengths, slightly
    const auto [lengths, inLabels] = comparison.measure(values);
    const double length = 0.5 * static_cast<double>(inLabels) / (1.0 + labels.volumeChange);
    const double level =
        std::clamp(lengths.findLevel(std::llround(length * LevelLengths::unit)), 1.0, 254.0);
    factor *= (255.0 - level) / level;
    values = multiplyOdds(factor);
    if (std::abs(level - 127.5) < 0.25)
      break;
  }
  for (std::uint8_t& voxel : smooth.voxels)
    voxel = values[voxel];
}

} // namespace fenestra
