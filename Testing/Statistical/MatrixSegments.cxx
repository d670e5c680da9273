#include "MatrixSegments.h"

namespace fenestra::testing {
namespace {

struct Ball {
  Vec3 center; ///< labelmap's index space
  double radius;
  int priority;
};

/// Balls as the combination has them, in a labelmap of 17 voxels along each axis.
std::vector<Ball> balls(const Combination& c, Generator& generator) {
  const Vec3 middle = Vec3::Constant(8.0);
  std::vector<Ball> all;
  for (int i = 0; i < c.tints; ++i) {
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

/// Indicator of a ball, over its own extent.
Mask maskOf(const Ball& ball, const Grid& labels, bool isSoft) {
  const Size3 first = (ball.center.array() - ball.radius - 2.0).floor().cast<std::int64_t>();
  const Size3 end = (ball.center.array() + ball.radius + 3.0).ceil().cast<std::int64_t>();
  Affine map = labels.indexToWorld;
  map.translate(first.cast<double>());
  Mask mask;
  mask.grid = Grid(end - first, map);
  mask.full = isSoft ? 255 : 1;
  for (std::int64_t z = first.z(); z < end.z(); ++z)
    for (std::int64_t y = first.y(); y < end.y(); ++y)
      for (std::int64_t x = first.x(); x < end.x(); ++x) {
        const double inside = ball.radius - (Size3(x, y, z).cast<double>() - ball.center).norm();
        const double share = isSoft ? std::clamp(0.5 + inside / 2.0, 0.0, 1.0) : inside > 0.0;
        mask.voxels.push_back(static_cast<std::uint8_t>(share * mask.full));
      }
  return mask;
}

} // namespace

void tintSegments(const Combination& c, Generator& generator, MatrixScene& scene) {
  if (c.tints == 0)
    return;
  Grid labels = centredGrid(Size3::Constant(17), Vec3(0.7, 0.6, 0.8));
  labels = Grid(labels.size, rotationBy(uniform(generator, 0.0, 6.0), randomDirection(generator)) *
                                 labels.indexToWorld);
  const auto& knots = scene.product.transfer.extinction.knots();
  const double low = knots.front().position, high = knots.back().position;
  const auto color = [&] {
    const auto channel = [&] { return uniform(generator, 0.1, 0.95); };
    return Rgb(channel(), channel(), channel());
  };
  std::vector<Shares::Part> parts;
  oracle::TintDescription tint{{}, {std::nullopt}};
  for (const Ball& ball : balls(c, generator)) {
    const std::size_t component = tint.albedo.size();
    const Mask mask = maskOf(ball, labels, c.areSoft);
    parts.push_back({mask, ball.priority, static_cast<std::uint8_t>(component)});
    tint.segments.push_back({mask, ball.priority, component});
    if (component == 2) // of its own colour no more than what is in no segment
      tint.albedo.emplace_back();
    else
      tint.albedo.emplace_back(ColorFunction({{low, color()}, {high, color()}}));
  }
  scene.product.tint = Tint{std::make_shared<const Shares>(sharesOf(parts)), tint.albedo};
  scene.tint = std::move(tint);
}

} // namespace fenestra::testing
