#include "measure/BoundaryMeasures.h"

#include "clip/focus/Contour.h"

#include <optional>

namespace fenestra {
namespace {

/// Camera of the clip; null for ClipNone.
const Camera* cameraOf(const Clip& clip) {
  if (const auto* plane = std::get_if<ClipPlane>(&clip))
    return &plane->camera;
  if (const auto* depth = std::get_if<ClipDepth>(&clip))
    return &depth->camera;
  return nullptr;
}

bool hasSteps(const Clip& clip) {
  const auto* depth = std::get_if<ClipDepth>(&clip);
  return depth && depth->lookup == ClipDepth::Lookup::nearest;
}

/// Crossing of the outline: two samples on the inner side, two beyond.
struct Edge {
  Vec2 inside, outside; ///< last focus sample and first beyond, mm
  double own, inner;    ///< focus depths at `inside` and one sample before, mm; infinity: no focus
  double near, far;     ///< context depths at `outside` and one sample further, mm
  bool jumps;           ///< true: the focus's depth jumps at `inside`
};

/// Depth, mm, at which the remaining volume begins on the ray through `position`; infinity: none.
double contextAt(const Clip& clip, const Domain& volume, const Vec2& position) {
  const Camera& camera = *cameraOf(clip);
  const Ray ray = camera.rayThrough(position);
  const Interval part =
      volume.clip(transformRay(volume.grid().worldToIndex, ray), behindSurface(clip, ray));
  return part.isEmpty() ? infinity : part.begin * camera.depthPerLength(ray);
}

double focusAt(const FocusDepth& focus, std::int64_t column, std::int64_t row) {
  return focus.isFocus(column, row) ? focus.depth.at(focus.depth.sample(column, row)) : infinity;
}

bool jumps(const FocusDepth& focus, std::int64_t column, std::int64_t row) {
  const double own = focusAt(focus, column, row);
  for (std::int64_t y = row - 1; y <= row + 1; ++y)
    for (std::int64_t x = column - 1; x <= column + 1; ++x)
      if (const double other = focusAt(focus, x, y);
          other < infinity && std::abs(other - own) > depthJump)
        return true;
  return false;
}

/// Edge at a crossing; nothing: no context beyond.
std::optional<Edge> edgeAt(const Crossing& crossing, const Clip& clip, const Domain& volume,
                           const FocusDepth& focus) {
  const DepthBuffer& buffer = focus.depth;
  const std::int64_t column = crossing.column, row = crossing.row;
  const auto [x, y] = outward(crossing);
  const std::int64_t farColumn = column + std::int64_t{2} * x, farRow = row + std::int64_t{2} * y;
  const bool isSample =
      farColumn >= 0 && farRow >= 0 && farColumn < buffer.columns() && farRow < buffer.rows();
  if (!isSample || focus.isFocus(farColumn, farRow))
    return std::nullopt;
  const Vec2 outside = buffer.position(column + x, row + y);
  const double near = contextAt(clip, volume, outside);
  const double far = contextAt(clip, volume, buffer.position(farColumn, farRow));
  if (!(near < infinity && far < infinity))
    return std::nullopt;
  return Edge{buffer.position(column, row),
              outside,
              focusAt(focus, column, row),
              focusAt(focus, column - x, row - y),
              near,
              far,
              jumps(focus, column, row)};
}

std::vector<Edge> outlineEdges(const Clip& clip, const Domain& volume, const FocusDepth& focus) {
  std::vector<Edge> edges;
  for (const Contour& contour : traceContours(focus))
    for (const Crossing& crossing : contour)
      if (const auto edge = edgeAt(crossing, clip, volume, focus))
        edges.push_back(*edge);
  return edges;
}

/// Point at which the focus ends.
struct OutlinePoint {
  double depth; ///< of the focus just inside, mm
  Vec2 beyond;  ///< just outside
};

/// Outline points between `inside` and `outside`, to 2^-24 of the distance.
std::vector<OutlinePoint> outlinePoints(const FocusTracer& tracer, const std::vector<Edge>& edges) {
  std::vector<OutlinePoint> points;
  std::vector<Vec2> in, middle(edges.size());
  for (const Edge& edge : edges) {
    in.push_back(edge.inside);
    points.push_back({edge.own, edge.outside});
  }
  for (int halving = 0; halving < 24; ++halving) {
    for (std::size_t i = 0; i < edges.size(); ++i)
      middle[i] = 0.5 * (in[i] + points[i].beyond);
    const std::vector<double> depths = tracer.depthsAt(middle);
    for (std::size_t i = 0; i < edges.size(); ++i)
      if (depths[i] < infinity) {
        in[i] = middle[i];
        points[i].depth = depths[i];
      } else {
        points[i].beyond = middle[i];
      }
  }
  return points;
}

} // namespace

BoundaryMeasures measureBoundary(const Clip& clip, const Domain& volume, const Mask& focus,
                                 const FocusDepth& depths) {
  BoundaryMeasures measures;
  if (!cameraOf(clip))
    return measures;
  const std::vector<Edge> edges = outlineEdges(clip, volume, depths);
  const std::vector<OutlinePoint> points =
      outlinePoints(FocusTracer(*cameraOf(clip), volume, focus), edges);
  std::vector<double> gaps, slopeJumps;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Edge& edge = edges[i];
    ++measures.crossings;
    // A steep fall of the focus before its end is a jump as well.
    if (edge.jumps || std::abs(points[i].depth - edge.own) > depthJump)
      continue;
    const double context = contextAt(clip, volume, points[i].beyond);
    if (hasSteps(clip))
      gaps.push_back(std::abs(2.0 * edge.near - edge.far - edge.own));
    else if (context < infinity)
      gaps.push_back(std::abs(context - points[i].depth));
    if (edge.inner < infinity)
      slopeJumps.push_back(std::abs((edge.far - edge.near) - (edge.own - edge.inner)) /
                           (edge.outside - edge.inside).norm());
  }
  if (measures.crossings > 0)
    measures.depthJumpFraction =
        1.0 - static_cast<double>(gaps.size()) / static_cast<double>(measures.crossings);
  measures.gap = Distribution::compute(std::move(gaps));
  measures.slopeJump = Distribution::compute(std::move(slopeJumps));
  return measures;
}

} // namespace fenestra
