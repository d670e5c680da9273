#pragma once
// What DICOM files say of their images, and their voxels, read by GDCM in a process of its own:
// GDCM takes memory for whatever length a file declares, and ends its process where a file is
// damaged. For io's own sources.

#include "base/safe/Apart.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

struct DicomHeader {
  std::string seriesUid, seriesNumber, seriesDescription, modality;
  std::string photometric;
  std::vector<double> position;     ///< ImagePositionPatient: of the first voxel's centre, LPS mm
  std::vector<double> orientation;  ///< ImageOrientationPatient: along a row, along a column; LPS
  std::vector<double> pixelSpacing; ///< mm between rows, between columns
  std::vector<double> slope, intercept; ///< one number each (NaN where it is none), or missing
  unsigned rows = 0, columns = 0, samples = 1, frames = 1;
  unsigned bits = 0, bitsStored = 0, highBit = 0, isSigned = 0; ///< of a voxel
  bool image = false;                                           ///< its kind of object has one
  bool compressed = false;                                      ///< its voxels are
  bool whole = false; ///< what comes before the voxels can be read
};

/// Objects without an image (structures, plans, reports) have no rows.
inline bool isImage(const DicomHeader& header) {
  return header.image || header.rows > 0;
}

/// Bytes of the voxels that it promises.
inline std::uint64_t imageBytes(const DicomHeader& header) {
  return std::uint64_t{header.rows} * header.columns * (header.bits / 8);
}

/// One child process for the files of a folder.
class DicomFiles {
public:
  DicomFiles();

  /// Nothing where the file cannot be read or is not DICOM (its preamble and "DICM" are missing).
  /// `whole` is false where it is damaged, or deflated as a whole. Throws Error (input) where
  /// reading breaks the child or takes more than it may.
  std::optional<DicomHeader> header(const std::filesystem::path& path);

  /// rows * columns voxels of bits / 8 bytes, little-endian, decompressed, not yet rescaled. Throws
  /// Error (input) where there are not as many.
  std::string voxels(const std::filesystem::path& path, const DicomHeader& header);

private:
  Apart m_child;
};

/// The header in what the child answered, which may be anything: then std::runtime_error.
DicomHeader dicomHeader(std::string_view answer);

} // namespace fenestra
