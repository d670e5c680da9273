#include "measure/BoundaryMeasures.h"

#include "clip/focus/Contour.h"

#include <algorithm>
#include <numeric>

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

/// Crossings of the outline that have context beyond.
class Outline {
public:
  Outline(const Clip& clip, const Domain& volume, const FocusDepth& focus)
      : m_clip(clip), m_volume(volume), m_focus(focus), m_camera(*cameraOf(clip)) {
    for (const Contour& contour : traceContours(focus))
      for (const Crossing& crossing : contour)
        add(crossing);
  }

  const std::vector<Edge>& edges() const { return m_edges; }

  /// Depth, mm, at which the remaining volume begins on the ray through (x, y); infinity: none.
  double contextAt(const Vec2& position) const {
    const Ray ray = m_camera.rayThrough(position);
    const Interval part =
        m_volume.clip(transformed(m_volume.grid().worldToIndex, ray), behindSurface(m_clip, ray));
    return part.empty() ? infinity : part.begin * m_camera.depthPerLength(ray);
  }

private:
  void add(const Crossing& crossing) {
    const SampleStep step = outward(crossing);
    const std::int64_t x = step.column, y = step.row;
    const std::int64_t column = crossing.column, row = crossing.row;
    const DepthBuffer& buffer = m_focus.depth;
    const auto isSample = [&](std::int64_t c, std::int64_t r) {
      return c >= 0 && r >= 0 && c < buffer.columns() && r < buffer.rows();
    };
    if (!isSample(column + 2 * x, row + 2 * y) || m_focus.isFocus(column + 2 * x, row + 2 * y))
      return;
    const Vec2 inside = buffer.position(column, row);
    const Vec2 outside = buffer.position(column + x, row + y);
    const double near = contextAt(outside);
    const double far = contextAt(buffer.position(column + 2 * x, row + 2 * y));
    if (near < infinity && far < infinity)
      m_edges.push_back({inside, outside, focusAt(column, row), focusAt(column - x, row - y), near,
                         far, jumps(column, row)});
  }

  double focusAt(std::int64_t column, std::int64_t row) const {
    return m_focus.isFocus(column, row) ? m_focus.depth.at(m_focus.depth.sample(column, row))
                                        : infinity;
  }

  bool jumps(std::int64_t column, std::int64_t row) const {
    const double own = focusAt(column, row);
    for (std::int64_t y = row - 1; y <= row + 1; ++y)
      for (std::int64_t x = column - 1; x <= column + 1; ++x)
        if (const double other = focusAt(x, y);
            other < infinity && std::abs(other - own) > depthJump)
          return true;
    return false;
  }

  const Clip& m_clip;
  const Domain& m_volume;
  const FocusDepth& m_focus;
  const Camera& m_camera;
  std::vector<Edge> m_edges;
};

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
  const Outline outline(clip, volume, depths);
  const std::vector<OutlinePoint> points =
      outlinePoints(FocusTracer(*cameraOf(clip), volume, focus), outline.edges());
  std::vector<double> gaps, slopeJumps;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Edge& edge = outline.edges()[i];
    ++measures.crossings;
    // A steep fall of the focus before its end is a jump as well.
    if (edge.jumps || std::abs(points[i].depth - edge.own) > depthJump)
      continue;
    const double context = outline.contextAt(points[i].beyond);
    if (hasSteps(clip))
      gaps.push_back(std::abs(2.0 * edge.near - edge.far - edge.own));
    else if (context < infinity)
      gaps.push_back(std::abs(context - points[i].depth));
    if (edge.inner < infinity)
      slopeJumps.push_back(std::abs((edge.far - edge.near) - (edge.own - edge.inner)) /
                           (edge.outside - edge.inside).norm());
  }
  if (measures.crossings > 0)
    measures.depthJumps =
        1.0 - static_cast<double>(gaps.size()) / static_cast<double>(measures.crossings);
  measures.gap = Distribution::of(std::move(gaps));
  measures.slopeJump = Distribution::of(std::move(slopeJumps));
  return measures;
}

} // namespace fenestra
