#include "model/masks/EqualVolume.h"

#include "model/masks/MaskShaping.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <vector>

namespace fenestra::core {
namespace {

/// A function of voxel values, which keeps 0 and 255.
using VoxelValues = std::array<std::uint8_t, 256>;

/// Lengths inside a surface of lines of one voxel, as a function of the level, the voxel value that
/// defines the surface. Values are linear on a line.
class LevelLengths {
public:
  static constexpr std::int64_t unit = 1 << 24; ///< length of a line
  static constexpr int steps = 4;               ///< per voxel value
  static constexpr int maxValue = 255 * steps;

  /// `a`, `b`: values at the ends, in steps; `weight`: number of lines.
  void add(int a, int b, std::int64_t weight = 1) {
    if (a != b)
      addDensity(std::min(a, b), std::max(a, b), weight);
    else if (a == maxValue)
      m_alwaysInside += weight * unit;
    else if (a > 0)
      addDensity(std::max(a - steps, 0), std::min(a + steps, maxValue), weight);
  }

  void add(const LevelLengths& more) {
    std::ranges::transform(m_changes, more.m_changes, m_changes.begin(), std::plus());
    m_alwaysInside += more.m_alwaysInside;
  }

  /// Level at which the length is `length`: the middle if it is so for a range of levels.
  double findLevel(std::int64_t length) const {
    const Lengths lengths = integrate();
    double highest = 0.0, lowest = maxValue;
    for (std::size_t level = 0; level < maxValue; ++level) {
      const std::int64_t here = lengths[level], next = lengths[level + 1];
      const auto at = static_cast<double>(level);
      const double fraction =
          here == next ? 0.0
                       : static_cast<double>(here - length) / static_cast<double>(here - next);
      if (here >= length)
        highest = here == next ? at + 1.0 : at + std::min(fraction, 1.0);
      if (next <= length && lowest == maxValue)
        lowest = at + std::clamp(fraction, 0.0, 1.0);
    }
    return 0.5 * (lowest + highest) / steps;
  }

  /// Length inside for a level, in lines.
  double findLength(double level) const {
    const Lengths lengths = integrate();
    const auto below = static_cast<std::size_t>(level * steps);
    const double fraction = level * steps - static_cast<double>(below);
    return (static_cast<double>(lengths[below]) * (1.0 - fraction) +
            static_cast<double>(lengths[below + 1]) * fraction) /
           static_cast<double>(unit);
  }

private:
  using Lengths = std::array<std::int64_t, maxValue + 1>; ///< per step

  /// Density of a line over 0 (unused), 1, 2, ... steps, to avoid a division per line.
  static std::vector<std::int64_t> divideUnit() {
    std::vector<std::int64_t> densities(maxValue + 1);
    for (std::int64_t steps = 1; steps <= maxValue; ++steps)
      densities[static_cast<std::size_t>(steps)] = unit / steps;
    return densities;
  }

  /// Distributes lines evenly over levels.
  void addDensity(int begin, int end, std::int64_t weight) {
    static const std::vector<std::int64_t> densities = divideUnit();
    const std::int64_t density = weight * densities[static_cast<std::size_t>(end - begin)];
    m_changes[static_cast<std::size_t>(begin)] += density;
    m_changes[static_cast<std::size_t>(end)] -= density;
  }

  /// Length inside for each level.
  Lengths integrate() const {
    Lengths densities{}, lengths{};
    std::int64_t density = 0;
    for (std::size_t level = 0; level < maxValue; ++level)
      densities[level] = density += m_changes[level];
    lengths[maxValue] = m_alwaysInside;
    for (std::size_t level = maxValue; level-- > 0;)
      lengths[level] = lengths[level + 1] + densities[level];
    return lengths;
  }

  Lengths m_changes{}; ///< of the density of lengths
  std::int64_t m_alwaysInside = 0;
};

/// Values of eight neighboring voxels, x fastest.
using Cell = std::array<int, 8>;

/// Adds four lines that stand for a cell.
void addCell(const Cell& cell, LevelLengths& lengths) {
  const auto [least, greatest] = std::ranges::minmax(cell);
  if (least == greatest) {
    lengths.add(LevelLengths::steps * least, LevelLengths::steps * least, 4);
    return;
  }
  std::array<int, 3> changes{};
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      changes[axis] += (i >> axis & 1) != 0 ? cell[i] : -cell[i];
  const auto along = static_cast<std::size_t>(
      std::ranges::max_element(changes, {}, [](int change) { return std::abs(change); }) -
      changes.begin());
  const std::size_t step = 1 << along, a = 1 << (along + 1) % 3, b = 1 << (along + 2) % 3;
  constexpr double nearer = 0.7886751345948129;               // Gauss, 2 points
  constexpr int bits = 16, one = LevelLengths::steps << bits; // fixed point
  constexpr int nearNear = static_cast<int>(nearer * nearer * one + 0.5),
                nearFar = static_cast<int>(nearer * (1.0 - nearer) * one + 0.5),
                farFar = one - nearNear - 2 * nearFar;
  const auto interpolate = [&](std::size_t corner) {
    return (nearNear * cell[corner] + nearFar * (cell[corner ^ a] + cell[corner ^ b]) +
            farFar * cell[corner ^ a ^ b] + (1 << (bits - 1))) >>
           bits;
  };
  for (const std::size_t corner : {std::size_t{0}, a, b, a + b})
    lengths.add(interpolate(corner), interpolate(corner + step));
}

/// Compares the volume in a smoothed mask's surface with that of the labels from which it was made,
/// both in the cells between eight voxels. The surface is trilinear: by the lengths inside of four
/// lines per cell, along the axis of greatest change, at the points of Gauss's quadrature across
/// it. Lines between voxels would not suffice, since trilinear values are as high as the smoothed
/// function's there, but differ within cells where it is curved: by 0.3 % of an organ's volume.
class VolumeComparison {
public:
  /// `first`: voxel of the labels where `smooth` begins.
  VolumeComparison(const Mask& labels, const Mask& smooth, const Size3& first, const Grid& volume)
      : m_labels(labels),
        m_smooth(smooth),
        m_first(first),
        m_volumeSize(volume.size.cast<double>()),
        m_toVolume(volume.worldToIndex * smooth.grid.indexToWorld) {}

  /// Lengths inside the smoothed mask. `values`: replacements of its voxel values.
  LevelLengths measureLengths(const VoxelValues& values) const {
    return addRows(LevelLengths(), [&](const Rows& rows, const Range& range, LevelLengths& sum) {
      addCells(rows, range, values, sum);
    });
  }

  /// Length inside the original labels, in lines, comparable to LevelLengths::findLength().
  double measureLabels() const {
    struct Eighths {
      std::int64_t count = 0; ///< of labels: two of the eight voxels of a cell make a line
      void add(const Eighths& more) { count += more.count; }
    };
    const Eighths sum =
        addRows(Eighths(), [&](const Rows& rows, const Range& range, Eighths& labels) {
          for (const Row& row : rows)
            labels.count += countLabels(row, range.begin, range.end - 1) +
                            countLabels(row, range.begin + 1, range.end);
        });
    return 0.5 * static_cast<double>(sum.count) / (1.0 + m_labels.volumeChange);
  }

private:
  /// A range of voxels in a row, [begin, end).
  struct Range {
    std::int64_t begin, end;
  };

  struct Row {
    std::int64_t y, z;
  };
  using Rows = std::array<Row, 4>; ///< around a row of cells

  /// Voxels of a row that are in the volume. Others do not count.
  Range findInVolume(const Row& row) const {
    const Vec3 start = m_toVolume * Size3(0, row.y, row.z).cast<double>(),
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

  /// Calls add(rows, range, sum) for the cells between the voxels of a range of four rows.
  template <typename Sum>
  Sum addRows(const Sum& none, const auto& add) const {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::int64_t>(0, m_smooth.grid.size.z() - 1), none,
        [&](const tbb::blocked_range<std::int64_t>& slices, Sum sum) {
          for (std::int64_t z = slices.begin(); z < slices.end(); ++z)
            for (std::int64_t y = 0; y + 1 < m_smooth.grid.size.y(); ++y) {
              const Rows rows = {Row{y, z}, {y + 1, z}, {y, z + 1}, {y + 1, z + 1}};
              Range range{0, m_smooth.grid.size.x()};
              for (const Row& row : rows) {
                const Range inVolume = findInVolume(row);
                range = {std::max(range.begin, inVolume.begin), std::min(range.end, inVolume.end)};
              }
              add(rows, range, sum);
            }
          return sum;
        },
        [](Sum sum, const Sum& more) {
          sum.add(more);
          return sum;
        });
  }

  void addCells(const Rows& rows, const Range& range, const VoxelValues& values,
                LevelLengths& lengths) const {
    std::array<const std::uint8_t*, 4> smooth{};
    for (std::size_t i = 0; i < 4; ++i)
      smooth[i] =
          m_smooth.voxels.data() + linearIndex({0, rows[i].y, rows[i].z}, m_smooth.grid.size);
    constexpr std::int64_t word = sizeof(std::uint64_t);
    std::int64_t x = range.begin;
    // Most cells are outside or inside: those between two words are tested together.
    for (; x + word <= range.end; x += word - 1) {
      std::uint64_t some = 0, all = ~some;
      for (const std::uint8_t* row : smooth) {
        std::uint64_t eight;
        std::memcpy(&eight, row + x, sizeof eight);
        some |= eight;
        all &= eight;
      }
      if (all == ~std::uint64_t{0})
        lengths.add(LevelLengths::maxValue, LevelLengths::maxValue, 4 * (word - 1));
      else if (some != 0)
        addCells(smooth, {x, x + word}, values, lengths);
    }
    addCells(smooth, {x, range.end}, values, lengths);
  }
  static void addCells(const std::array<const std::uint8_t*, 4>& smooth, const Range& range,
                       const VoxelValues& values, LevelLengths& lengths) {
    for (std::int64_t x = range.begin; x + 1 < range.end; ++x) {
      Cell cell{};
      for (std::size_t i = 0; i < 8; ++i)
        cell[i] = values[smooth[i / 2][x + static_cast<std::int64_t>(i % 2)]];
      addCell(cell, lengths);
    }
  }

  /// Number of labels in a range of a row of the smoothed mask. Beyond them, the nearest repeats.
  std::int64_t countLabels(const Row& row, std::int64_t begin, std::int64_t end) const {
    const Size3& size = m_labels.grid.size;
    const Size3 start = m_first + Size3(0, row.y, row.z);
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
  const VolumeComparison comparison(labels, smooth, findOffset(smooth, labels), volume);
  const double before = comparison.measureLabels();
  return before == 0.0
             ? 0.0
             : comparison.measureLengths(multiplyOdds(1.0)).findLength(127.5) / before - 1.0;
}

void equalizeVolume(const Mask& labels, const Grid& volume, Mask& smooth) {
  constexpr double tolerance = 0.001;
  constexpr int mostSteps = 8; // values change not only the level, but also lengths: in thin parts
  const VolumeComparison comparison(labels, smooth, findOffset(smooth, labels), volume);
  const double length = comparison.measureLabels();
  VoxelValues values = multiplyOdds(1.0);
  double factor = 1.0;
  for (int step = 0; step < mostSteps; ++step) {
    const LevelLengths lengths = comparison.measureLengths(values);
    if (std::abs(lengths.findLength(127.5) - length) <= tolerance * length)
      break;
    const double level =
        std::clamp(lengths.findLevel(std::llround(length * LevelLengths::unit)), 1.0, 254.0);
    factor *= (255.0 - level) / level;
    values = multiplyOdds(factor);
  }
  for (std::uint8_t& voxel : smooth.voxels)
    voxel = values[voxel];
}

} // namespace fenestra::core
