#pragma once
// Media of a scene's segments, in cached stages (CachedStage.h). Codes and names assign each
// segment to a component, labels give the components' weights per voxel, and the transfer function
// converts colors to albedo. A change of color therefore does not recompute the weights. Materials
// are tints by default: they change colors, but add, move or hide no surface. If segments differ in
// more than color, the components become a mixture.

#include "model/medium/Mixture.h"
#include "model/medium/Tint.h"
#include "scene/CachedStage.h"
#include "scene/Input.h"
#include "scene/NamedPresets.h"
#include "scene/StageStop.h"

#include <map>

namespace fenestra::core {

/// Segments of one component and one priority, or the detected skin, which is no segment.
struct TintPart {
  std::vector<std::size_t> segments; ///< indices in Segmentation::segments(); empty: skin
  int priority;
  std::uint8_t component;
  bool isFocus = false; ///< belongs to a focus whose colors are adjusted

  bool operator==(const TintPart&) const = default;
};

struct TintPlan {
  std::vector<TintPart> parts; ///< at least one; detected skin is the last
  /// Media; `parts` hold their priorities. Component 0 is the medium outside all segments, and of
  /// every segment with an equal medium.
  std::vector<SegmentMedium> components;
  std::vector<std::string> names; ///< per component: of its segment, or of a shared material
  std::vector<bool> isFocus;      ///< per component; all false if colors are not adjusted

  /// True if skin was detected that is no segment.
  bool hasDetectedSkin() const { return parts.back().segments.empty(); }
};

/// Segments (indices in Segmentation::segments()) of a focus that consists of transparent tissue,
/// such as lungs, with the median of their scalars.
using TransparentFocus = std::map<std::size_t, double>;

/// For each of Segmentation::segments(): true if it has a voxel. Reads all labels.
std::vector<bool> findNonEmpty(const Handle<SegmentsInput>& segments);

/// Makes one component per distinct medium of the non-empty segments; if colors are adjusted, the
/// focus gets components of its own. `hasVoxels`: from findNonEmpty(). `changes`: values of
/// --material, which override the table. If colors are adjusted, a segment with a palette color
/// keeps the volume's own colors. `focus`: ids, names or label values. `skin`: from findSkin();
/// null or empty: none; ignored if a segment is skin. `transparent`: segments to show as solid
/// bodies with their surface at the segment's, and the color of the material at the median; null:
/// none. Throws Error (input) for a change to an unknown segment, for context colors without a
/// focus, if no segment has a voxel, and for more than 256 components.
TintPlan makeTintPlan(const Handle<SegmentsInput>& segments,
                      const Handle<std::vector<bool>>& hasVoxels,
                      const Handle<NamedMaterials>& materials,
                      const std::vector<std::string>& changes,
                      const std::vector<std::string>& focus, const Handle<Mask>& skin,
                      const Handle<TransparentFocus>& transparent);

/// Label weights of the components. `smoothing`: MaskShaping::smoothing. Detected skin is resampled
/// on the label grid (resampleMask()). Throws as requireRunning, soon after the flag was set.
LabelWeights computeLabelWeights(const Handle<SegmentsInput>& segments,
                                 const std::vector<TintPart>& parts, const Handle<Mask>& skin,
                                 const std::optional<double>& smoothing, const Grid& volume,
                                 const StageStop& stop = {});

/// `g`: mean cosine of the phase function, which relates albedo and reflected color.
Tint buildTint(const Handle<TintPlan>& plan, const Handle<LabelWeights>& weights, double g);

/// True if the components differ only in color.
bool isTintOnly(const TintPlan& plan);

/// Builds the components with the albedo of `tint`, which must have been computed for the mean
/// cosine of `transfer`, the volume's transfer function.
Mixture buildMixture(const TintPlan& plan, const Tint& tint, const TransferFunction& transfer);

} // namespace fenestra::core
