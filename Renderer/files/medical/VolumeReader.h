#pragma once
// Reads the scalar volume.

#include "model/volume/Volume.h"

#include <filesystem>

namespace fenestra {

/// NRRD (.nrrd .nhdr), NIfTI (.nii .nii.gz) or MetaImage (.mha .mhd), of any scalar type and
/// geometry; stored as Volume.h says. Throws Error (input) for anything else: several components or
/// frames, missing, damaged or truncated files, geometry that is singular, no finite voxel at all.
Volume readVolume(const std::filesystem::path& path);

} // namespace fenestra
