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
/// `history`: planes of seenAgain, as more features.
FilteredPicture denoised(const Film& film, const Scene& scene,
                         const std::vector<Plane>& history = {});

/// The light of a filtered picture's halves, of another eye's view of the same matter, light and
/// focus, as it is seen from `scene`'s eye: found again by the expected depth of both. Two features
/// whose noise is independent of the new samples': where they are wrong (what the other eye did not
/// see, what shines toward one eye alone), the fit makes little of them. Both scenes have features;
/// empty if `picture` has no halves.
std::vector<Plane> seenAgain(const FilteredPicture& picture, const Scene& before,
                             const Scene& scene);

} // namespace fenestra
