#pragma once
// Voxels of a volume from a file's samples.

#include "files/medical/SampleStore.h"
#include "model/volume/Volume.h"

namespace fenestra {

/// Store of Volume.h's types.
using VoxelStore = SampleStore<std::uint8_t, std::int16_t, std::uint16_t, float>;

/// Volume of finite voxels in the smallest storage, as Volume.h says. `name`: the volume's, and for
/// messages. Throws Error (input) where no sample is a finite number.
Volume makeVolume(std::string name, const Grid& grid, VoxelStore&& samples);

} // namespace fenestra
