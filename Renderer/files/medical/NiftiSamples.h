#pragma once
// Reads the samples of a NIfTI-1 file. ITK's library for that turns samples that are not finite
// into zeros, unasked, and holds all of them twice; a child (Apart.h) would copy them once more.
// For io's own sources.

#include "files/medical/SampleSource.h"

#include <cstddef>
#include <filesystem>

namespace fenestra {

/// Throws Error (input) where there is no NIfTI-1 header of one part: what the library would
/// complain about on the standard error stream.
void checkNiftiHeader(const std::filesystem::path& path);

/// The first `count` samples of a .nii or .nii.gz. Throws Error (input) where they cannot be there;
/// so does reading them where they are not.
SampleSource niftiSamples(const std::filesystem::path& path, std::size_t count);

} // namespace fenestra
