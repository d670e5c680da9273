// Masks and statistics of segments.

#include "base/Error.h"
#include "files/segments/SegmentationReader.h"
#include "model/masks/EqualVolume.h"
#include "model/masks/MaskShaping.h"
#include "model/masks/OuterLayer.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <set>
#include <utility>

namespace fenestra::core {
namespace {

/// Inclusive range of voxels; empty until one is added.
struct VoxelExtent {
  Size3 lower = Size3::Constant(std::numeric_limits<std::int64_t>::max());
  Size3 upper = Size3::Constant(-1);

  bool isEmpty() const { return upper.x() < 0; }
  void add(const VoxelExtent& more) {
    lower = lower.cwiseMin(more.lower);
    upper = upper.cwiseMax(more.upper);
  }
};

// ---- mask

/// True if all corners of the face lie within half a voxel of a face of the volume, with the
/// labelmap on its inner side.
bool isOnVolumeFace(const Grid& labelmap, const Grid& volume, int axis, int side) {
  const Affine toVolume = volume.worldToIndex * labelmap.indexToWorld;
  const Box labels = labelmap.indexBox(), box = volume.indexBox();
  const Vec3 center = toVolume * labels.center();
  for (int other = 0; other < 3; ++other)
    for (const double face : {box.lower[other], box.upper[other]}) {
      bool near = face == box.lower[other] ? center[other] > face : center[other] < face;
      for (int i = 0; i < 8; ++i)
        if (((i >> axis) & 1) == side)
          near = near && std::abs((toVolume * labels.corner(i))[other] - face) <= 0.5;
      if (near)
        return true;
    }
  return false;
}

/// Voxel extent of the labelmap, plus one voxel beyond each face that lies on a face of the volume.
VoxelExtent extendToVolume(const Grid& labelmap, const Grid& volume) {
  VoxelExtent extent{Size3::Zero(), labelmap.size.array() - 1};
  for (int axis = 0; axis < 3; ++axis) {
    extent.lower[axis] -= isOnVolumeFace(labelmap, volume, axis, 0);
    extent.upper[axis] += isOnVolumeFace(labelmap, volume, axis, 1);
  }
  return extent;
}

/// Set of label values, optimized for a query per voxel: a bit table before the set.
template <typename Label>
class LabelValueSet {
public:
  void insert(std::int32_t value) {
    if (!std::in_range<Label>(value))
      return;
    m_values.insert(static_cast<Label>(value));
    m_lowBits[static_cast<std::uint16_t>(value)] = true;
  }

  bool contains(Label label) const {
    return m_lowBits[static_cast<std::uint16_t>(label)] &&
           (sizeof(Label) <= 2 || m_values.contains(label));
  }

private:
  std::vector<std::uint8_t> m_lowBits = std::vector<std::uint8_t>(1 << 16); ///< by low 16 bits
  std::set<Label> m_values;
};

/// Selected voxels of one labelmap.
template <typename Label>
class SelectedVoxels {
public:
  /// `labels`: of `map`. The segments must be in the map's layers.
  SelectedVoxels(const LabelMap& map, const LargeArray<Label>& labels,
                 const std::vector<SegmentInfo>& chosen)
      : m_grid(map.grid), m_layerCount(map.layerCount), m_labels(labels), m_values(map.layerCount) {
    for (const SegmentInfo& segment : chosen)
      m_values[segment.layer - map.firstLayer].insert(segment.labelValue);
  }

  /// Sets the mask's grid, voxels and count, cropped to the selected voxels; leaves it unchanged if
  /// there are none. Voxels of `extended` beyond the labelmap repeat its outermost ones, uncounted.
  void fill(Mask& mask, const VoxelExtent& extended) const {
    const VoxelExtent extent = computeExtent();
    if (extent.isEmpty())
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
      for (std::int64_t y = 0; y < size.y(); ++y, to += size.x())
        count += fillRow(origin + Size3(0, y, z), size.x(), extended, to);
      total += count;
    });
    mask.count = total;
  }

private:
  /// Writes `count` voxels from `first` on, into zeroed memory. Returns the number of selected
  /// voxels inside the labelmap.
  std::int64_t fillRow(const Size3& first, std::int64_t count, const VoxelExtent& extended,
                       std::uint8_t* to) const {
    const Size3 last = m_grid.size.array() - 1, nearest = first.cwiseMax(0).cwiseMin(last);
    const auto isExtended = [&](int axis, std::int64_t at) {
      return at >= extended.lower[axis] && at <= extended.upper[axis];
    };
    if (!isExtended(1, first.y()) || !isExtended(2, first.z()))
      return 0;
    const bool isInLabelmap = nearest.y() == first.y() && nearest.z() == first.z();
    const Label* const row = labelRow(nearest.y(), nearest.z());
    std::int64_t chosen = 0;
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t x = first.x() + i, inside = std::clamp<std::int64_t>(x, 0, last.x());
      to[i] = isExtended(0, x) && isSelected(row, inside);
      chosen += to[i] && isInLabelmap && x == inside;
    }
    return chosen;
  }

  /// Labels of a row of voxels; the layers of a voxel are adjacent.
  const Label* labelRow(std::int64_t y, std::int64_t z) const {
    return m_labels.data() + linearIndex({0, y, z}, m_grid.size) * m_layerCount;
  }

  bool isSelected(const Label* row, std::int64_t x) const {
    const Label* const voxel = row + static_cast<std::size_t>(x) * m_layerCount;
    for (std::size_t layer = 0; layer < m_layerCount; ++layer)
      if (m_values[layer].contains(voxel[layer]))
        return true;
    return false;
  }

  VoxelExtent computeExtent() const {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::int64_t>(0, m_grid.size.z()), VoxelExtent(),
        [this](const tbb::blocked_range<std::int64_t>& slices, VoxelExtent extent) {
          for (std::int64_t z = slices.begin(); z < slices.end(); ++z)
            for (std::int64_t y = 0; y < m_grid.size.y(); ++y)
              extent.add(computeRowExtent(y, z));
          return extent;
        },
        [](VoxelExtent extent, const VoxelExtent& more) {
          extent.add(more);
          return extent;
        });
  }

  VoxelExtent computeRowExtent(std::int64_t y, std::int64_t z) const {
    const Label* const row = labelRow(y, z);
    std::int64_t first = 0;
    std::int64_t last = m_grid.size.x() - 1;
    while (first <= last && !isSelected(row, first))
      ++first;
    if (first > last)
      return {};
    while (!isSelected(row, last))
      --last;
    return {{first, y, z}, {last, y, z}};
  }

  const Grid& m_grid;
  std::size_t m_layerCount;
  const LargeArray<Label>& m_labels;
  std::vector<LabelValueSet<Label>> m_values; ///< selected values of each layer
};

// ---- statistics

struct ValueStatistics {
  std::int64_t voxels = 0;
  VoxelExtent extent = {};
};

using StatisticsByValue = std::map<std::int32_t, ValueStatistics>;

/// Counts the voxels of one layer, for the label values that are keys of `values`.
template <typename Label>
void countVoxels(const LargeArray<Label>& labels, const Size3& size, std::size_t layer,
                 std::size_t layerCount, StatisticsByValue& values) {
  std::size_t at = layer;
  std::int32_t last = 0; // equal labels come in runs: look up once per run
  ValueStatistics* counted = nullptr;
  for (std::int64_t z = 0; z < size.z(); ++z)
    for (std::int64_t y = 0; y < size.y(); ++y)
      for (std::int64_t x = 0; x < size.x(); ++x, at += layerCount) {
        const std::int32_t label = labels[at];
        if (label != std::exchange(last, label)) {
          const auto found = values.find(label);
          counted = found == values.end() ? nullptr : &found->second;
        }
        if (counted) {
          ++counted->voxels;
          counted->extent.add({{x, y, z}, {x, y, z}});
        }
      }
}

/// Axis-aligned world bounds of voxels, including their full extent.
Box computeWorldBounds(const Grid& grid, const VoxelExtent& extent) {
  const Box voxels{extent.lower.cast<double>().array() - 0.5,
                   extent.upper.cast<double>().array() + 0.5};
  Box bounds = Box::makeEmpty();
  for (int i = 0; i < 8; ++i)
    bounds.extend(grid.indexToWorld * voxels.corner(i));
  return bounds;
}

// ---- shape

/// Number of the mask's voxels that lie in one of the label maps, not beyond a face of the volume.
std::int64_t countLabeled(const Mask& mask, const std::vector<Grid>& labelMaps) {
  std::vector<std::pair<Size3, Size3>> boxes; // first voxel and end, in the mask
  for (const Grid& grid : labelMaps)
    if (isSameLattice(grid, mask.grid)) {
      const Vec3 first = mask.grid.worldToIndex * grid.indexToWorld.translation();
      const Size3 lower = first.array().round().cast<std::int64_t>();
      boxes.emplace_back(lower, lower + grid.size);
    }
  std::int64_t count = 0;
  const Size3& size = mask.grid.size;
  for (std::int64_t z = 0; z < size.z(); ++z)
    for (std::int64_t y = 0; y < size.y(); ++y)
      for (std::int64_t x = 0; x < size.x(); ++x)
        if (const Size3 voxel(x, y, z); mask.contains(voxel))
          count += std::ranges::any_of(boxes, [&](const auto& box) {
            return (voxel.array() >= box.first.array()).all() &&
                   (voxel.array() < box.second.array()).all();
          });
  return count;
}

/// Binary masks on the same lattice: resamples masks of several lattices on the finest one, unless
/// it has more than eight voxels per voxel of the volume.
std::vector<Mask> alignMasks(std::vector<Mask> masks, const Grid& volume) {
  const auto findCell = [](const Grid& grid) {
    return std::abs(grid.indexToWorld.linear().determinant());
  };
  const auto finest =
      std::ranges::min_element(masks, {}, [&](const Mask& mask) { return findCell(mask.grid); });
  const Grid lattice = 8.0 * findCell(finest->grid) < findCell(volume) ? volume : finest->grid;
  for (Mask& mask : masks)
    if (!isSameLattice(mask.grid, lattice)) {
      std::vector<std::string> names = std::move(mask.names);
      mask = resampleMask(mask, lattice, volume);
      mask.names = std::move(names);
    }
  return masks;
}

/// Width of the labels' stairs, mm: the longer native edge of the two finer axes. Slices across the
/// third axis are interpolated.
double findStairWidth(const Vec3& nativeSpacing) {
  std::array edges = {nativeSpacing.x(), nativeSpacing.y(), nativeSpacing.z()};
  std::ranges::sort(edges);
  return edges[1];
}

} // namespace

void Segmentation::add(Segmentation more) {
  const std::size_t layers = m_maps.back().firstLayer + m_maps.back().layerCount;
  for (LabelMap& map : more.m_maps) {
    map.firstLayer += layers;
    for (LabelMap& other : m_maps)
      if (isSameLattice(map.grid, other.grid))
        map.nativeVoxels = other.nativeVoxels = map.nativeVoxels.cwiseMax(other.nativeVoxels);
    m_maps.push_back(std::move(map));
  }
  for (SegmentInfo& segment : more.m_segments) {
    segment.layer += layers;
    m_segments.push_back(std::move(segment));
  }
  addWarnings(more.m_warnings);
}

std::size_t Segmentation::findMap(std::size_t layer) const {
  const auto found = std::ranges::find_if(
      m_maps, [&](const LabelMap& map) { return layer < map.firstLayer + map.layerCount; });
  return static_cast<std::size_t>(found - m_maps.begin());
}

std::vector<SegmentStatistics> Segmentation::statistics() const {
  std::map<std::size_t, StatisticsByValue> layers;
  for (const SegmentInfo& segment : m_segments)
    layers[segment.layer][segment.labelValue] = {};
  for (auto& [layer, values] : layers) {
    const LabelMap& map = m_maps[findMap(layer)];
    std::visit(
        [&, layer = layer - map.firstLayer, &values = values](const auto& labels) {
          countVoxels(labels, map.grid.size, layer, map.layerCount, values);
        },
        map.labels);
  }
  std::vector<SegmentStatistics> statistics;
  for (const SegmentInfo& segment : m_segments) {
    const ValueStatistics& value = layers.at(segment.layer).at(segment.labelValue);
    statistics.push_back({value.voxels, {}});
    if (value.voxels > 0)
      statistics.back().bounds =
          computeWorldBounds(m_maps[findMap(segment.layer)].grid, value.extent);
  }
  return statistics;
}

void Segmentation::restrictSegment(const SegmentInfo& segment, const Mask& mask) {
  LabelMap& map = m_maps[findMap(segment.layer)];
  const Vec3 place = map.grid.worldToIndex * mask.grid.indexToWorld.translation();
  const Size3 origin = place.array().round().cast<std::int64_t>();
  const auto restrict = [&](auto& labels) {
    tbb::parallel_for(std::int64_t{0}, map.grid.size.z(), [&](std::int64_t z) {
      for (std::int64_t y = 0; y < map.grid.size.y(); ++y)
        for (std::int64_t x = 0; x < map.grid.size.x(); ++x) {
          const std::size_t voxel = linearIndex({x, y, z}, map.grid.size);
          auto& label = labels[voxel * map.layerCount + segment.layer - map.firstLayer];
          if (label == segment.labelValue && !mask.contains(Size3(x, y, z) - origin))
            label = 0;
        }
    });
  };
  std::visit(restrict, map.labels);
}

Mask Segmentation::makeFocusMask(const std::vector<std::string>& selectors, const Grid& volume,
                                 const MaskShaping& shaping) const {
  if (shaping.margins.size() > 1 && shaping.margins.size() != selectors.size())
    throw requestError(ErrorCode::marginCount, "margin", "has ", shaping.margins.size(),
                       " values; give one for all segments of the focus, or one per segment");
  std::vector<SegmentInfo> chosen;
  for (const std::string& selector : selectors)
    chosen.push_back(m_segments[find(selector)]);
  const Mask labels = makeLabels(chosen, volume, shaping);
  Mask mask = smoothLabels(labels, chosen, volume, shaping);
  if (mask.count == 0)
    throw inputError(ErrorCode::emptyShapedFocus, m_source,
                     "margin and smoothing leave nothing of the focus (", formatSegments(chosen),
                     ")");
  mask.volumeChange = measureVolumeChange(labels, mask, volume);
  return mask;
}

Mask Segmentation::fillMask(const std::vector<SegmentInfo>& chosen, const Grid& volume,
                            bool isShaped) const {
  std::map<std::size_t, std::vector<SegmentInfo>> byMap;
  for (const SegmentInfo& segment : chosen)
    byMap[findMap(segment.layer)].push_back(segment);
  std::vector<std::vector<Mask>> byLattice;
  std::vector<Grid> grids; // of the label maps
  for (const auto& part : byMap) {
    const LabelMap& map = m_maps[part.first];
    const std::vector<SegmentInfo>& segments = part.second;
    Mask mask;
    std::visit(
        [&](const auto& labels) {
          SelectedVoxels(map, labels, segments).fill(mask, extendToVolume(map.grid, volume));
        },
        map.labels);
    if (mask.count == 0)
      continue;
    grids.push_back(map.grid);
    const auto same = std::ranges::find_if(byLattice, [&](const std::vector<Mask>& masks) {
      return isSameLattice(masks.front().grid, mask.grid);
    });
    (same == byLattice.end() ? byLattice.emplace_back() : *same).push_back(std::move(mask));
  }
  if (byLattice.empty())
    throw inputError(ErrorCode::emptyFocus, m_source, "the focus has no voxel (",
                     formatSegments(chosen), "); choose segments that are not empty");
  std::vector<Mask> masks;
  for (std::vector<Mask>& same : byLattice) {
    const bool isUnion = same.size() > 1;
    Mask mask = uniteMasks(std::move(same));
    if (isUnion)
      mask.count = countLabeled(mask, grids);
    masks.push_back(isShaped ? interpolateSlices(std::move(mask)) : std::move(mask));
  }
  Mask all = uniteMasks(alignMasks(std::move(masks), volume));
  all.names.clear();
  for (const SegmentInfo& segment : chosen)
    all.names.push_back(segment.name);
  return all;
}

Mask Segmentation::makeLabels(const std::vector<SegmentInfo>& chosen, const Grid& volume,
                              const MaskShaping& shaping) const {
  const auto applyOne = [&](const std::vector<SegmentInfo>& segments, double margin) {
    return applyMargin(fillMask(segments, volume, shaping.smoothing != 0.0), margin, volume);
  };
  std::vector<Mask> masks;
  if (shaping.margins.size() <= 1) // unite first: no gaps between adjacent segments
    masks.push_back(applyOne(chosen, shaping.margins.empty() ? 0.0 : shaping.margins[0]));
  else
    for (std::size_t i = 0; i < chosen.size(); ++i)
      masks.push_back(applyOne({chosen[i]}, shaping.margins[i]));
  return uniteMasks(alignMasks(std::move(masks), volume));
}

Mask Segmentation::smoothLabels(const Mask& labels, const std::vector<SegmentInfo>& chosen,
                                const Grid& volume, const MaskShaping& shaping) const {
  if (shaping.smoothing)
    return smoothMask(labels, *shaping.smoothing, volume);
  double stairs = 0.0; // mm
  for (const SegmentInfo& segment : chosen)
    stairs = std::max(stairs, findStairWidth(findNativeSpacing(m_maps[findMap(segment.layer)])));
  return smoothMaskAuto(labels, stairs, volume);
}

Mask Segmentation::makeMask(const std::vector<SegmentInfo>& chosen, const Grid& volume,
                            const MaskShaping& shaping) const {
  Mask labels = makeLabels(chosen, volume, shaping);
  return shaping.smoothing == 0.0 ? labels : smoothLabels(labels, chosen, volume, shaping);
}

} // namespace fenestra::core
