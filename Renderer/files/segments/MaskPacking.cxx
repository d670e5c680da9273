#include "files/segments/MaskPacking.h"

#include <algorithm>
#include <optional>

namespace fenestra::core {
namespace {

/// True if the grids agree up to rounding in the files.
bool isSameGrid(const Grid& a, const Grid& b) {
  return a.size == b.size && isSameLattice(a, b) &&
         (b.worldToIndex * a.indexToWorld.translation()).norm() < 0.5;
}

/// One label map of masks on one grid, in which they do not overlap.
class Packing {
public:
  explicit Packing(const Grid& grid)
      : m_grid(grid), m_labels(static_cast<std::size_t>(grid.voxelCount())) {}

  /// Returns false if the mask overlaps one that was added, or its label value exceeds 8 bits.
  bool add(const NamedMask& named) {
    if (!std::in_range<std::uint8_t>(named.info.labelValue))
      return false;
    const auto isFree = [&](const MaskRun& run) {
      return std::all_of(m_labels.begin() + run.begin, m_labels.begin() + run.end,
                         [](auto label) { return label == 0; });
    };
    if (!std::ranges::all_of(named.mask.runs, isFree))
      return false;
    m_segments.push_back(named.info);
    for (const auto& [begin, end] : named.mask.runs)
      std::fill(m_labels.begin() + begin, m_labels.begin() + end,
                static_cast<std::uint8_t>(named.info.labelValue));
    return true;
  }

  Segmentation take(const std::string& source) {
    return {source, m_grid, 1, std::move(m_labels), std::move(m_segments)};
  }

private:
  Grid m_grid;
  LargeArray<std::uint8_t> m_labels;
  std::vector<SegmentInfo> m_segments;
};

} // namespace

Segmentation packMasks(const std::string& source, std::vector<NamedMask> masks) {
  std::optional<Segmentation> all;
  const auto add = [&](Segmentation part) {
    if (all)
      all->add(std::move(part));
    else
      all.emplace(std::move(part));
  };
  const auto isOnGrid = [](const NamedMask& mask, const Grid& grid) {
    return isSameGrid(mask.mask.grid, grid);
  };
  while (!masks.empty()) {
    const Grid grid = masks.front().mask.grid;
    const auto rest = std::stable_partition(
        masks.begin(), masks.end(), [&](const NamedMask& mask) { return isOnGrid(mask, grid); });
    std::optional<Packing> packing;
    if (rest - masks.begin() > 1) // else the whole grid for one mask would be a waste
      packing.emplace(grid);
    std::vector<Segmentation> overlapping;
    for (auto mask = masks.begin(); mask != rest; ++mask) {
      if (packing && packing->add(*mask))
        continue;
      auto [cropped, labels] = labelMask(mask->mask, mask->info.labelValue);
      overlapping.emplace_back(source, cropped, 1, std::move(labels), std::vector{mask->info});
    }
    if (packing) // the first one has its segments
      add(packing->take(source));
    std::ranges::for_each(overlapping, [&](Segmentation& one) { add(std::move(one)); });
    masks.erase(masks.begin(), rest);
  }
  return std::move(*all);
}

} // namespace fenestra::core
