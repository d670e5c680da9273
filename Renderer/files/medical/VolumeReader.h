#pragma once
// Reads the scalar volume.

#include "model/volume/Volume.h"

#include <filesystem>

namespace fenestra {

/// Reads NRRD (.nrrd .nhdr), NIfTI (.nii .nii.gz) or MetaImage (.mha .mhd), of any scalar type and
/// geometry; stored as Volume.h says. Throws Error (input): several components or frames, missing,
/// damaged or truncated files, singular geometry, no finite voxel, other formats.
Volume readVolume(const std::filesystem::path& path);

} // namespace fenestra
