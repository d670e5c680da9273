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
  std::optional<Affine> qformToRas = {};  ///< the qform, if the sform was used and they disagree
  std::vector<Message> warnings = {};
};

/// Parses a header. The chosen form gives the geometry; without a choice the sform if its code is
/// positive, as in FSL, SPM and nibabel; else the qform, which ITK and Slicer prefer. A warning
/// tells if both are given, disagree by more than half a voxel at a corner, and the user chose
/// none. Without either, voxels lie along LPS axes from the origin. An sform whose unit axes are
/// within 1e-3 of orthogonal is orthogonalized; one with more shear, as of a tilted gantry, is
/// kept. If its axes are linearly dependent, the qform is used. Throws Error (input), naming
/// `path`, for other headers, a missing form, numbers that are not finite or exceed 1e9, and
/// samples that are not real scalars.
NiftiHeader parseNiftiHeader(const NiftiBytes& bytes, const std::filesystem::path& path,
                             const VolumeChoice& choice = {});

} // namespace fenestra
