#pragma once
// Reads segmentations, and makes focus masks from their segments.

#include "base/Error.h"
#include "base/Vector.h"
#include "files/medical/SampleSource.h"
#include "files/segments/LabelNames.h"
#include "files/segments/NativeGrid.h"
#include "model/masks/MaskShaping.h"
#include "model/volume/Mask.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra::core {

struct SegmentInfo {
  std::string id;
  std::string name;
  std::int32_t labelValue = 1;    ///< never 0, the background
  std::size_t layer = 0;          ///< counted over all label maps
  Rgb color = Rgb::Constant(0.5); ///< display-encoded
  /// Terminology codes of category, type and body region, like "SCT^39607008"; empty: not given.
  std::string category = {}, type = {}, region = {};

  /// Sets category, type and region from a segment's tags in Slicer; ignores malformed tags.
  void parseTerminology(std::string_view tags);
};

/// True if `selector`, without blanks around, is the segment's id, name or label value.
bool isSelected(const SegmentInfo& segment, std::string_view selector);

/// Index of the segment whose id, else name, else label value is `selector`. Throws Error (input),
/// which names `source`, if none or several match.
std::size_t findSegment(const std::vector<SegmentInfo>& segments, const std::string& selector,
                        const std::string& source);

/// Lists ids and names for a message, at most 12.
std::string formatSegments(const std::vector<SegmentInfo>& segments);

struct SegmentStatistics {
  std::int64_t voxels = 0;
  Box bounds = {}; ///< axis-aligned in RAS, mm, enclosing the voxels; empty (at 0) without voxels
};

/// Labels on a grid, in layers.
struct LabelMap {
  LabelMap(const Grid& gridIn, std::size_t layers, Labels labelsIn)
      : grid(gridIn),
        layerCount(layers),
        labels(std::move(labelsIn)),
        nativeVoxels(estimateNativeVoxels(labels, grid.size, layerCount)) {}

  Grid grid;
  std::size_t layerCount;
  Labels labels;
  Vec3 nativeVoxels;
  std::size_t firstLayer = 0; ///< number of the layers of the label maps before it
};

/// One or more label maps in layers; segments in different layers may overlap.
class Segmentation {
public:
  using Labels = fenestra::core::Labels;

  /// `source` is the file name in messages.
  Segmentation(std::string source, const Grid& grid, std::size_t layerCount, Labels labels,
               std::vector<SegmentInfo> segments)
      : m_source(std::move(source)), m_segments(std::move(segments)) {
    m_maps.emplace_back(grid, layerCount, std::move(labels));
  }

  /// Adds the label maps and segments of another segmentation, as further layers. Label maps on the
  /// same lattice count as made on equal voxels: the wider ones of their estimates.
  void add(Segmentation more);

  /// Of the first label map.
  const Grid& grid() const { return m_maps.front().grid; }
  /// File name in messages.
  const std::string& source() const { return m_source; }
  void setSource(std::string source) { m_source = std::move(source); }
  /// File or table that names the label values; empty: they have no names, or the segmentation's
  /// own.
  const std::string& namesSource() const { return m_namesSource; }
  void setNamesSource(std::string source) { m_namesSource = std::move(source); }
  const std::vector<Message>& warnings() const { return m_warnings; }
  void addWarnings(const std::vector<Message>& warnings) {
    m_warnings.insert(m_warnings.end(), warnings.begin(), warnings.end());
  }
  /// Replaces the grid of the only label map by one of equal size.
  void setGrid(const Grid& grid) { m_maps.front().grid = grid; }
  /// Edges of the voxels on which the labels of the first label map were made, mm
  /// (estimateNativeVoxels).
  Vec3 nativeSpacing() const { return findNativeSpacing(m_maps.front()); }
  const std::vector<SegmentInfo>& segments() const { return m_segments; }

  /// Statistics of each segment, in order; one pass over the labels per layer.
  std::vector<SegmentStatistics> statistics() const;

  /// Divides each voxel of all label maps into eight with the same labels.
  void divideVoxels();
  /// Removes a segment's voxels that a binary mask on its label map's lattice does not contain.
  void restrictSegment(const SegmentInfo& segment, const Mask& mask);

  /// findSegment() of segments().
  std::size_t find(const std::string& selector) const {
    return findSegment(m_segments, selector, m_source);
  }

  /// Union of the selected segments, with Mask::volumeChange. Throws Error (input) as find and
  /// makeMask do, and if `shaping` leaves no voxel.
  Mask makeFocusMask(const std::vector<std::string>& selectors, const Grid& volume,
                     const MaskShaping& shaping = {}) const;
  /// Union of some of segments(), cropped. Where a face of a label map coincides with a face of
  /// `volume` (parallel, within half a voxel), the mask continues beyond it, as Mask.h describes.
  /// Segments of several lattices are resampled on the finest one, or on that of `volume` if it is
  /// much coarser. Does not measure Mask::volumeChange.
  /// Throws Error (input) if the segments have no voxel.
  Mask makeMask(const std::vector<SegmentInfo>& chosen, const Grid& volume,
                const MaskShaping& shaping = {}) const;

private:
  /// Index of the label map with this layer.
  std::size_t findMap(std::size_t layer) const;
  /// Union of segments, interpolated between slices if `isShaped`.
  Mask fillMask(const std::vector<SegmentInfo>& chosen, const Grid& volume, bool isShaped) const;
  /// Union of segments with their margins, before smoothing.
  Mask makeLabels(const std::vector<SegmentInfo>& chosen, const Grid& volume,
                  const MaskShaping& shaping) const;
  Mask smoothLabels(const Mask& labels, const std::vector<SegmentInfo>& chosen, const Grid& volume,
                    const MaskShaping& shaping) const;
  static Vec3 findNativeSpacing(const LabelMap& map) {
    return map.nativeVoxels.cwiseProduct(map.grid.spacing());
  }

  std::string m_source, m_namesSource;
  std::vector<Message> m_warnings;
  std::vector<LabelMap> m_maps; ///< at least one
  std::vector<SegmentInfo> m_segments;
};

/// Interleaves `count` layers, stored one after the other, into a Segmentation's order.
Segmentation::Labels interleaveLayers(Segmentation::Labels layers, std::size_t count);

/// Label map of samples: one segment "Segment_<value>" per value other than 0, named by `names`.
/// Throws Error (input) for samples that are not integers, and for more than 65536 values.
Segmentation makeLabelMap(const std::string& source, const Grid& grid, const SampleSource& samples,
                          const LabelNames& names = {});

/// Reads a segmentation:
/// - Slicer's `.seg.nrrd`. The file's geometry includes Segmentation_ReferenceImageExtentOffset,
///   except in the oldest files, which have Segmentation_Extent and are in RAS. SegmentN_Extent is
///   ignored, since the labels show where a segment is.
/// - A labelmap that readVolume can read: one segment "Segment_<value>" per value other than 0,
///   named by `labels` or by the names found (LabelSearch.h). A probability map has the segment 1,
///   where it is at least 1/2.
/// - A `.vtm` of closed surfaces, converted to labels on `reference`, the volume's grid.
/// - A folder of masks (MaskFolder.h).
/// - A DICOM SEG or RTSTRUCT file, whatever its extension (DicomSegments.h).
/// Throws Error (input).
Segmentation readSegmentation(const std::filesystem::path& path, const Grid* reference = nullptr,
                              const std::optional<std::string>& labels = {});

/// Warning about a label map that has as many voxels as the volume, but another position or
/// spacing: its header was lost, or belongs to another scan. `source`: of the labels, for the
/// message.
std::vector<Message> checkPosition(const std::string& source, const Grid& labels,
                                   const Grid& volume);

/// Reads only the segments; reads labels only if needed to match names to values. Empty: the values
/// have no names. Throws Error (input).
std::vector<SegmentInfo> readSegmentInfos(const std::filesystem::path& path,
                                          const std::optional<std::string>& labels = {});

} // namespace fenestra::core
