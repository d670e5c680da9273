#pragma once
// Conversion of a film to an image with named channels.

#include "clip/field/Clip.h"
#include "denoise/features/FeatureBuffers.h"
#include "denoise/filter/FilterInput.h"
#include "image/Film.h"
#include "image/Image.h"

#include <set>

namespace fenestra::core {

/// Names of channel groups, as in --layers.
using LayerSet = std::set<std::string>;

inline const LayerSet allLayers = {"color", "depth",   "clip",     "albedo",   "normal",
                                   "error", "samples", "denoised", "expected", "depth50"};

/// Layers with these names; an empty list selects all. Throws Error (request) for an unknown name.
LayerSet parseLayers(const std::vector<std::string>& names);

Image makeImage(const Film& film, const Camera& camera, const Clip& clip, const LayerSet& layers);

/// Adds the channels denoised.* and denoised.error.*.
void addDenoised(Image& image, const FilteredImage& result);
/// Adds the channels expected.*: albedo and normal as means over all rays, like the film's; Z, like
/// the channel Z, as the mean over the rays that hit something, else infinity.
void addExpected(Image& image, const FeatureBuffers& features);
/// Channel expected.Z.
Plane makeExpectedDepth(const FeatureBuffers& features);
/// Image with the channels R, G, B and A of the denoised image.
Image makeFilteredImage(const FilteredImage& result, int width, int height);

/// Position and size of the image in the world, on the plane through the target.
ImagePlane makeImagePlane(const Camera& camera);

} // namespace fenestra::core
