#pragma once
// Regions of an image by the tissue that is visible in them, and the tissue at the surface of a
// focus.

#include "AppearanceMeasures.h"

#include "scene/Input.h"
#include "scene/PreparedScene.h"

namespace fenestra::core::benchmarks {

/// Where camera rays are expected to collide first.
struct VisibleSurface {
  PixelMask covered;    ///< pixels whose rays collide with a probability of at least 1/2
  Raster<double> depth; ///< mm, of the first collision; infinity without one

  /// The scene must have feature buffers.
  explicit VisibleSurface(const PreparedScene& scene);
};

/// Regions of soft tissue in an image of a CT. They exclude pixels near jumps in depth.
struct TissueRegions {
  PixelMask focus;  ///< all tissue of the focus
  PixelMask muscle; ///< muscles, and tissue of their HU in no segment and not between lungs
  PixelMask heart;  ///< the heart's segments; without them, tissue of muscle's HU between lungs
};

/// Classifies what lies 3 mm behind the visible surface. Tissue has muscle's HU if within 3 mm of
/// it the mean is from 20 to 80 HU, and at most 5 % of the values are below -20 or above 150 HU.
/// `segmentation`: null without one.
TissueRegions findTissueRegions(const PreparedScene& scene, const VisibleSurface& surface,
                                const PixelMask& focus, const Segmentation* segmentation);

/// Foreign tissue at the surface of a focus (A8): fraction of the surface 1 mm inside which the
/// volume is farther than 3.5 s from the median of the focus; both from the voxels at least 8 mm
/// deep, s is 1.4826 times their median absolute deviation, at least 10 HU: smoothing of the volume
/// leaves less noise than an organ varies by itself. Empty: fewer than 200 such voxels, or s over
/// 60 HU, so that the focus is not one tissue.
std::optional<double> measureForeignSurface(const Volume& volume, const Mask& focus);

} // namespace fenestra::core::benchmarks
