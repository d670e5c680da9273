#pragma once
// A film as named channels: what is written.

#include "clip/keep/Clip.h"
#include "image/Film.h"
#include "image/Image.h"

namespace fenestra {

/// Which channels a picture carries (design, section 3, EXR channels).
struct LayerSet {
  bool color = true, depth = true, clip = true, albedo = true, normal = true, error = true,
       samples = true;
};

/// From layer names, all of them for an empty list. Throws Error (usage) for an unknown name.
LayerSet layerSet(const std::vector<std::string>& names);

Image picture(const Film& film, const Camera& camera, const Clip& clip, const LayerSet& layers);

/// Where the picture lies: on the plane through the target.
ImagePlane picturePlane(const Camera& camera);

} // namespace fenestra
