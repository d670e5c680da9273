#include "MatrixSegments.h"

namespace fenestra::core::testing {
namespace {

struct Ball {
  Vec3 center; ///< index space of the label map
  double radius;
  int priority;
};

/// Balls of the combination, in a label map of 17 voxels along each axis.
std::vector<Ball> makeBalls(const Combination& c, Generator& generator) {
  const Vec3 middle = Vec3::Constant(8.0);
  std::vector<Ball> all;
  for (int i = 0; i < c.segmentCount; ++i) {
    const auto priority = static_cast<int>(uniform(generator, 0.0, 3.0));
    const double radius = uniform(generator, 2.0, 4.5);
    const Vec3 corner(i & 1 ? 12.0 : 4.0, i & 2 ? 12.0 : 4.0, i & 4 ? 12.0 : 4.0);
    if (c.segments == SegmentFactor::nested)
      all.push_back({middle, 7.0 - 0.7 * i, i});
    else if (c.segments == SegmentFactor::disjoint)
      all.push_back({corner, 3.0, priority});
    else
      all.push_back({middle + 3.0 * randomDirection(generator), radius, priority});
  }
  return all;
}

/// Mask of a ball over its own extent.
Mask makeBallMask(const Ball& ball, const Grid& labels, bool isSoft) {
  const Size3 first = (ball.center.array() - ball.radius - 2.0).floor().cast<std::int64_t>();
  const Size3 end = (ball.center.array() + ball.radius + 3.0).ceil().cast<std::int64_t>();
  Affine map = labels.indexToWorld;
  map.translate(first.cast<double>());
  Mask mask;
  mask.grid = Grid(end - first, map);
  mask.maxValue = isSoft ? 255 : 1;
  for (std::int64_t z = first.z(); z < end.z(); ++z)
    for (std::int64_t y = first.y(); y < end.y(); ++y)
      for (std::int64_t x = first.x(); x < end.x(); ++x) {
        const double inside = ball.radius - (Size3(x, y, z).cast<double>() - ball.center).norm();
        const double fraction = isSoft ? std::clamp(0.5 + inside / 2.0, 0.0, 1.0) : inside > 0.0;
        mask.voxels.push_back(static_cast<std::uint8_t>(fraction * mask.maxValue));
      }
  return mask;
}

using Component = oracle::ComponentsDescription::Component;

ColorFunction makeColors(const ScalarFunction& extinction, Generator& generator) {
  const auto channel = [&] { return uniform(generator, 0.1, 0.95); };
  const auto color = [&] { return Rgb(channel(), channel(), channel()); };
  const auto& knots = extinction.knots();
  return ColorFunction({{knots.front().position, color()}, {knots.back().position, color()}});
}

/// A segment's own extinction: constant, or a function of the scalar.
ScalarFunction makeSegmentExtinction(const ScalarFunction& volume, bool isConstant,
                                     Generator& generator) {
  const double low = volume.knots().front().position, high = volume.knots().back().position;
  const auto at = [&](double position) {
    return ScalarFunction::Knot{position, ScalarFunction::Value(uniform(generator, 0.0, 2.5))};
  };
  if (isConstant)
    return ScalarFunction({at(low)});
  return ScalarFunction({at(low), at(0.6 * low + 0.4 * high), at(high)});
}

/// Medium of segment `number`, from 1. Every third has a multiple of the volume's own extinction.
Component makeComponent(const Combination& c, std::size_t number, const TransferFunction& volume,
                        Generator& generator) {
  constexpr double anisotropies[] = {-0.4, 0.0, 0.5, 0.8};
  Component component{volume, uniform(generator, 0.0, 1.0) < 0.6};
  TransferFunction& transfer = component.transfer;
  transfer.albedo = makeColors(volume.extinction, generator);
  transfer.g = anisotropies[generator() % 4];
  if (number % 3 == 0) {
    transfer = transfer.withDensity(uniform(generator, 0.5, 2.0));
  } else {
    transfer.extinction = makeSegmentExtinction(volume.extinction, number % 3 == 1, generator);
    transfer.gradientOpacity.reset();
  }
  if (transfer.shading) {
    transfer.shading = SurfaceShading::makeCoated(uniform(generator, 0.0, 1.0),
                                                  uniform(generator, 0.05, 0.95), transfer.g);
    transfer.shading->gamma = volume.shading->gamma; // one for all components
    transfer.shading->diffuse = uniform(generator, 0.0, 1.0);
  }
  if (c.hasInterfaces && number % 2 == 1)
    component.interfaceWeight = uniform(generator, 0.2, 1.0);
  return component;
}

} // namespace

void placeSegments(const Combination& c, Generator& generator, MatrixScene& scene) {
  if (c.segmentCount == 0)
    return;
  Grid labels = makeCenteredGrid(Size3::Constant(17), Vec3(0.7, 0.6, 0.8));
  labels =
      Grid(labels.size, makeRotation(uniform(generator, 0.0, 6.0), randomDirection(generator)) *
                            labels.indexToWorld);
  const TransferFunction& volume = scene.fenestra.transfer;
  std::vector<LabelWeights::Part> parts;
  Tint tint{{}, {std::nullopt}};
  Mixture mixture{{}, {{volume}}};
  oracle::ComponentsDescription all{{}, {{volume}}, !c.hasSegmentMedia};
  for (const Ball& ball : makeBalls(c, generator)) {
    const std::size_t number = all.components.size();
    const Mask mask = makeBallMask(ball, labels, c.hasSoftSegments);
    parts.push_back({mask, ball.priority, static_cast<std::uint8_t>(number)});
    all.segments.push_back({mask, ball.priority, number});
    Component component{volume};
    if (number == 2) { // has the volume's own medium
      tint.albedo.emplace_back();
    } else if (c.hasSegmentMedia) {
      component = makeComponent(c, number, volume, generator);
    } else {
      component.transfer.albedo = makeColors(volume.extinction, generator);
      tint.albedo.emplace_back(component.transfer.albedo);
    }
    mixture.components.push_back(
        {component.transfer, component.isClipped, component.interfaceWeight});
    all.components.push_back(std::move(component));
  }
  const auto weights = std::make_shared<const LabelWeights>(makeLabelWeights(parts));
  tint.weights = mixture.weights = weights;
  if (c.hasSegmentMedia)
    scene.fenestra.mixture = std::move(mixture);
  else
    scene.fenestra.tint = std::move(tint);
  scene.components = std::move(all);
}

} // namespace fenestra::core::testing
