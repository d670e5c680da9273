#pragma once
// Reads the scalar volume.

#include "files/medical/SampleStore.h"
#include "model/volume/Volume.h"

#include <filesystem>

namespace fenestra {

/// Reads NRRD (.nrrd .nhdr), NIfTI (.nii .nii.gz) or MetaImage (.mha .mhd), of any scalar type and
/// geometry; stored as Volume.h says. Throws Error (input): several components or frames, missing,
/// damaged or truncated files, singular geometry, no finite voxel, other formats.
Volume readVolume(const std::filesystem::path& path);

/// Store of Volume.h's types.
using VoxelStore = SampleStore<std::uint8_t, std::int16_t, std::uint16_t, float>;

/// Volume of finite voxels in the smallest storage, as Volume.h says. `name`: the volume's, and for
/// messages. Throws Error (input) where no sample is a finite number.
Volume makeVolume(const std::string& name, const Grid& grid, VoxelStore&& samples);

} // namespace fenestra
