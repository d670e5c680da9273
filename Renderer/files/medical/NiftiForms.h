#pragma once
// Choice between the qform and the sform of a NIfTI file by the grid of another file.

#include "files/medical/VolumeChoice.h"
#include "model/volume/Grid.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace fenestra::core {

/// Grids that an image file may have, by its header: one, or two if its qform and sform disagree.
/// Empty: not a format of MedicalHeader.h. Throws Error (input) as readMedicalImage does.
std::vector<Grid> readPossibleGrids(const std::filesystem::path& path);

/// Sets the form of `choice` if it has none, and the qform and sform of a NIfTI file disagree, and
/// exactly one of them places all corners within half a voxel of those of a grid of `others`, which
/// is called only then. `name` describes `others` in the reader's warning. Does nothing for files
/// that cannot be read.
void chooseNiftiForm(const std::filesystem::path& path,
                     const std::function<std::vector<Grid>()>& others, const std::string& name,
                     VolumeChoice& choice);

/// As above, by the grid of the volume for a segmentation; null: none.
VolumeChoice chooseFormByVolume(const std::filesystem::path& path, const Grid* volume);

} // namespace fenestra::core
