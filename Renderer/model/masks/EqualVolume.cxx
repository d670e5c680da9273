#include "model/masks/EqualVolume.h"

#include "model/masks/CellLines.h"
#include "model/masks/MaskShaping.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fenestra::core {
namespace {

/// Compares the volume in a smoothed mask's surface with that of the labels from which it was made,
/// both in the cells between eight voxels. The surface is trilinear: by the lengths inside of four
/// lines per cell (CellLines.h). Lines between voxels would not suffice, since trilinear values are
/// as high as the smoothed function's there, but differ within cells where it is curved: by 0.3 %
/// of an organ's volume.
class VolumeComparison {
public:
  /// `first`: voxel of the labels where `smooth` begins.
  VolumeComparison(const Mask& labels, const Mask& smooth, const Size3& first, const Grid& volume)
      : m_labels(labels),
        m_smooth(smooth),
        m_first(first),
        m_volumeSize(volume.size.cast<double>()),
        m_toVolume(volume.worldToIndex * smooth.grid.indexToWorld) {}

  /// Lengths inside the smoothed mask at some levels. `values`: replacements of its voxel values.
  LevelLengths measureLengths(const VoxelValues& values, const LevelLengths::Levels& levels) const {
    return addRows(
        LevelLengths(levels), [&](const Rows& rows, const Range& range, LevelLengths& sum) {
          std::array<const std::uint8_t*, 4> voxels{};
          for (std::size_t i = 0; i < 4; ++i)
            voxels[i] = m_smooth.voxels.data() +
                        linearIndex({range.begin, rows[i].y, rows[i].z}, m_smooth.grid.size);
          addCellLines(voxels, range.end - range.begin, values, sum);
        });
  }

  /// Length inside the original labels, in lines, comparable to LevelLengths::findLength().
  double measureLabels() const {
    const Eighths sum =
        addRows(Eighths(), [&](const Rows& rows, const Range& range, Eighths& labels) {
          for (const std::size_t i : {std::size_t{0}, std::size_t{2}}) {
            LabelCount& known = labels.known[i / 2];
            if (known.row != rows[i] || known.range != range)
              known = countLabels(rows[i], range);
            labels.count += known.count;
            known = countLabels(rows[i + 1], range);
            labels.count += known.count;
          }
        });
    return 0.5 * static_cast<double>(sum.count) / (1.0 + m_labels.volumeChange);
  }

private:
  /// A range of voxels in a row, [begin, end).
  struct Range {
    std::int64_t begin, end;

    bool operator==(const Range&) const = default;
  };

  struct Row {
    std::int64_t y, z;

    bool operator==(const Row&) const = default;
  };
  using Rows = std::array<Row, 4>; ///< around a row of cells

  /// Number of labels at the ends of the lines between the voxels of a row.
  struct LabelCount {
    Row row{-1, -1};
    Range range{0, 0};
    std::int64_t count = 0;
  };

  /// Number of labels at the corners of cells: two of the eight corners make a line.
  struct Eighths {
    std::int64_t count = 0;
    std::array<LabelCount, 2> known; ///< of the two rows that the next row of cells shares

    void add(const Eighths& more) { count += more.count; }
  };

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

  LabelCount countLabels(const Row& row, const Range& range) const {
    return {row, range,
            countLabels(row, range.begin, range.end - 1) +
                countLabels(row, range.begin + 1, range.end)};
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

/// Levels around the surface of a smoothed mask.
constexpr LevelLengths::Levels nearLevels{64 * LevelLengths::steps, 192 * LevelLengths::steps};

} // namespace

double measureVolumeChange(const Mask& labels, const Mask& smooth, const Grid& volume) {
  if (smooth.smoothing == 0.0)
    return labels.volumeChange;
  const VolumeComparison comparison(labels, smooth, findOffset(smooth, labels), volume);
  const double before = comparison.measureLabels();
  return before == 0.0
             ? 0.0
             : comparison.measureLengths(multiplyOdds(1.0), nearLevels).findLength(127.5) / before -
                   1.0;
}

void equalizeVolume(const Mask& labels, const Grid& volume, Mask& smooth) {
  constexpr double tolerance = 0.001;
  constexpr int mostSteps = 8; // values change not only the level, but also lengths: in thin parts
  const VolumeComparison comparison(labels, smooth, findOffset(smooth, labels), volume);
  const double length = comparison.measureLabels();
  VoxelValues values = multiplyOdds(1.0);
  double factor = 1.0;
  for (int step = 0; step < mostSteps; ++step) {
    LevelLengths lengths = comparison.measureLengths(values, nearLevels);
    if (std::abs(lengths.findLength(127.5) - length) <= tolerance * length)
      break;
    const std::int64_t wanted = std::llround(length * LevelLengths::unit);
    if (!lengths.hasLevel(wanted))
      lengths = comparison.measureLengths(values, LevelLengths::allLevels);
    const double level = std::clamp(lengths.findLevel(wanted), 1.0, 254.0);
    factor *= (255.0 - level) / level;
    values = multiplyOdds(factor);
  }
  for (std::uint8_t& voxel : smooth.voxels)
    voxel = values[voxel];
}

} // namespace fenestra::core
