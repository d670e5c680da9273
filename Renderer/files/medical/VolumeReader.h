#pragma once
// Reads scalar volumes.

#include "files/medical/SampleStore.h"
#include "files/medical/VolumeChoice.h"
#include "model/volume/Volume.h"

#include <filesystem>

namespace fenestra::core {

/// Reads NRRD (.nrrd .nhdr), NIfTI or Analyze (.nii .nii.gz, .hdr with .img), FreeSurfer (.mgz
/// .mgh), MetaImage (.mha .mhd) or VTK XML images (.vti) with any scalar type and geometry. Of
/// several frames (a fourth axis, or a NRRD list), one is read. Throws Error (input) for several
/// components, missing, damaged or truncated files, singular geometry, a volume without a finite
/// voxel, and other formats.
Volume readVolume(const std::filesystem::path& path, const VolumeChoice& choice = {});

/// Store that chooses among Volume.h's voxel types.
using VoxelStore = SampleStore<std::uint8_t, std::int16_t, std::uint16_t, float>;

/// Makes a volume of finite voxels in the smallest voxel type. `name` becomes the volume's name and
/// is used in messages. Throws Error (input) if no sample is finite.
Volume makeVolume(const std::string& name, const Grid& grid, VoxelStore&& samples);

} // namespace fenestra::core
