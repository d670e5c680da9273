#pragma once
// Conversion of a film and its scene to the input of the denoiser.

#include "denoise/filter/Filter.h"
#include "scene/PreparedScene.h"

namespace fenestra {

/// Collects the half buffers of the film and the feature buffers of the scene, which must have been
/// requested (RenderRequest::features): expected albedo, normal, depth and light, the slope of the
/// depth, and the clip depth. There are no half buffers unless all pixels with variance have at
/// least two samples. Pixels are inactive if they are deterministic, or if no camera ray around
/// them hits anything. Throws std::logic_error for a film whose halves are not independent: the
/// estimated error would be wrong.
FilterInput makeFilterInput(const Film& film, const PreparedScene& scene);

inline FilteredImage denoise(const Film& film, const PreparedScene& scene) {
  return filterImage(makeFilterInput(film, scene));
}

} // namespace fenestra
