#pragma once
// From a film and its scene to a filtered picture.

#include "denoise/filter/Filter.h"
#include "scene/PreparedScene.h"

namespace fenestra {

/// Halves of the film, and features of the scene, which must have been asked for
/// (RenderRequest::features): expected albedo, normal and depth, light, the slope of the depth, and
/// the clip's depth. Without a second sample in every uncertain pixel there are no halves. Closed
/// are pixels that are certain, and those around which the march met nothing. Throws
/// std::logic_error for a film whose halves are not independent: the error that the filter tells
/// would be wrong.
FilterInput makeFilterInput(const Film& film, const PreparedScene& scene);

inline FilteredImage denoise(const Film& film, const PreparedScene& scene) {
  return filterImage(makeFilterInput(film, scene));
}

} // namespace fenestra
