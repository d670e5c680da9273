#pragma once
// Reads DICOM segmentations (SEG and label map storage) and structure sets (RTSTRUCT).
//
// GDCM parses them in a child process of their own kind: a segmentation of all organs takes more
// memory and time than a slice. The child replies with what the objects say, in LPS mm, and with
// the frames' stored bits; it decides nothing. Frames are requested in parts, since all of them may
// not fit into one reply. How they become labels is stated in files/segments/DicomSegments.h.

#include "base/Vector.h"
#include "io/Sandbox.h"

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace fenestra::core {

struct DicomSegment {
  std::int32_t number = 0; ///< SegmentNumber
  std::string label = {};
  /// RecommendedDisplayCIELabValue: L, a, b as integers from 0 to 65535; empty: missing.
  std::vector<double> color = {};
  std::string category = {}, type = {}, region = {}; ///< codes like "SCT^39607008"; empty: missing
};

/// Functional groups of a frame. Lists are empty if missing.
struct DicomFrame {
  std::int32_t segment = 0;              ///< ReferencedSegmentNumber; 0: none, as in label maps
  std::vector<double> position = {};     ///< center of the first pixel, LPS mm
  std::vector<double> orientation = {};  ///< row and column direction, LPS
  std::vector<double> pixelSpacing = {}; ///< mm between rows, between columns
  std::vector<double> spacingBetweenSlices = {}; ///< mm
  std::vector<double> sliceThickness = {};       ///< mm
};

struct DicomSegmentation {
  std::string type; ///< "BINARY", "FRACTIONAL" or "LABELMAP"
  std::int32_t rows = 0, columns = 0;
  std::int32_t bits = 0;     ///< of a pixel, without gaps: 1, 8 or 16
  double maximum = 0.0;      ///< MaximumFractionalValue; 0: missing
  bool isCompressed = false; ///< the pixels are, or the whole file
  std::vector<DicomSegment> segments = {};
  std::vector<DicomFrame> frames = {};
};

struct DicomRoi {
  std::int32_t number = 0; ///< ROINumber
  std::string name = {};
  std::vector<double> color = {};                 ///< red, green, blue, 0 to 255; empty: missing
  std::vector<std::vector<double>> contours = {}; ///< closed planar ones: x, y, z of points, LPS mm
};

struct DicomStructureSet {
  std::vector<DicomRoi> rois = {};
};

using DicomObject = std::variant<DicomSegmentation, DicomStructureSet>;

/// Reads such files through one child process.
class DicomObjectReader {
public:
  DicomObjectReader();

  /// Reads everything but the pixels. Throws Error (input) for damaged files and for other kinds of
  /// DICOM objects.
  DicomObject read(const std::filesystem::path& path);

  /// Reads the bits of `count` frames from frame `first` on. Frames follow each other without gaps:
  /// the bit at 0 is the first of frame `first` only if its bits begin a byte, else it follows
  /// after (first * rows * columns * bits) % 8 bits. Pixels are little-endian. Throws Error
  /// (input).
  std::string readFrames(const std::filesystem::path& path, const DicomSegmentation& object,
                         std::uint64_t first, std::uint64_t count);

private:
  SandboxedReader m_reader;
};

extern const SandboxJob objectJob;

/// Parses the child's reply to read(), which is untrusted. Throws std::runtime_error for a
/// malformed reply, Error (input) for an object of another kind; `source` is the file name in
/// messages.
DicomObject parseDicomObject(std::string_view reply, const std::string& source);

} // namespace fenestra::core
