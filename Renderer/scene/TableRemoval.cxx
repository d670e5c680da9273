#include "scene/TableRemoval.h"

#include "scene/Defaults.h"

namespace fenestra::core {
namespace {

/// Union of all segments with voxels; nullopt: there are none.
std::optional<Mask> uniteSegments(const Segmentation& segmentation,
                                  const std::vector<bool>& hasVoxels, const Grid& volume) {
  std::vector<SegmentInfo> present;
  for (std::size_t i = 0; i < hasVoxels.size(); ++i)
    if (hasVoxels[i])
      present.push_back(segmentation.segments()[i]);
  return present.empty() ? std::nullopt : std::optional(segmentation.makeMask(present, volume));
}

} // namespace

FoundTable findTable(const VolumeHandle& read, TableRequest request) {
  const Volume& volume = read->volume;
  const bool isCt = volume.modality ? *volume.modality == Modality::ct
                                    : isPlausibleModality(Modality::ct, volume);
  if (request == TableRequest::automatic && !isCt)
    return {};
  FoundTable found{findScannerTable(volume)};
  if (!found.table && request == TableRequest::remove)
    found.warnings.push_back(makeMessage(ErrorCode::uncertainTable, volume.name,
                                         "has no table that is found with certainty; nothing is "
                                         "removed"));
  return found;
}

VolumeInput removeTable(const VolumeHandle& read, const Handle<FoundTable>& found,
                        const Handle<SegmentsInput>& segments,
                        const Handle<std::vector<bool>>& hasVoxels) {
  constexpr double cubicMmInMl = 1000.0;
  VolumeInput result = *read;
  const std::optional<Mask> preserved =
      segments ? uniteSegments(segments->segmentation, *hasVoxels, result.volume.grid)
               : std::nullopt;
  const double removed =
      removeScannerTable(*found->table, preserved ? &*preserved : nullptr, result.volume);
  result.volume.warnings.push_back(
      makeMessage(ErrorCode::removedTable, result.volume.name, "the table of the scanner (",
                  toString(removed / cubicMmInMl, 3), " ml) is not shown"));
  return result;
}

} // namespace fenestra::core
