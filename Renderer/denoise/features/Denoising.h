#pragma once
// Conversion of a film and the features of its scene to the input of the denoiser.

#include "denoise/features/FeatureBuffers.h"
#include "denoise/filter/Filter.h"
#include "image/Film.h"

namespace fenestra::core {

/// Collects the half buffers of the film and the features of the scene: expected albedo, normal,
/// depth and light, the slope of the depth, and the clip depth. There are no half buffers unless
/// all pixels with variance have at least two samples. Pixels are inactive if they are
/// deterministic, or if no camera ray around them hits anything. Throws std::logic_error for a film
/// whose halves are not independent: the estimated error would be wrong.
FilterInput makeFilterInput(const Film& film, const SceneView& scene,
                            const FeatureBuffers& features);

/// Once `stop` is true, returns soon with any result.
inline FilteredImage denoise(const Film& film, const SceneView& scene,
                             const FeatureBuffers& features, const StopFlag& stop = neverStopped) {
  FilterInput input = makeFilterInput(film, scene, features);
  input.stop = &stop;
  return filterImage(std::move(input));
}

} // namespace fenestra::core
