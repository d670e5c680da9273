#pragma once
// Optical properties of segments. The volume's transfer function applies everywhere; a material
// overrides it within a segment:
//
//     tint     the albedo only. Extinction, phase function, surfaces and normals come from the
//              transfer function, so that segmentation errors can change colors but never move,
//              hide or create a surface.
//     medium   all properties.
//
// These types are plain data. `files/appearance/MaterialReader` reads tables of materials and rules
// that match segments by name or code; `scene/SegmentMaterials` applies the rules and yields one
// SegmentMedium per segment. The integrators do not depend on rules, codes or names.
//
// The renderer uses a list of components (Mixture.h, Tint.h): one per distinct material of a
// volume, with its weight in every voxel, on the segmentation's grid and under its transform. The
// weights sum to 1; `priority` decides where segments overlap. Without segments there is one
// component.

#include "model/medium/PiecewiseLinear.h"

#include <optional>

namespace fenestra::core {

enum class MaterialKind { tint, medium };

/// Members that are not set keep the values of the volume's transfer function.
struct Material {
  MaterialKind kind = MaterialKind::tint;
  /// Over the scalar, linear Rec. 709, 0 to 1: reflectance of a thick piece of the material. It
  /// determines the albedo, by the mean cosine of the local phase function (Reflectance.h).
  std::optional<ColorFunction> color = {};
  bool colorIsAlbedo = false;                    ///< `color` is the albedo, not the reflectance
  std::optional<ScalarFunction> extinction = {}; ///< mm^-1 over the scalar

  // For MaterialKind::medium only:
  double g = 0.0;                                        ///< Henyey-Greenstein mean cosine
  double diffuse = 1.0, specular = 0.2, roughness = 0.4; ///< lobes, as in SurfaceShading
  /// Weight of the segment's interface as a surface: scales the gradient of the segment's weight,
  /// per mm, which is added to the scalar gradient (divided by the transfer function's span).
  double interfaceWeight = 0.0;
};

/// Color as reflectance; nullopt: the transfer function's.
std::optional<ColorFunction> toReflectanceColor(const Material& material);

/// Optical properties of one segment.
struct SegmentMedium {
  Material material = {};
  int priority = 10;     ///< the segment with the highest priority gets the overlap
  bool isClipped = true; ///< false: the clip does not remove it
  double density = 1.0;  ///< factor on the extinction
};

} // namespace fenestra::core
