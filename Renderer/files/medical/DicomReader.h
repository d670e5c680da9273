#pragma once
// Reads headers and voxels of DICOM files with GDCM, in a sandboxed child process. GDCM allocates
// any length that a file declares, and terminates its process on some damaged files.

#include "base/Vector.h"
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
  std::string contrastAgent;           ///< ContrastBolusAgent; empty: none stated
  std::vector<double> position;        ///< ImagePositionPatient: center of the first voxel, LPS mm
  std::vector<double> orientation;     ///< ImageOrientationPatient: row and column direction, LPS
  std::vector<double> pixelSpacing;    ///< mm between rows, between columns
  double slope = 1.0, intercept = 0.0; ///< NaN: not a single number
  unsigned rows = 0, columns = 0, samples = 1, frames = 1;
  unsigned bits = 0, bitsStored = 0, highBit = 0, isSigned = 0; ///< layout of a voxel
  bool isImageObject = false; ///< the SOP class is an image storage class
  bool isCompressed = false;  ///< the voxels are compressed
  bool isComplete = false;    ///< everything before the voxels is readable
};

/// True for images. Other objects (structure sets, plans, reports) have no rows.
inline bool isImage(const DicomHeader& header) {
  return header.isImageObject || header.rows > 0;
}

/// Size in bytes of the voxels that the header declares.
inline std::uint64_t imageBytes(const DicomHeader& header) {
  return std::uint64_t{header.rows} * header.columns * (header.bits / 8);
}

/// True for a file with DICOM's preamble and "DICM", whatever its extension.
bool isDicomFile(const std::filesystem::path& path);

/// Numbers of a backslash-separated list of decimal strings; empty if one is not a number.
std::vector<double> parseDecimals(std::string text);

/// Orthogonal unit vectors along a row and along a column of an image, LPS.
struct DicomAxes {
  Vec3 row, column;
  Vec3 normal() const { return row.cross(column).normalized(); }
};

/// Interprets ImageOrientationPatient; `source` is the file name in messages. Throws Error (input)
/// unless it is two orthogonal directions.
DicomAxes parseAxes(const std::vector<double>& orientation, const std::string& source);

/// Reads DICOM files through one child process.
class DicomReader {
public:
  DicomReader();

  /// Reads a header; nullopt: unreadable, or not DICOM (no preamble and "DICM"). `isComplete` is
  /// false for a damaged file and for the deflated transfer syntax. Throws Error (input) if the
  /// child crashes or exceeds its limits.
  std::optional<DicomHeader> readHeader(const std::filesystem::path& path);

  /// Reads the voxels: rows * columns values of bits / 8 bytes each, little-endian, decompressed,
  /// not rescaled. Throws Error (input) if their size differs.
  std::string readVoxels(const std::filesystem::path& path, const DicomHeader& header);

private:
  SandboxedReader m_reader;
};

/// Parses the child's reply, which is untrusted. Throws std::runtime_error for a malformed reply.
DicomHeader parseDicomHeader(std::string_view reply);

/// Throws Error (input) unless the header describes a supported image that fits in its file.
void checkDicomPixels(const std::filesystem::path& path, const DicomHeader& header);

/// Applies slope and intercept to the result of readVoxels. Requires checkDicomPixels(header).
std::vector<double> rescaleVoxels(const DicomHeader& header, const std::string& voxels);

} // namespace fenestra
