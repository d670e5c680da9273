#pragma once
// From a film and its scene to a filtered picture.

#include "filter/Filter.h"
#include "session/Scene.h"

namespace fenestra {

/// The film's halves, and features of the scene, which must have been asked for them
/// (SceneRequest::features): expected albedo, normal and depth, the slope of the depth, and the
/// clip's depth. Throws std::logic_error for a film whose halves are not independent: the error
/// that the filter tells would be wrong.
FilterInput filterInput(const Film& film, const Scene& scene);

/// The film, filtered; raw where `scene` has no features. Without a second sample in all
/// uncertain pixels no error is told.
FilteredPicture denoised(const Film& film, const Scene& scene);

} // namespace fenestra
