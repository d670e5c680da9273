#pragma once
// Matter of segments. A volume's own transfer function is the matter of everything; a material
// changes what it says within a segment:
//
//     tint     the albedo alone. Extinction, phase function, surfaces and normals stay the transfer
//              function's, so that an error of the segmentation can colour wrongly, and never
//              move, hide or invent a surface.
//     matter   all of it.
//
// This header is data, without names. `files/appearance/MaterialReader` reads tables of materials,
// and the rules that say which segments they are for; `scene/SegmentMaterials` chooses by these
// rules one SegmentMedium for each segment, in the segments' order. Transport sees no rule, code or
// name.
//
// A renderer of them takes a list of components (Mixture.h, Tint.h), one for each distinct material
// of a volume, and the share of each in every voxel, on the segmentation's grid and under its
// transform; all shares of a volume sum to 1, by `priority` where segments overlap. A volume
// without segments is one component.

#include "model/medium/PiecewiseLinear.h"

#include <optional>

namespace fenestra {

enum class MaterialKind { tint, medium };

/// Members that are not set are as the volume's transfer function has them.
struct Material {
  MaterialKind kind = MaterialKind::tint;
  /// Over the scalar, linear Rec. 709, 0 to 1: the colour that an eye sees of a thick piece, from
  /// which the albedo follows by the mean cosine of whatever scatters there (Reflectance.h).
  std::optional<ColorFunction> color = {};
  bool colorIsAlbedo = false;                    ///< `color` is the albedo itself
  std::optional<ScalarFunction> extinction = {}; ///< mm^-1 over the scalar

  // Matter alone has these:
  double g = 0.0;                                        ///< Henyey-Greenstein mean cosine
  double diffuse = 1.0, specular = 0.2, roughness = 0.4; ///< lobes, as SurfaceShading's
  /// Weight of the border as a surface: of the gradient of the segment's share, per mm, beside that
  /// of the scalar over its span.
  double interfaceWeight = 0.0;
};

/// Colour that an eye sees; nullopt: the transfer function's.
std::optional<ColorFunction> toReflectanceColor(const Material& material);

/// A segment's matter.
struct SegmentMedium {
  Material material = {};
  int priority = 10;     ///< where segments overlap, the greater takes what it covers
  bool isClipped = true; ///< false: stays where the clip removes all else
  double density = 1.0;  ///< multiplies the extinction
};

} // namespace fenestra
