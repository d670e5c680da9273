#pragma once
// Matter of a scene's segments, in stages (Stage.h): what is said of the segments decides which
// component each belongs to, their labels how much of each voxel it gets, and the transfer function
// which albedo makes its colour. Another colour needs no labels anew. Where segments differ in more
// than colour, the components become a mixture.

#include "model/medium/Mixture.h"
#include "model/medium/Tint.h"
#include "scene/CachedStage.h"
#include "scene/Input.h"
#include "scene/NamedPresets.h"

namespace fenestra {

/// Segments of one component and one priority, or the skin that is no segment.
struct TintPart {
  std::vector<std::size_t> segments; ///< places in Segmentation::segments(); none: the skin
  int priority;
  std::uint8_t component;
  bool isFocus = false; ///< the focus's, to be set off by colour

  bool operator==(const TintPart&) const = default;
};

struct TintPlan {
  std::vector<TintPart> parts; ///< at least one; skin that is no segment is the last
  /// Matter of the components, at least one; their priority is the parts'. Component 0 is what no
  /// segment covers, and every segment of the same matter.
  std::vector<SegmentMedium> components;
  std::vector<std::string> names; ///< of the components: a segment's, else a material's
  std::vector<bool> isFocus;      ///< by component; none is where nothing sets off the focus

  /// True if there is skin that is no segment.
  bool hasDetectedSkin() const { return parts.back().segments.empty(); }
};

/// By place in Segmentation::segments(): true if the segment has a voxel. Reads all labels.
std::vector<bool> findNonEmpty(const Handle<SegmentsInput>& segments);

/// Components of the segments that have voxels (`there`: findNonEmpty): one for each matter, and,
/// where materials set off the focus, those of the focus apart. `changes`: of --material, over the
/// materials that the table gives; with contrast a segment of which nothing is known keeps the
/// volume's own colours. `focus`: ids, names or label values. `skin`: skinOf(); null or without
/// voxels: none; it is left out, too, where a segment is skin. Throws Error (input) for a change to
/// an unknown segment, for colours of a context without a focus, without any voxel, and for more
/// than 256 components.
TintPlan makeTintPlan(const Handle<SegmentsInput>& segments,
                      const Handle<std::vector<bool>>& hasVoxels,
                      const Handle<NamedMaterials>& materials,
                      const std::vector<std::string>& changes,
                      const std::vector<std::string>& focus, const Handle<Mask>& skin);

/// Shares of the components. `smoothing`: MaskShaping's. Skin that is no
/// segment is put on the labels' voxels (resampleMask()).
LabelWeights computeLabelWeights(const Handle<SegmentsInput>& segments,
                                 const std::vector<TintPart>& parts, const Handle<Mask>& skin,
                                 const std::optional<double>& smoothing, const Grid& volume);

/// `g`: mean cosine of whatever scatters, by which albedo makes a colour.
Tint buildTint(const Handle<TintPlan>& plan, const Handle<LabelWeights>& weights, double g);

/// True if components differ in colour alone.
bool isTintOnly(const TintPlan& plan);

/// Components with the albedo of `tint`, which was made for the mean cosine of `transfer`, the
/// volume's own.
Mixture buildMixture(const TintPlan& plan, const Tint& tint, const TransferFunction& transfer);

} // namespace fenestra
