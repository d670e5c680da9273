#pragma once
// Film as named channels, ready to be written.

#include "clip/keep/Clip.h"
#include "image/Film.h"
#include "image/Image.h"

#include <set>

namespace fenestra {

/// Groups of channels that a picture has, by their names in --layers.
using LayerSet = std::set<std::string>;

inline const LayerSet allLayers = {"color",  "depth", "clip",   "albedo",
                                   "normal", "error", "samples"};

/// Layers of these names; empty list: all. Throws Error (usage) for an unknown name.
LayerSet layerSet(const std::vector<std::string>& names);

Image picture(const Film& film, const Camera& camera, const Clip& clip, const LayerSet& layers);

/// Depth at which the eye ray of each pixel's centre passes the clip's surface, mm; infinity:
/// nothing lies behind the surface.
Plane clipPlane(const Camera& camera, const Clip& clip);

/// Place of the picture: on the plane through the target.
ImagePlane picturePlane(const Camera& camera);

} // namespace fenestra
