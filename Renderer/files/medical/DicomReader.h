#pragma once
// Headers and voxels of DICOM files, read by GDCM in a child process: GDCM takes memory for
// whatever length a file declares, and ends its process where a file is damaged.

#include "io/Sandbox.h"

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
  std::vector<double> position;     ///< ImagePositionPatient: first voxel's centre, LPS mm
  std::vector<double> orientation;  ///< ImageOrientationPatient: along a row, along a column, LPS
  std::vector<double> pixelSpacing; ///< mm between rows, between columns
  double slope = 1.0, intercept = 0.0; ///< NaN: not one number
  unsigned rows = 0, columns = 0, samples = 1, frames = 1;
  unsigned bits = 0, bitsStored = 0, highBit = 0, isSigned = 0; ///< layout of a voxel
  bool isImageObject = false; ///< this kind of object has an image
  bool isCompressed = false;  ///< voxels are compressed
  bool isComplete = false;    ///< all before the voxels can be read
};

/// True for images: objects without one (structures, plans, reports) have no rows.
inline bool isImage(const DicomHeader& header) {
  return header.isImageObject || header.rows > 0;
}

/// Bytes of the voxels that the header declares.
inline std::uint64_t imageBytes(const DicomHeader& header) {
  return std::uint64_t{header.rows} * header.columns * (header.bits / 8);
}

/// Reader of a folder's files, with one child process.
class DicomReader {
public:
  DicomReader();

  /// Header of a file; nullopt: unreadable, or not DICOM (preamble and "DICM" are missing). `whole`
  /// is false for a damaged or wholly deflated file. Throws Error (input) where the child crashes
  /// or exceeds its limits.
  std::optional<DicomHeader> readHeader(const std::filesystem::path& path);

  /// Voxels, rows * columns of bits / 8 bytes each, little-endian, decompressed, not yet rescaled.
  /// Throws Error (input) for another number of voxels.
  std::string readVoxels(const std::filesystem::path& path, const DicomHeader& header);

private:
  SandboxedReader m_reader;
};

/// Header in the child's answer, which is untrusted. Throws std::runtime_error for a malformed
/// answer.
DicomHeader parseDicomHeader(std::string_view reply);

/// Throws Error (input) unless the header describes an image that its file can hold.
void checkDicomPixels(const std::filesystem::path& path, const DicomHeader& header);

/// Scalars of DicomReader::voxels, after slope and intercept. `header` has passed checkDicomPixels.
std::vector<double> rescaleVoxels(const DicomHeader& header, const std::string& voxels);

} // namespace fenestra
