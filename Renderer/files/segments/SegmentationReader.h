#pragma once
// Reads segmentations and makes the focus of some of their segments.

#include "base/LargePages.h"
#include "base/Vector.h"
#include "model/masks/MaskShaping.h"
#include "model/volume/Mask.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace fenestra {

struct SegmentInfo {
  std::string id;
  std::string name;
  std::int32_t labelValue = 1; ///< never 0, which is the background
  std::size_t layer = 0;
  Rgb color = Rgb::Constant(0.5); ///< display-encoded
  /// Terminology codes of category, type and body region, like "SCT^39607008"; empty: not stated.
  std::string category = {}, type = {}, region = {};

  /// Sets category, type and region from Slicer's tags of a segment; ignores malformed ones.
  void parseTerminology(std::string_view tags);
};

struct SegmentStatistics {
  std::int64_t voxels = 0;
  Box bounds = {}; ///< along RAS axes, mm, around whole voxels; empty (at 0) without voxels
};

/// Labels in layers: segments of different layers may overlap.
class Segmentation {
public:
  /// Labels in the smallest type that holds all values; a voxel's layers together, x fastest.
  using Labels =
      std::variant<LargeArray<std::uint8_t>, LargeArray<std::int16_t>, LargeArray<std::int32_t>>;

  /// `source` names the file in messages.
  Segmentation(std::string source, const Grid& grid, std::size_t layerCount, Labels labels,
               std::vector<SegmentInfo> segments)
      : m_source(std::move(source)),
        m_grid(grid),
        m_layerCount(layerCount),
        m_labels(std::move(labels)),
        m_segments(std::move(segments)) {}

  const Grid& grid() const { return m_grid; }
  /// Name of the file in messages.
  const std::string& source() const { return m_source; }
  void setSource(std::string source) { m_source = std::move(source); }
  /// Source of the names of a label map's values: a file or a table; empty: they have none, or are
  /// the segmentation's own.
  const std::string& namesSource() const { return m_namesSource; }
  const std::vector<std::string>& warnings() const { return m_warnings; }
  void setNamesSource(std::string source, std::vector<std::string> warnings) {
    m_namesSource = std::move(source);
    m_warnings = std::move(warnings);
  }
  /// Replaces the grid by one of the same size.
  void setGrid(const Grid& grid) { m_grid = grid; }
  const std::vector<SegmentInfo>& segments() const { return m_segments; }

  /// Statistics of each segment, in their order: one pass over the labels.
  std::vector<SegmentStatistics> statistics() const;

  /// Place in segments() of the one that the selector names by id, else by name, else by label
  /// value. Throws Error (input) where it names none or several.
  std::size_t find(const std::string& selector) const;

  /// Union of the segments that the selectors name. Throws Error (input) as find and maskOf do, and
  /// where `shaping` leaves no voxel.
  Mask makeFocusMask(const std::vector<std::string>& selectors, const Grid& volume,
                     const MaskShaping& shaping = {}) const;
  /// Union of some of segments(); cropped, and continued over the faces that the labelmap shares
  /// with `volume`, as Mask.h says: faces parallel to a face of the volume, and within half a voxel
  /// of it. Throws Error (input) where no voxel is chosen.
  Mask makeMask(const std::vector<SegmentInfo>& chosen, const Grid& volume,
                const MaskShaping& shaping = {}) const;

private:
  std::string m_source, m_namesSource;
  std::vector<std::string> m_warnings;
  Grid m_grid;
  std::size_t m_layerCount;
  Labels m_labels;
  std::vector<SegmentInfo> m_segments;
};

/// Labels in a Segmentation's order, from `count` layers one after the other.
Segmentation::Labels interleaveLayers(Segmentation::Labels layers, std::size_t count);

/// Reads Slicer's `.seg.nrrd`; a labelmap in any format and geometry that readVolume takes: one
/// segment "Segment_<value>" for each value other than 0, named by `labels` or what is found
/// (LabelSearch.h); or a `.vtm` of closed surfaces, which become labels on `reference`, the
/// volume's grid (ClosedSurface.h; unused otherwise). Geometry is the file's, which includes
/// Segmentation_ReferenceImageExtentOffset; only that of the oldest files, known by their
/// Segmentation_Extent, does not, and is in RAS. SegmentN_Extent is ignored: labels show where a
/// segment is. Throws Error (input).
Segmentation readSegmentation(const std::filesystem::path& path, const Grid* reference = nullptr,
                              const std::optional<std::string>& labels = {});

/// Segments of such a file, without reading its labels where the file names them itself; empty:
/// there are no names for its values. Throws Error (input).
std::vector<SegmentInfo> readSegmentInfos(const std::filesystem::path& path,
                                          const std::optional<std::string>& labels = {});

} // namespace fenestra
