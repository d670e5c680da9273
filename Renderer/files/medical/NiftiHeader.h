#pragma once
// Header of a NIfTI-1 or NIfTI-2 image (nifti1.h, nifti2.h), in a single file or a pair, or of an
// Analyze 7.5 image. Parsed by our own code, since ITK rejects an sform whose axes deviate from
// right angles by mere rounding.

#include "base/Error.h"
#include "files/medical/SampleSource.h"
#include "files/medical/VolumeChoice.h"
#include "model/volume/Grid.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra::core {

inline constexpr std::size_t nifti1Bytes = 348, nifti2Bytes = 540; ///< of the headers

struct NiftiHeader {
  std::vector<std::int64_t> size; ///< voxels along each axis, at least 1
  SampleType type = {};
  bool isSwapped = false;    ///< byte order differs from the machine's
  std::int64_t offset = 352; ///< byte offset of the first sample, in the file that has them
  std::int64_t end = 0;      ///< byte offset after the header in the same file; 0: another file
  std::optional<Rescaling> rescaling = {};
  Affine indexToRas = Affine::Identity(); ///< RAS mm
  std::optional<Affine> qformToRas = {};  ///< the qform, if the sform was used and they disagree
  std::vector<Message> warnings = {};
};

/// Number of bytes that parseNiftiHeader needs, by the first four.
std::size_t countNiftiHeaderBytes(std::string_view start);

/// Parses a header; whether the samples are in another file follows from the extension of `path`,
/// .hdr or .img. Analyze images have no geometry: their axes are taken as left, anterior and
/// superior around the origin, as in SPM, with a warning. The chosen form gives the geometry;
/// without a choice the sform if its code is positive, as in FSL, SPM and nibabel; else the qform,
/// which ITK and Slicer prefer. A warning tells if both are given, disagree by more than half a
/// voxel at a corner, and the user chose none. Without either, voxels lie along LPS axes from the
/// origin. An sform whose unit axes are within 1e-3 of orthogonal is orthogonalized; one with more
/// shear, as of a tilted gantry, is kept. If its axes are linearly dependent, the qform is used.
/// Throws Error (input), naming `path`, for other headers, a missing form, numbers that are not
/// finite or exceed 1e9, and samples that are not real scalars.
NiftiHeader parseNiftiHeader(std::string_view bytes, const std::filesystem::path& path,
                             const VolumeChoice& choice = {});

} // namespace fenestra::core
