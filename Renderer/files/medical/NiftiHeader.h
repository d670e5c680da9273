#pragma once
// Header of a single-file NIfTI-1 image (nifti1.h). Parsed by our own code, since ITK rejects an
// sform whose axes deviate from right angles by mere rounding.

#include "base/Error.h"
#include "files/medical/SampleSource.h"
#include "files/medical/VolumeChoice.h"
#include "model/volume/Grid.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fenestra {

using NiftiBytes = std::array<char, 348>;

struct NiftiHeader {
  std::vector<std::int64_t> size; ///< voxels along each axis, at least 1
  SampleType type = {};
  bool isSwapped = false;    ///< byte order differs from the machine's
  std::int64_t offset = 352; ///< byte offset of the first sample
  std::optional<Rescaling> rescaling = {};
  Affine indexToRas = Affine::Identity(); ///< RAS mm
  std::vector<Message> warnings = {};
};

/// Parses a header. `form` gives the geometry; without it the sform if its code is positive, as in
/// FSL, SPM and nibabel; else the qform, which ITK and Slicer prefer. A warning tells if both are
/// given and disagree by more than half a voxel at a corner. Without either, voxels lie along LPS
/// axes from the origin. An sform whose unit axes are within 1e-3 of orthogonal is orthogonalized;
/// with larger shears the qform is used, with a warning, or without one, the file is rejected.
/// Throws Error (input), naming `path`, for other headers, a missing `form`, numbers that are not
/// finite or exceed 1e9, and samples that are not real scalars.
NiftiHeader parseNiftiHeader(const NiftiBytes& bytes, const std::filesystem::path& path,
                             std::optional<NiftiForm> form = {});

} // namespace fenestra
