#pragma once
// Reads segmentations and makes the focus of some of their segments.

#include "base/Vector.h"
#include "model/masks/MaskShaping.h"
#include "model/volume/Mask.h"

#include <array>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace fenestra {

struct SegmentInfo {
  std::string id;
  std::string name;
  std::int32_t labelValue = 1; ///< never 0, which is the background
  std::size_t layer = 0;
  Rgb color = Rgb::Constant(0.5); ///< display-encoded, as Slicer has it
  /// What it is and, where that is said, in which part of the body: terminology codes as Slicer
  /// tags them, like "SCT^39607008".
  std::string type = {}, region = {};
};

struct SegmentStatistics {
  std::int64_t voxels = 0;
  Box bounds = {}; ///< along RAS axes, mm; holds its voxels whole; empty (at 0) without voxels
};

/// Labels in layers: segments of different layers may overlap.
class Segmentation {
public:
  /// The smallest type that holds all values; the layers of a voxel together, x fastest.
  using Labels =
      std::variant<std::vector<std::uint8_t>, std::vector<std::int16_t>, std::vector<std::int32_t>>;

  /// `source` names the file in messages.
  Segmentation(std::string source, Grid grid, std::size_t layerCount, Labels labels,
               std::vector<SegmentInfo> segments);

  const Grid& grid() const { return m_grid; }
  /// To another place, of the same size.
  void moveTo(const Grid& grid) { m_grid = grid; }
  const std::vector<SegmentInfo>& segments() const { return m_segments; }

  /// What each segment holds, in their order: one pass over the labels.
  std::vector<SegmentStatistics> statistics() const;

  /// The union of the segments that the selectors name, each by id, else by name, else by label
  /// value; cropped, and continued over the faces that the labelmap shares with `volume`, as Mask.h
  /// says. A face is shared where it is parallel to a face of the volume and within half a voxel of
  /// it. Throws Error (input) where a selector names no segment or several, or no voxel is chosen
  /// or left by `shaping`.
  Mask mask(const std::vector<std::string>& selectors, const Grid& volume,
            const MaskShaping& shaping = {}) const;

private:
  const SegmentInfo& find(const std::string& selector) const;

  std::string m_source;
  Grid m_grid;
  std::size_t m_layerCount;
  Labels m_labels;
  std::vector<SegmentInfo> m_segments;
};

/// Slicer's `.seg.nrrd`, or a labelmap in any format and geometry that readVolume takes: one
/// segment "Segment_<value>" for each value other than 0. Where voxels lie is the file's geometry
/// alone, which includes Segmentation_ReferenceImageExtentOffset; only in the oldest files, known
/// by their Segmentation_Extent, it does not, and is in RAS. SegmentN_Extent is not looked at:
/// labels say where a segment is. A `.vtm` holds closed surfaces, which become labels of
/// `reference`, the volume's grid (ClosedSurface.h); otherwise that is not looked at. Throws Error
/// (input).
Segmentation readSegmentation(const std::filesystem::path& path, const Grid* reference = nullptr);

/// What names the segments of such a file, without reading its labels; empty where the file says
/// nothing of segments, as a labelmap. Throws Error (input).
std::vector<SegmentInfo> readSegmentInfos(const std::filesystem::path& path);

} // namespace fenestra
