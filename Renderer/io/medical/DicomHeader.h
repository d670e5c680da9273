#pragma once
// What a DICOM file says of its image, and where its voxels are. For io's own sources. GDCM's
// parser is left out, for it takes memory for whatever length a file declares and ends the process
// where a file is damaged; its decompressors serve DicomPixels.h.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fenestra {

/// A stretch of the file.
struct DicomFragment {
  std::uint64_t begin = 0, length = 0;
};

struct DicomHeader {
  std::string seriesUid, seriesNumber, seriesDescription, modality;
  std::string transferSyntax, photometric;
  std::vector<double> position;     ///< ImagePositionPatient: of the first voxel's centre, LPS mm
  std::vector<double> orientation;  ///< ImageOrientationPatient: along a row, along a column; LPS
  std::vector<double> pixelSpacing; ///< mm between rows, between columns
  std::vector<double> slope, intercept; ///< one number each, or missing
  unsigned rows = 0, columns = 0, samples = 1;
  unsigned bits = 0, bitsStored = 0, highBit = 0, isSigned = 0; ///< of a voxel
  std::uint64_t frames = 1;
  bool bigEndian = false;            ///< the voxels are
  bool compressed = false;           ///< into fragments
  std::vector<DicomFragment> pixels; ///< one where they are not compressed, or none
  bool whole = false;                ///< all lengths lie within the file, to its end
};

/// Nothing where the file cannot be read or is not DICOM (its preamble and "DICM" are missing).
/// `whole` is false where it is damaged, truncated, or deflated as a whole.
std::optional<DicomHeader> readDicomHeader(const std::filesystem::path& path);

} // namespace fenestra
