#include "clip/surface/SteadySurface.h"

#include <algorithm>

namespace fenestra::core {

namespace {

/// Distance of each sample from the nearest focus sample, mm. Chamfer distance over eight
/// neighbors, at most 8 % too large.
std::vector<double> computeFocusDistances(const FocusDepth& focus) {
  const DepthBuffer& buffer = focus.depth;
  std::vector<double> distances;
  for (const Region region : focus.regions)
    distances.push_back(region == Region::focus ? 0.0 : infinity);
  // Two passes, from the top and from the bottom, each from neighbors that were visited before.
  for (const std::int64_t direction : {1, -1}) {
    const auto relax = [&](std::int64_t column, std::int64_t row, std::int64_t x, std::int64_t y) {
      if (x < 0 || y < 0 || x >= buffer.columns() || y >= buffer.rows())
        return;
      double& distance = distances[static_cast<std::size_t>(buffer.sample(column, row))];
      const double step = (buffer.position(x, y) - buffer.position(column, row)).norm();
      distance =
          std::min(distance, step + distances[static_cast<std::size_t>(buffer.sample(x, y))]);
    };
    for (std::int64_t j = 0; j < buffer.rows(); ++j)
      for (std::int64_t i = 0; i < buffer.columns(); ++i) {
        const std::int64_t row = direction > 0 ? j : buffer.rows() - 1 - j;
        const std::int64_t column = direction > 0 ? i : buffer.columns() - 1 - i;
        relax(column, row, column - direction, row);
        for (const std::int64_t x : {-1, 0, 1})
          relax(column, row, column + x, row - direction);
      }
  }
  return distances;
}

} // namespace

ClippingSurface buildSteadySurface(const Camera& camera, const Domain& volume, const Mask& focus,
                                   const SurfaceOptions& options, double degrees) {
  ClippingSurface surface = buildClippingSurface(camera, volume, focus, options);
  if (degrees == 0.0 || options.mode != SurfaceMode::surface)
    return surface;
  struct Neighbor {
    double angle, weight; // angle: in units of `degrees`
  };
  // Binomial weights; the remaining 6/16 are those of the surface at 0 degrees.
  static constexpr Neighbor neighbors[] = {
      {-1.0, 1.0 / 16.0}, {-0.5, 4.0 / 16.0}, {0.5, 4.0 / 16.0}, {1.0, 1.0 / 16.0}};
  const auto& own = std::get<ClipDepth>(surface.clip);
  const double width = focus.grid.boundingRadius() * std::abs(degrees) * pi / 180.0;
  std::vector<double> blends = computeFocusDistances(surface.focus);
  for (double& blend : blends) // of the mean: 0 at the focus, 1 from `width` on
    blend = smoothStep(0.0, width, blend);

  auto buffer = std::make_shared<DepthBuffer>(*own.buffer);
  for (const auto& [angle, weight] : neighbors) {
    const Camera rotated(rotateAroundTarget(camera.pose(), angle * degrees), camera.width(),
                         camera.height());
    const ClippingSurface other = buildClippingSurface(rotated, volume, focus, options);
    const DepthBuffer& depths = *std::get<ClipDepth>(other.clip).buffer;
    for (std::int64_t row = 0; row < buffer->rows(); ++row)
      for (std::int64_t column = 0; column < buffer->columns(); ++column) {
        const std::int64_t sample = buffer->sample(column, row);
        const double difference =
            depths.depth(buffer->position(column, row)) - own.buffer->at(sample);
        const double blend = weight * blends[static_cast<std::size_t>(sample)];
        buffer->set(sample, buffer->at(sample) + blend * difference);
      }
    surface.focusSeconds += other.focusSeconds;
    surface.splineSeconds += other.splineSeconds;
    surface.fillSeconds += other.fillSeconds;
  }
  ClipDepth clip = own;
  clip.pyramid = std::make_shared<const DepthPyramid>(*buffer, clip.silhouette.get());
  clip.buffer = std::move(buffer);
  surface.clip = std::move(clip);
  return surface;
}

} // namespace fenestra::core
