#pragma once
// From samples as a file has them to a volume's voxels. For io's own sources.

#include "files/medical/SampleStore.h"
#include "model/volume/Volume.h"

namespace fenestra {

/// Of Volume.h's types.
using VoxelStore = SampleStore<std::uint8_t, std::int16_t, std::uint16_t, float>;

/// Finite voxels in the smallest storage, as Volume.h says. `name` is the volume's, for messages.
/// Throws Error (input) where no sample is a finite number.
Volume makeVolume(std::string name, const Grid& grid, VoxelStore&& samples);

} // namespace fenestra
