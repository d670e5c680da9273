#pragma once
// Header of a NIfTI-1 file of one part (nifti1.h). Read by our own code: ITK refuses an sform whose
// axes are off right angles by the rounding of its numbers.

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
  bool isSwapped = false;    ///< byte order is not the machine's
  std::int64_t offset = 352; ///< of the first sample, bytes
  std::optional<Rescaling> rescaling = {};
  Affine indexToRas = Affine::Identity(); ///< RAS mm
  std::vector<std::string> warnings = {}; ///< each names the file
};

/// Header of these bytes. Geometry is that of the sform where its code is 1 (scanner) or the qform
/// has none, else the qform's, as ITK and Slicer choose; without either, voxels along LPS axes from
/// 0 on. An sform becomes the nearest one with axes at right angles, if its unit axes differ from
/// that by less than 1e-3. Throws Error (input), which names `path`, for other headers, a sheared
/// sform, numbers that are not finite or beyond 1e9, and samples that are no real scalars.
NiftiHeader parseNiftiHeader(const NiftiBytes& bytes, const std::filesystem::path& path);

} // namespace fenestra
