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
#include <variant>
#include <vector>

namespace fenestra::core {

/// Header of one frame: a file of a single image, or a frame of a multi-frame file with the values
/// of its functional groups. Texts are empty, and lists empty, if the value is missing.
struct DicomHeader {
  std::string sopClass, sopUid;
  std::string seriesUid, seriesNumber, seriesDescription, modality;
  std::string frameOfReference; ///< uid
  std::string referencedSeries; ///< uid; of segmentations
  std::string imageType;        ///< backslash-separated
  std::string photometric;
  std::string convolutionKernel;
  std::string contrastAgent;           ///< ContrastBolusAgent; empty: none stated
  std::string characterSet;            ///< of the texts
  std::vector<double> position;        ///< ImagePositionPatient: center of the first voxel, LPS mm
  std::vector<double> orientation;     ///< ImageOrientationPatient: row and column direction, LPS
  std::vector<double> pixelSpacing;    ///< mm between rows, between columns
  std::vector<double> sliceSpacing;    ///< mm along the normal; negative: against it
  std::vector<double> sliceThickness;  ///< mm
  std::vector<double> sliceVector;     ///< nuclear medicine: slice of each frame, from 1
  double slope = 1.0, intercept = 0.0; ///< NaN: not a single number
  // What the volumes of a series differ in
  std::optional<double> instance, echoTime, bValue, temporalPosition, cardiacPhase, triggerTime,
      acquisition, acquisitionTime;
  // Of a PET: dates and times as in the file, decimals
  std::string units, decayCorrection, seriesDate, seriesTime, acquisitionDate, injectionTime,
      injectionDateTime;
  std::optional<double> weight;   ///< of the patient, kg
  std::optional<double> dose;     ///< injected, Bq
  std::optional<double> halfLife; ///< s
  unsigned rows = 0, columns = 0, samples = 1;
  unsigned frames = 1, frame = 0;                               ///< of the file; index of this one
  unsigned bits = 0, bitsStored = 0, highBit = 0, isSigned = 0; ///< layout of a voxel
  bool isImageObject = false;       ///< the SOP class is an image storage class
  bool isCompressed = false;        ///< the voxels are compressed, or the file is deflated
  bool isComplete = false;          ///< everything before the voxels is readable
  bool isDirectory = false;         ///< a DICOMDIR
  bool isPlacedByThickness = false; ///< the file states no position of this frame
};

/// True for segmentations and structure sets.
bool isDicomSegmentation(const DicomHeader& header);

/// True for images of a scan. Other objects have no rows (structure sets, reports, presentation
/// states), or show something else (segmentations, doses).
bool isImage(const DicomHeader& header);

/// Size in bytes of the voxels that the header declares for its frame.
inline std::uint64_t imageBytes(const DicomHeader& header) {
  return std::uint64_t{header.rows} * header.columns * (header.bits / 8);
}

/// True for a file with DICOM's preamble and "DICM", or one that begins with two elements of a data
/// set in little endian, whatever its extension.
bool isDicomFile(const std::filesystem::path& path);

/// Numbers of a backslash-separated list of decimal strings; empty if one is not a number.
std::vector<double> parseDecimals(std::string text);

/// Orthogonal unit vectors along a row and along a column of an image, LPS.
struct DicomAxes {
  Vec3 row, column;
  Vec3 normal() const { return row.cross(column).normalized(); }
};

/// Interprets ImageOrientationPatient; nullopt unless it is two orthogonal directions.
std::optional<DicomAxes> findAxes(const std::vector<double>& orientation);
/// The same; throws Error (input) instead. `source` is the file name in messages.
DicomAxes parseAxes(const std::vector<double>& orientation, const std::string& source);

/// Reads DICOM files through child processes: one for files of one frame, and one with more memory
/// and time for files of several.
class DicomReader {
public:
  DicomReader();

  /// Reads the headers of all frames; empty: unreadable, or not DICOM (isDicomFile).
  /// `isComplete` is false for a damaged file. Throws Error (input) if the child crashes or exceeds
  /// its limits (unreadableFile), or for an unsupported transfer syntax (unsupportedFile).
  std::vector<DicomHeader> readHeaders(const std::filesystem::path& path);

  /// Reads the voxels of a frame: rows * columns values of bits / 8 bytes each, little-endian,
  /// decompressed, not rescaled. Throws Error (input) if their size differs.
  std::string readVoxels(const std::filesystem::path& path, const DicomHeader& header);

private:
  SandboxedReader m_reader, m_frameReader;
};

/// Parses the child's reply, which is untrusted: headers of all frames. Throws std::runtime_error
/// for a malformed reply, and Error (input) about `source` for an unsupported transfer syntax.
std::vector<DicomHeader> parseDicomHeaders(std::string_view reply, const std::string& source);

/// Most bytes of pixels that a file can hold.
std::uint64_t countPixelBytes(const std::filesystem::path& path, bool isCompressed);

/// Throws Error (input) unless the header describes a supported image that fits in its file.
void checkDicomPixels(const std::filesystem::path& path, const DicomHeader& header);

/// Integers if slope and intercept are, as of a CT, and the results fit.
using RescaledVoxels =
    std::variant<std::vector<std::int16_t>, std::vector<std::int32_t>, std::vector<double>>;

/// Applies slope and intercept to the result of readVoxels. Requires checkDicomPixels(header).
RescaledVoxels rescaleVoxels(const DicomHeader& header, const std::string& voxels);

} // namespace fenestra::core
