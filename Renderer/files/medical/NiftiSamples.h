#pragma once
// Reads the samples of a NIfTI-1 file. ITK's library silently turns samples that are not finite
// into zeros, and holds all samples twice; a child (Apart.h) would copy them once more.

#include "files/medical/SampleSource.h"

#include <cstddef>
#include <filesystem>

namespace fenestra {

/// Throws Error (input) unless the file has a NIfTI-1 header of one part; the library would
/// complain on the standard error stream.
void checkNiftiHeader(const std::filesystem::path& path);

/// First `count` samples of a .nii or .nii.gz. Throws Error (input) for more samples than the file
/// can hold; reading them throws where the file ends before.
SampleSource niftiSamples(const std::filesystem::path& path, std::size_t count);

} // namespace fenestra
