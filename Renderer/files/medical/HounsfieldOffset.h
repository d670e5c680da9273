#pragma once
// CT whose scanner or exporter stored HU + 1024 and does not say so: its air is at 0.

#include "model/volume/Volume.h"

namespace fenestra {

/// Reads the voxels of a CT that states no rescaling as value - 1024, where that is certain:
/// minimum >= -200, mode of the voxels on the volume's sides |mode| <= 50 (air), and median of the
/// voxels above 200 from 800 to 1300 (soft tissue). A warning says so; another one says where only
/// the air is at 0.
void correctHounsfieldOffset(Volume& volume);

} // namespace fenestra
