#include "scene/SolidFocus.h"

#include "base/Distribution.h"
#include "model/masks/MaskShaping.h"
#include "scene/Defaults.h"

#include <tbb/parallel_for.h>

namespace fenestra::core {
namespace {

/// Removes voxels of a mask that are, along an axis, within `gap` mm or one voxel of `other`, a
/// mask on the same lattice.
Mask removeContact(Mask mask, const Mask& other, double gap) {
  const Size3 offset = findOffset(mask, other);
  const Vec3 voxels = gap * mask.grid.spacing().cwiseInverse();
  const Size3 reach = voxels.cast<std::int64_t>().cwiseMax(1);
  const auto isNear = [&](const Size3& voxel) {
    for (int axis = 0; axis < 3; ++axis)
      for (std::int64_t step = -reach[axis]; step <= reach[axis]; ++step)
        if (other.contains(voxel + step * Size3::Unit(axis)))
          return true;
    return false;
  };
  const Size3& size = mask.grid.size;
  tbb::parallel_for(std::int64_t{0}, size.z(), [&](std::int64_t z) {
    for (std::int64_t y = 0; y < size.y(); ++y)
      for (std::int64_t x = 0; x < size.x(); ++x)
        if (std::uint8_t& voxel = mask.voxels[linearIndex({x, y, z}, size)];
            voxel && isNear(offset + Size3(x, y, z)))
          voxel = 0;
  });
  mask.count = mask.countInside();
  return mask;
}

} // namespace

TransparentFocus findTransparentFocus(const Handle<SegmentsInput>& input,
                                      const Handle<std::vector<bool>>& hasVoxels,
                                      const std::vector<std::string>& names,
                                      const VolumeHandle& volume,
                                      const Handle<TransferChoice>& transfer) {
  const Segmentation& segmentation = input->segmentation;
  TransparentFocus found;
  for (const std::string& name : names) {
    const std::size_t number = segmentation.find(name);
    if (!(*hasVoxels)[number])
      continue;
    const Mask mask = segmentation.makeMask({segmentation.segments()[number]}, volume->volume.grid);
    if (transparentFraction(mask, volume->volume, transfer->function) <= mostTransparent)
      return {};
    found.emplace(number, findMedian(sampleValues(volume->volume, mask)));
  }
  return found;
}

Handle<SegmentsInput> separateSegments(const Handle<SegmentsInput>& input,
                                       const Handle<TransparentFocus>& transparent,
                                       const VolumeHandle& volume) {
  constexpr double gap = 5.0; // mm; smoothing leaves about half
  const Segmentation& original = input->segmentation;
  std::vector<SegmentInfo> segments;
  std::vector<Mask> masks;
  for (const auto& [number, median] : *transparent) {
    segments.push_back(original.segments()[number]);
    masks.push_back(original.makeMask({segments.back()}, volume->volume.grid));
  }
  std::shared_ptr<SegmentsInput> copy;
  for (std::size_t i = 0; i < masks.size(); ++i) {
    Mask mask = masks[i];
    for (std::size_t k = i + 1; k < masks.size(); ++k)
      if (isSameLattice(mask.grid, masks[k].grid))
        mask = removeContact(std::move(mask), masks[k], gap);
    if (mask.count == masks[i].count || 2 * mask.count < masks[i].count) // thin, such as a bronchus
      continue;
    if (!copy)
      copy = std::make_shared<SegmentsInput>(*input);
    copy->segmentation.restrictSegment(segments[i], mask);
  }
  return copy ? copy : input;
}

} // namespace fenestra::core
