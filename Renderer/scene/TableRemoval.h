#pragma once
// Stage that removes the table of the scanner from a CT.

#include "model/filtering/ScannerTable.h"
#include "scene/Stages.h"

namespace fenestra::core {

struct FoundTable {
  std::optional<ScannerTable> table = {};
  std::vector<Message> warnings = {};
};

/// `automatic`: only if the volume seems to be CT. `remove`: warns if no table is found.
FoundTable findTable(const VolumeHandle& volume, TableRequest request);

/// The volume without the table, which must be found, but with all voxels of `segments` (null:
/// none). `hasVoxels`: from findNonEmpty(). Adds a warning.
VolumeInput removeTable(const VolumeHandle& volume, const Handle<FoundTable>& table,
                        const Handle<SegmentsInput>& segments,
                        const Handle<std::vector<bool>>& hasVoxels);

} // namespace fenestra::core
