#pragma once
// Film as named channels, ready to be written.

#include "clip/field/Clip.h"
#include "denoise/features/FeatureBuffers.h"
#include "denoise/filter/FilterInput.h"
#include "image/Film.h"
#include "image/Image.h"

#include <set>

namespace fenestra {

/// Groups of channels that a picture has, by their names in --layers.
using LayerSet = std::set<std::string>;

inline const LayerSet allLayers = {"color", "depth",   "clip",     "albedo",  "normal",
                                   "error", "samples", "denoised", "expected"};

/// Layers of these names; empty list: all. Throws Error (usage) for an unknown name.
LayerSet parseLayers(const std::vector<std::string>& names);

Image makeImage(const Film& film, const Camera& camera, const Clip& clip, const LayerSet& layers);

/// Adds the channels denoised.* and denoised.error.*.
void addDenoised(Image& image, const FilteredImage& result);
/// Adds the channels expected.*: albedo and normal over all rays, as Film's; Z, like the channel Z,
/// over those that meet something, and infinity where none does.
void addExpected(Image& image, const FeatureBuffers& features);
/// R, G, B and A of the filtered picture.
Image makeFilteredImage(const FilteredImage& result, int width, int height);

/// Depth at which the eye ray of each pixel's centre passes the clip's surface, mm; infinity:
/// nothing lies behind the surface.
Plane makeClipDepth(const Camera& camera, const Clip& clip);

/// Place of the picture: on the plane through the target.
ImagePlane makeImagePlane(const Camera& camera);

} // namespace fenestra
