#pragma once

#include "fenestra/Volume.h"

#include <map>

namespace fenestra {
inline namespace v1 {

/// Segment of a segmentation.
struct Segment {
  std::string id;
  std::string name;
  std::int32_t label; ///< its value in the label map, never 0
};

/// Binary mask of one segment: samples other than 0 belong to it.
struct SegmentMask {
  std::string name;
  Samples samples;
};

/// Segments in memory, on a grid of their own. Immutable; copies share the labels.
class FENESTRA_EXPORT Segmentation {
public:
  /// A label map: integers, 0 is the background. Each other value is a segment, called by `names`
  /// or "Segment_<value>". Throws Error (input) for samples that are not integers, values beyond 32
  /// bits, and as Volume for size and affine.
  Segmentation(const Samples& labels, const Affine& indexToWorld,
               const std::map<std::int32_t, std::string>& names = {});
  /// Masks of equal size, which may overlap. Throws Error (input) without any mask.
  Segmentation(const std::vector<SegmentMask>& masks, const Affine& indexToWorld);

  std::vector<Segment> segments() const;
  std::vector<Warning> warnings() const;

  struct Data;
  explicit Segmentation(std::shared_ptr<const Data> data);
  const std::shared_ptr<const Data>& data() const { return m_data; }

private:
  std::shared_ptr<const Data> m_data;
};

/// Names by label value of a table: a file, or totalsegmentator1, totalsegmentator2 or freesurfer.
/// Throws Error.
FENESTRA_EXPORT std::map<std::int32_t, std::string> readLabelNames(const std::string& table);

/// Reads a .seg.nrrd, a label map, a folder of masks, DICOM SEG or RTSTRUCT. `labels`: a table of
/// names for label values: a file, or totalsegmentator, totalsegmentator1, totalsegmentator2 or
/// freesurfer; by default names in or beside the file. `volume`: of the scan, whose grid closed
/// surfaces and contours get. Throws Error.
FENESTRA_EXPORT Segmentation readSegmentation(const std::string& path,
                                              const std::optional<std::string>& labels = {},
                                              const std::optional<Volume>& volume = {},
                                              const ReadOptions& options = {});

} // namespace v1
} // namespace fenestra
