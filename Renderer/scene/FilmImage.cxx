#include "scene/FilmImage.h"

#include "base/Error.h"

namespace fenestra::core {
namespace {

double perSample(double sum, const PixelSums& pixel) {
  return pixel.samples > 0 ? sum / static_cast<double>(pixel.samples) : 0.0;
}

double meanDepth(const PixelSums& pixel) {
  return pixel.collidedSamples > 0 ? pixel.depth / static_cast<double>(pixel.collidedSamples)
                                   : infinity;
}

} // namespace

LayerSet parseLayers(const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (!allLayers.contains(name))
      throw requestError(ErrorCode::unknownName, "layers", "'", name,
                         "' is unknown; use color, depth, clip, albedo, normal, error, samples, "
                         "denoised, expected, depth50");
  return names.empty() ? allLayers : LayerSet(names.begin(), names.end());
}

Image makeImage(const Film& film, const Camera& camera, const Clip& clip, const LayerSet& layers) {
  Image image{film.width(), film.height(), {}, {}};
  const auto add = [&](const char* layer, const std::string& name, auto&& value) {
    if (!layers.contains(layer))
      return;
    Plane& plane = image.channels[name];
    plane.reserve(film.pixelCount());
    for (const PixelSums& pixel : film.pixels())
      plane.push_back(static_cast<float>(value(pixel)));
  };
  // PixelSums holds the mean of the radiance, but sums of all else.
  using P = PixelSums;
  for (int c = 0; c < 3; ++c) {
    const std::string color(1, "RGB"[c]), axis(1, "XYZ"[c]);
    add("color", color, [c](const P& p) { return p.mean[c]; });
    add("error", "error." + color, [c](const P& p) { return p.standardError()[c]; });
    add("albedo", "albedo." + color, [c](const P& p) { return perSample(p.albedo[c], p); });
    add("normal", "normal." + axis, [c](const P& p) { return perSample(p.normal[c], p); });
  }
  add("color", "A", [](const P& p) { return perSample(p.alpha, p); });
  add("depth", "Z", meanDepth);
  add("samples", "samples.N", [](const P& p) { return static_cast<double>(p.samples); });
  if (layers.contains("clip") && !std::holds_alternative<ClipNone>(clip))
    image.channels["clip.Z"] = makeClipDepth(camera, clip);
  return image;
}

void addDenoised(Image& image, const FilteredImage& result) {
  for (std::size_t c = 0; c < 4; ++c)
    image.channels[std::string("denoised.") + "RGBA"[c]] = result.color[c];
  for (std::size_t c = 0; c < 3 && !result.error[c].empty(); ++c)
    image.channels[std::string("denoised.error.") + "RGB"[c]] = result.error[c];
}

void addExpected(Image& image, const FeatureBuffers& features) {
  for (std::size_t c = 0; c < 3; ++c) {
    image.channels[std::string("expected.albedo.") + "RGB"[c]] = features.albedo[c];
    image.channels[std::string("expected.normal.") + "XYZ"[c]] = features.normal[c];
  }
  image.channels["expected.Z"] = makeExpectedDepth(features);
}

Plane makeExpectedDepth(const FeatureBuffers& features) {
  Plane depth;
  // `hit`: probability of a collision; `depth` is multiplied by it.
  for (std::size_t i = 0; i < features.hit.size(); ++i)
    depth.push_back(features.hit[i] > 0.0F ? features.depth[i] / features.hit[i]
                                           : std::numeric_limits<float>::infinity());
  return depth;
}

Image makeFilteredImage(const FilteredImage& result, int width, int height) {
  Image image{width, height, {}, {}};
  for (std::size_t c = 0; c < 4; ++c)
    image.channels[std::string(1, "RGBA"[c])] = result.color[c];
  return image;
}

ImagePlane makeImagePlane(const Camera& camera) {
  const Vec3 target = camera.pose().target;
  const Vec2 firstPixel = camera.toPlane(0.5, 0.5);
  return {target + firstPixel.x() * camera.right() + firstPixel.y() * camera.up(),
          camera.pixelPitch() * camera.right(), -camera.pixelPitch() * camera.up()};
}

} // namespace fenestra::core
