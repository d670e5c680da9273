#pragma once
// Header of a single-file NIfTI-1 image (nifti1.h). Parsed by our own code, since ITK rejects an
// sform whose axes deviate from right angles by mere rounding.

#include "base/Error.h"
#include "files/medical/SampleSource.h"
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

/// Parses a header. The sform gives the geometry if its code is 1 (scanner) or there is no qform;
/// otherwise the qform does, as in ITK and Slicer. Without either, voxels lie along LPS axes from
/// the origin. An sform whose unit axes are within 1e-3 of orthogonal is orthogonalized; larger
/// shears are rejected. Throws Error (input), naming `path`, for other headers, numbers that are
/// not finite or exceed 1e9, and samples that are not real scalars.
NiftiHeader parseNiftiHeader(const NiftiBytes& bytes, const std::filesystem::path& path);

} // namespace fenestra
