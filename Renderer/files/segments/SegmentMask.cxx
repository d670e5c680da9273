#include "files/segments/SegmentMask.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <atomic>
#include <set>
#include <type_traits>
#include <utility>

namespace fenestra {
namespace {

/// Flags of a labelmap's faces (axis; lower, upper) that lie on a face of the volume.
using SharedFaces = std::array<std::array<bool, 2>, 3>;

/// True if all corners of the face are within half a voxel of a face of the volume, with the
/// labelmap on the inner side.
bool isShared(const Grid& labelmap, const Grid& volume, int axis, int side) {
  const Affine toVolume = volume.worldToIndex * labelmap.indexToWorld;
  const Vec3 center = toVolume * labelmap.indexBox().center();
  const Box box = volume.indexBox();
  for (int other = 0; other < 3; ++other)
    for (const double face : {box.lower[other], box.upper[other]}) {
      const bool inside = face == box.lower[other] ? center[other] > face : center[other] < face;
      bool near = inside;
      for (int i = 0; i < 8; ++i) {
        const bool onFace = ((i >> axis) & 1) == side;
        const double x = (toVolume * labelmap.indexBox().corner(i))[other];
        near = near && (!onFace || std::abs(x - face) <= 0.5);
      }
      if (near)
        return true;
    }
  return false;
}

SharedFaces sharedFaces(const Grid& labelmap, const Grid& volume) {
  SharedFaces shared{};
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      shared[static_cast<std::size_t>(axis)][static_cast<std::size_t>(side)] =
          isShared(labelmap, volume, axis, side);
  return shared;
}

/// Set of label values, queried at least once for every voxel.
template <typename Label>
class ChosenValues {
public:
  void insert(std::int32_t value) {
    if (!std::in_range<Label>(value))
      return;
    const auto label = static_cast<Label>(value);
    if constexpr (sizeof(Label) <= 2)
      m_values[static_cast<std::make_unsigned_t<Label>>(label)] = 1;
    else
      m_values.insert(label);
  }

  bool contains(Label label) const {
    if constexpr (sizeof(Label) <= 2)
      return m_values[static_cast<std::make_unsigned_t<Label>>(label)] != 0;
    else
      return label != 0 && m_values.contains(label); // most voxels are background
  }

private:
  struct Table : std::vector<std::uint8_t> {
    Table() : std::vector<std::uint8_t>(std::size_t{1} << (8 * sizeof(Label))) {}
  };
  std::conditional_t<(sizeof(Label) <= 2), Table, std::set<Label>> m_values;
};

/// Focus in one labelmap: its chosen voxels, and their mask.
template <typename Label>
class Focus {
public:
  Focus(const Grid& grid, std::size_t layerCount, const std::vector<Label>& labels,
        const std::vector<SegmentInfo>& chosen)
      : m_grid(grid), m_layerCount(layerCount), m_labels(labels), m_values(layerCount) {
    for (const SegmentInfo& segment : chosen)
      m_values[segment.layer].insert(segment.labelValue);
  }

  void fill(Mask& mask, const SharedFaces& shared) const {
    const VoxelExtent extent = this->extent();
    if (extent.empty())
      return;
    const Size3 origin = extent.lower.array() - 1;
    const Size3 size = extent.upper - extent.lower + Size3::Constant(3);
    Affine indexToWorld = m_grid.indexToWorld;
    indexToWorld.translate(origin.cast<double>());
    mask.grid = Grid(size, indexToWorld);
    mask.voxels.resize(static_cast<std::size_t>(mask.grid.voxelCount()));
    std::atomic<std::int64_t> total = 0;
    tbb::parallel_for(std::int64_t{0}, size.z(), [&](std::int64_t z) {
      std::uint8_t* to = mask.voxels.data() + size.x() * size.y() * z;
      std::int64_t count = 0;
      for (std::int64_t y = 0; y < size.y(); ++y)
        for (std::int64_t x = 0; x < size.x(); ++x)
          *to++ = value(origin + Size3(x, y, z), shared, count);
      total += count;
    });
    mask.count = total;
  }

private:
  bool isChosen(const Size3& voxel) const {
    const auto first =
        static_cast<std::size_t>(voxel.x() +
                                 m_grid.size.x() * (voxel.y() + m_grid.size.y() * voxel.z())) *
        m_layerCount;
    for (std::size_t layer = 0; layer < m_layerCount; ++layer)
      if (m_values[layer].contains(m_labels[first + layer]))
        return true;
    return false;
  }

  VoxelExtent extent() const {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::int64_t>(0, m_grid.size.z()), VoxelExtent(),
        [this](const tbb::blocked_range<std::int64_t>& slices, VoxelExtent extent) {
          for (std::int64_t z = slices.begin(); z < slices.end(); ++z)
            for (std::int64_t y = 0; y < m_grid.size.y(); ++y)
              extent.add(rowExtent(y, z));
          return extent;
        },
        [](VoxelExtent extent, const VoxelExtent& more) {
          extent.add(more);
          return extent;
        });
  }

  VoxelExtent rowExtent(std::int64_t y, std::int64_t z) const {
    std::int64_t first = 0;
    std::int64_t last = m_grid.size.x() - 1;
    while (first <= last && !isChosen({first, y, z}))
      ++first;
    if (first > last)
      return {};
    while (!isChosen({last, y, z}))
      --last;
    return {{first, y, z}, {last, y, z}};
  }

  /// Mask value of a voxel, which may lie one beyond the labelmap; counts chosen voxels of the
  /// labelmap.
  std::uint8_t value(Size3 voxel, const SharedFaces& shared, std::int64_t& count) const {
    bool beyond = false;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t last = m_grid.size[axis] - 1;
      if (voxel[axis] >= 0 && voxel[axis] <= last)
        continue;
      if (!shared[static_cast<std::size_t>(axis)][voxel[axis] < 0 ? 0 : 1])
        return 0;
      voxel[axis] = std::clamp<std::int64_t>(voxel[axis], 0, last);
      beyond = true;
    }
    const bool chosen = isChosen(voxel);
    count += chosen && !beyond;
    return chosen;
  }

  const Grid& m_grid;
  std::size_t m_layerCount;
  const std::vector<Label>& m_labels;
  std::vector<ChosenValues<Label>> m_values; ///< chosen values of each layer
};

} // namespace

void fillMask(const Grid& labelmap, std::size_t layerCount, const Segmentation::Labels& labels,
              const std::vector<SegmentInfo>& chosen, const Grid& volume, Mask& mask) {
  const SharedFaces shared = sharedFaces(labelmap, volume);
  std::visit(
      [&](const auto& values) { Focus(labelmap, layerCount, values, chosen).fill(mask, shared); },
      labels);
}

} // namespace fenestra
