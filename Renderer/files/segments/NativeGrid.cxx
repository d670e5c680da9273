#include "files/segments/NativeGrid.h"

#include "base/Distribution.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <vector>

namespace fenestra::core {
namespace {

/// Per axis and plane: number of labels that differ from those of the next plane.
using ChangeCounts = std::array<std::vector<std::int64_t>, 3>;

template <typename Label>
class ChangeCounter {
public:
  ChangeCounter(const LargeArray<Label>& labels, const Size3& size, std::size_t layerCount)
      : m_labels(labels), m_size(size), m_layerCount(static_cast<std::int64_t>(layerCount)) {}

  ChangeCounts count() const {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::int64_t>(0, m_size.z()), makeZero(),
        [this](const tbb::blocked_range<std::int64_t>& slices, ChangeCounts counts) {
          for (std::int64_t z = slices.begin(); z < slices.end(); ++z)
            for (std::int64_t y = 0; y < m_size.y(); ++y)
              addRow(y, z, counts);
          return counts;
        },
        [](ChangeCounts sum, const ChangeCounts& more) {
          for (std::size_t axis = 0; axis < 3; ++axis)
            std::ranges::transform(sum[axis], more[axis], sum[axis].begin(), std::plus());
          return sum;
        });
  }

private:
  ChangeCounts makeZero() const {
    ChangeCounts counts;
    for (int axis = 0; axis < 3; ++axis)
      counts[static_cast<std::size_t>(axis)].resize(static_cast<std::size_t>(m_size[axis] - 1));
    return counts;
  }

  void addRow(std::int64_t y, std::int64_t z, ChangeCounts& counts) const {
    const std::int64_t count = m_size.x() * m_layerCount, slice = count * m_size.y();
    const Label* const row = m_labels.data() + count * y + slice * z;
    const auto countDifferent = [&](const Label* other) {
      std::int64_t different = 0;
      for (std::int64_t i = 0; i < count; ++i)
        different += row[i] != other[i];
      return different;
    };
    if (y + 1 < m_size.y())
      counts[1][static_cast<std::size_t>(y)] += countDifferent(row + count);
    if (z + 1 < m_size.z())
      counts[2][static_cast<std::size_t>(z)] += countDifferent(row + slice);
    for (std::int64_t layer = 0; layer < m_layerCount; ++layer)
      for (std::size_t x = 0; x < counts[0].size(); ++x) {
        const Label* const voxel = row + static_cast<std::int64_t>(x) * m_layerCount + layer;
        counts[0][x] += voxel[0] != voxel[m_layerCount];
      }
  }

  const LargeArray<Label>& m_labels;
  Size3 m_size;
  std::int64_t m_layerCount;
};

/// Calls `choose(first, last)` for the window of up to 2 * radius + 1 values around each value.
template <typename Choose>
std::vector<std::int64_t> filterWindows(const std::vector<std::int64_t>& values, std::size_t radius,
                                        const Choose& choose) {
  std::vector<std::int64_t> result, window;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t first = i - std::min(i, radius),
                      end = std::min(i + radius + 1, values.size());
    window.assign(values.begin() + static_cast<std::ptrdiff_t>(first),
                  values.begin() + static_cast<std::ptrdiff_t>(end));
    result.push_back(choose(window));
  }
  return result;
}

/// Native edge in voxels, by the changes between planes along one axis. `width`: number of planes
/// of which one should have changes.
double estimateNativeEdge(const std::vector<std::int64_t>& changes, std::size_t width) {
  constexpr std::int64_t fewestChanges = 16; // typical of planes that count
  constexpr std::size_t fewestPlanes = 30;
  constexpr std::int64_t emptyRatio = 8; // a plane with fewer by this factor is empty
  constexpr double fewestEmpty = 0.25;   // fraction; shapes, such as boxes, have empty planes, too
  const std::vector<std::int64_t> greatest = filterWindows(
      changes, width / 2, [](const auto& window) { return std::ranges::max(window); });
  const std::vector<std::int64_t> typical =
      filterWindows(greatest, width - 1, [](auto& window) { return findMedian(window); });
  const auto hasChanges = [](std::int64_t count) { return count > 0; };
  const auto first = std::ranges::find_if(changes, hasChanges) - changes.begin();
  const auto end =
      std::find_if(changes.rbegin(), changes.rend(), hasChanges).base() - changes.begin();
  std::vector<bool> isEmpty; // of the planes that count
  for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(end); ++i)
    if (typical[i] >= fewestChanges)
      isEmpty.push_back(emptyRatio * changes[i] < typical[i]);
  if (isEmpty.size() < fewestPlanes)
    return 1.0;
  const auto findFraction = [&](std::size_t begin, std::size_t last) {
    const auto at = [&](std::size_t i) { return isEmpty.begin() + static_cast<std::ptrdiff_t>(i); };
    return static_cast<double>(std::count(at(begin), at(last), true)) /
           static_cast<double>(last - begin);
  };
  // Of a round shape that is extruded, only planes in the middle are empty.
  const double all = findFraction(0, isEmpty.size());
  double least = all;
  for (std::size_t third = 0; third < 3; ++third)
    least =
        std::min(least, findFraction(third * isEmpty.size() / 3, (third + 1) * isEmpty.size() / 3));
  return all < fewestEmpty || least < 0.5 * all ? 1.0 : 1.0 / (1.0 - all);
}

/// As above. Narrow windows follow the shape better, but do not cover wide voxels.
double estimateNativeEdge(const std::vector<std::int64_t>& changes) {
  const double edge = estimateNativeEdge(changes, 5);
  return edge < 3.5 ? edge : estimateNativeEdge(changes, 9);
}

} // namespace

Vec3 estimateNativeVoxels(const Labels& labels, const Size3& size, std::size_t layerCount) {
  if (size.minCoeff() < 1)
    return Vec3::Ones();
  const ChangeCounts counts = std::visit(
      [&](const auto& array) { return ChangeCounter(array, size, layerCount).count(); }, labels);
  return {estimateNativeEdge(counts[0]), estimateNativeEdge(counts[1]),
          estimateNativeEdge(counts[2])};
}

} // namespace fenestra::core
