#pragma once
// Reads DICOM segmentations (SEG, label map storage) and structure sets (RTSTRUCT) as label maps.
//
// Both are recognized by content, since their files often have no extension. They become a
// Segmentation like any other, so that nothing after this reader distinguishes them.
// - A SEG has its own grid: the planes of its frames, in any orientation and order. The distance of
//   its slices is the SpacingBetweenSlices, or the SliceThickness if it is that of the volume's
//   slices, whichever divides all gaps; else the smallest gap. Slices without frames are empty. A
//   fractional segment contains the pixels of at least half of MaximumFractionalValue.
// - A structure set has contours, no grid: they are filled on the volume's grid if one of its axes
//   is normal to them (then a voxel is inside if its center is), else on a grid along the contours
//   of the volume's finest spacing; without a volume, of 1/128 of the longest extent.
//   model/masks/ContourFill.h states how.
// Segments that overlap go to separate layers.

#include "files/medical/DicomObjects.h"
#include "files/segments/SegmentationReader.h"

#include <functional>

namespace fenestra::core {

/// Reads the segments with their labels; `reference` is the volume's grid, if there is one. Ids are
/// "Segment_<number>" and "ROI_<number>". Throws Error (input).
Segmentation readDicomSegments(const std::filesystem::path& path, const Grid* reference);

/// Reads only the segments. Throws Error (input).
std::vector<SegmentInfo> readDicomSegmentInfos(const std::filesystem::path& path);

// ---- its parts

/// Segments of an object of the file `source`. Throws Error (input).
std::vector<SegmentInfo> makeDicomInfos(const DicomObject& object, const std::string& source);

/// Bits of `count` frames from frame `first` on, as DicomObjectReader::readFrames returns them.
using FrameReader = std::function<std::string(std::uint64_t first, std::uint64_t count)>;

/// Labels of a SEG. `segments`: one for each of the object's, in order. Throws Error (input) unless
/// the file at `path` can hold the pixels that the object declares.
Segmentation makeFrameLabels(const FrameReader& readFrames, const std::filesystem::path& path,
                             const DicomSegmentation& object, std::vector<SegmentInfo> segments,
                             const Grid* reference);

/// Labels of a structure set. `segments`: one for each of the object's ROIs, in order.
Segmentation makeContourLabels(const std::string& source, const DicomStructureSet& object,
                               std::vector<SegmentInfo> segments, const Grid* reference);

} // namespace fenestra::core
