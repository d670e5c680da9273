#include "program/ServeFrame.h"

#include "files/images/ImageWriter.h"
#include "scene/FilmImage.h"

#include <algorithm>
#include <limits>

namespace fenestra::core {

std::vector<Rung> chooseRungs(int width, int height) {
  constexpr int least = 100; // pixels
  std::vector<Rung> rungs;
  for (const int scale : {4, 2})
    if (std::min(width, height) >= least * scale)
      rungs.push_back({scale});
  rungs.push_back({1});
  return rungs;
}

void publishFrame(FrameFile& file, FrameInfo info, const PreparedScene& scene,
                  const RenderResult& result, const std::optional<FilteredImage>& filtered,
                  const Display& display) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  info.width = result.film.width();
  info.height = result.film.height();
  info.samples = result.finishedSamples;
  info.noise = std::isfinite(result.film.noise()) ? result.film.noise() : unknown;
  info.denoisedNoise = denoisedNoise(filtered).value_or(unknown);
  const CameraPose& pose = scene.camera().pose();
  const bool isOrthographic = pose.projection == Projection::orthographic;
  info.camera = {pose.position, pose.target, pose.up, isOrthographic,
                 isOrthographic ? pose.scale : pose.angle};
  const FeatureBuffers* features = scene.features();
  const Image raw = makeImage(result.film, scene.camera(), ClipNone(), {"color", "depth"});
  const Image shown = filtered ? makeFilteredImage(*filtered, info.width, info.height) : raw;
  const std::vector<float> color = interleaveRgba(shown);
  const std::vector<std::uint8_t> bytes =
      makeDisplayBytes(shown, makeImagePlane(scene.camera()), display);
  const Plane depth = features ? makeExpectedDepth(*features) : *raw.find("Z");
  std::vector<FrameLayer> layers = {{"color", 4, sizeof(float), std::as_bytes(std::span(color))},
                                    {"display", 4, 1, std::as_bytes(std::span(bytes))},
                                    {"depth", 1, sizeof(float), std::as_bytes(std::span(depth))}};
  if (features)
    layers.push_back({"depth50", 1, sizeof(float), std::as_bytes(std::span(features->depth50))});
  file.publish(info, layers);
}

} // namespace fenestra::core
