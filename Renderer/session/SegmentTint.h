#pragma once
// Colours of a scene's segments, in stages (Stage.h): what is said of the segments decides which
// component of the tint each belongs to, their labels how much of each voxel it gets, and the
// transfer function which albedo makes its colour. Another colour needs no labels anew.

#include "model/medium/Tint.h"
#include "session/Input.h"
#include "session/NamedLooks.h"
#include "session/Stage.h"

namespace fenestra {

/// Segments of one component and one priority.
struct TintPart {
  std::vector<std::size_t> segments; ///< places in Segmentation::segments()
  int priority;
  std::uint8_t component;

  bool operator==(const TintPart&) const = default;
};

struct TintPlan {
  std::vector<TintPart> parts; ///< at least one
  /// Materials of the components, at least one. Component 0 is what no segment covers, and every
  /// segment that looks as that does.
  std::vector<Material> components;
  std::vector<std::string> names; ///< of the components: a segment's, else a material's
  std::vector<bool> isFocus;      ///< by component; none is where nothing sets off the focus
};

/// Components of the segments that have voxels: one for each colour, and, where materials set off
/// the focus, those of the focus apart. `changes`: of --material, over the materials that the table
/// gives; with contrast a segment of which nothing is known keeps the volume's own colours.
/// `focus`: ids, names or label values. Throws Error (input) for a change to an unknown segment,
/// for what tint cannot show (matter, a density, a segment that is not clipped), for colours of a
/// context without a focus, without any voxel, and for more than 256 colours.
TintPlan tintPlan(const Handle<SegmentsInput>& segments, const Handle<NamedMaterials>& materials,
                  const std::vector<std::string>& changes, const std::vector<std::string>& focus);

/// Shares of the components. `smoothing`: MaskShaping's.
Shares tintShares(const Handle<SegmentsInput>& segments, const std::vector<TintPart>& parts,
                  const std::optional<double>& smoothing, const Grid& volume);

/// `g`: mean cosine of whatever scatters, by which albedo makes a colour.
Tint tintOf(const Handle<TintPlan>& plan, const Handle<Shares>& shares, double g);

} // namespace fenestra
