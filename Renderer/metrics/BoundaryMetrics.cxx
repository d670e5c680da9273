#include "metrics/BoundaryMetrics.h"

#include "clip/focus/Contour.h"

#include <optional>

namespace fenestra::core {
namespace {

/// Camera of the clip; null for ClipNone.
const Camera* findCamera(const Clip& clip) {
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

/// Crossing of the outline, with two samples on each side.
struct OutlineEdge {
  Vec2 inside, outside; ///< last focus sample and first sample outside, mm
  double focusDepth,
      innerDepth;    ///< focus depths at `inside` and one sample further in, mm, or infinity
  double near, far;  ///< context depths at `outside` and one sample further out, mm
  bool hasDepthJump; ///< the focus depth jumps at `inside`
};

/// Depth, mm, at which the remaining volume begins on the ray through `position`, or infinity.
double findContextDepth(const Clip& clip, const Domain& volume, const Vec2& position) {
  const Camera& camera = *findCamera(clip);
  const Ray ray = camera.makePlaneRay(position);
  const Interval part =
      volume.clip(transformRay(volume.grid().worldToIndex, ray), intervalBehindSurface(clip, ray));
  return part.isEmpty() ? infinity : part.begin * camera.depthPerLength(ray);
}

double findFocusDepth(const FocusDepth& focus, std::int64_t column, std::int64_t row) {
  return focus.isFocus(column, row) ? focus.depth.at(focus.depth.sample(column, row)) : infinity;
}

bool hasDepthJump(const FocusDepth& focus, std::int64_t column, std::int64_t row) {
  const double own = findFocusDepth(focus, column, row);
  for (std::int64_t y = row - 1; y <= row + 1; ++y)
    for (std::int64_t x = column - 1; x <= column + 1; ++x)
      if (const double other = findFocusDepth(focus, x, y);
          other < infinity && std::abs(other - own) > depthJump)
        return true;
  return false;
}

/// Edge at a crossing; empty if there is no context outside.
std::optional<OutlineEdge> findEdge(const Crossing& crossing, const Clip& clip,
                                    const Domain& volume, const FocusDepth& focus) {
  const DepthBuffer& buffer = focus.depth;
  const std::int64_t column = crossing.column, row = crossing.row;
  const auto [x, y] = outwardStep(crossing);
  const std::int64_t farColumn = column + std::int64_t{2} * x, farRow = row + std::int64_t{2} * y;
  const bool isSample =
      farColumn >= 0 && farRow >= 0 && farColumn < buffer.columns() && farRow < buffer.rows();
  if (!isSample || focus.isFocus(farColumn, farRow))
    return std::nullopt;
  const Vec2 outside = buffer.position(column + x, row + y);
  const double near = findContextDepth(clip, volume, outside);
  const double far = findContextDepth(clip, volume, buffer.position(farColumn, farRow));
  if (!(near < infinity && far < infinity))
    return std::nullopt;
  return OutlineEdge{buffer.position(column, row),
                     outside,
                     findFocusDepth(focus, column, row),
                     findFocusDepth(focus, column - x, row - y),
                     near,
                     far,
                     hasDepthJump(focus, column, row)};
}

std::vector<OutlineEdge> findOutlineEdges(const Clip& clip, const Domain& volume,
                                          const FocusDepth& focus) {
  std::vector<OutlineEdge> edges;
  for (const Contour& contour : traceContours(focus))
    for (const Crossing& crossing : contour)
      if (const auto edge = findEdge(crossing, clip, volume, focus))
        edges.push_back(*edge);
  return edges;
}

/// Point on the outline of the focus.
struct OutlinePoint {
  double depth;        ///< of the focus just inside, mm
  Vec2 outside;        ///< just outside
  bool isSlot = false; ///< the focus continues in a closed slot (SilhouetteCells.h)
};

/// Bisects for the outline between `inside` and `outside`, to 2^-24 of their distance.
std::vector<OutlinePoint> findOutlinePoints(const FocusTracer& tracer,
                                            const std::vector<OutlineEdge>& edges) {
  std::vector<OutlinePoint> points;
  std::vector<Vec2> in, outside, middle(edges.size());
  for (const OutlineEdge& edge : edges) {
    in.push_back(edge.inside);
    outside.push_back(edge.outside);
    points.push_back({edge.focusDepth, edge.outside});
  }
  const std::vector<double> beyond = tracer.findDepths(outside);
  for (std::size_t i = 0; i < edges.size(); ++i)
    points[i].isSlot = beyond[i] < infinity;
  for (int step = 0; step < 24; ++step) {
    for (std::size_t i = 0; i < edges.size(); ++i)
      middle[i] = 0.5 * (in[i] + points[i].outside);
    const std::vector<double> depths = tracer.findDepths(middle);
    for (std::size_t i = 0; i < edges.size(); ++i)
      if (depths[i] < infinity) {
        in[i] = middle[i];
        points[i].depth = depths[i];
      } else {
        points[i].outside = middle[i];
      }
  }
  return points;
}

} // namespace

BoundaryMetrics measureBoundary(const Clip& clip, const Domain& volume, const Mask& focus,
                                const FocusDepth& depths) {
  BoundaryMetrics metrics;
  if (!findCamera(clip))
    return metrics;
  const std::vector<OutlineEdge> edges = findOutlineEdges(clip, volume, depths);
  const std::vector<OutlinePoint> points =
      findOutlinePoints(FocusTracer(*findCamera(clip), volume, focus), edges);
  std::vector<double> gaps, slopeJumps;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const OutlineEdge& edge = edges[i];
    ++metrics.crossings;
    // A steep slope of the focus just before the outline also counts as a jump.
    if (edge.hasDepthJump || points[i].isSlot ||
        std::abs(points[i].depth - edge.focusDepth) > depthJump)
      continue;
    const double context = findContextDepth(clip, volume, points[i].outside);
    if (hasSteps(clip))
      gaps.push_back(std::abs(2.0 * edge.near - edge.far - edge.focusDepth));
    else if (context < infinity)
      gaps.push_back(std::abs(context - points[i].depth));
    if (edge.innerDepth < infinity)
      slopeJumps.push_back(std::abs((edge.far - edge.near) - (edge.focusDepth - edge.innerDepth)) /
                           (edge.outside - edge.inside).norm());
  }
  if (metrics.crossings > 0)
    metrics.depthJumpFraction =
        1.0 - static_cast<double>(gaps.size()) / static_cast<double>(metrics.crossings);
  metrics.gap = Distribution::compute(std::move(gaps));
  metrics.slopeJump = Distribution::compute(std::move(slopeJumps));
  return metrics;
}

} // namespace fenestra::core
