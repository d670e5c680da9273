#pragma once
// From samples as a file has them to a volume's voxels. For io's own sources.

#include "io/medical/MedicalImage.h"
#include "volume/Volume.h"

namespace fenestra {

/// Keeps them in the smallest storage that holds all of them, finite, as Volume.h says. `name` is
/// the volume's, for messages. Throws Error (input) where no sample is a finite number.
Volume makeVolume(std::string name, const Grid& grid, Samples&& samples);

} // namespace fenestra
