#pragma once
// Measures how a clipping surface meets the focus, on jittered rays, 4 x 4 to a pixel.
//
// The surface is queried for its depth on every ray; the depth of the focus there is found by the
// check's own code (FocusField.h, Views.h).
// - Unoccluded: a ray on the focus with depth of focus - depth of surface <= tolerance.
// - Gap: |depth of the focus's last point - depth of the surface just outside|, on the outline,
//   which is found by bisection between each ray that meets the focus and a neighbour that misses.
//   Where the surface stands farther in front just outside than just inside, there is a cliff up to
//   the context.
// - Depth jump: a difference > jumpDepth among the depths of the focus at the ray and the four
//   pixel centres around, or among the outline's depths in the parts of pixels around: where one
//   part of the focus ends before another, its outline has two depths. Shares are reported with and
//   without jumps.

#include "FocusField.h"
#include "Views.h"

#include <functional>

namespace fenestra::accuracy {

constexpr double jumpDepth = 2.0;       ///< mm
constexpr double wideGap = 0.2;         ///< mm
constexpr double strictTolerance = 0.2; ///< mm kept in front of an unoccluded focus, at most

struct Distances {
  double mean = 0.0, p95 = 0.0, max = 0.0; ///< mm
  double wideFraction = 0.0;               ///< share of points above wideGap
};

struct BoundaryMeasure {
  double outlinePoints = 0.0;
  double jumpFraction = 0.0; ///< share of the outline's points; left out of `gap` and `cut`
  Distances gap;             ///< |surface just outside - focus's last point|
  Distances cut;             ///< depth of the surface behind the focus's last point; 0 if in front
  double rays = 0.0;         ///< rays that meet the focus
  double strictFraction = 0.0; ///< share of rays unoccluded, to strictTolerance
  double halfVoxelFraction =
      0.0;                      ///< share unoccluded, to half of the labelmap's longest voxel edge
  double rayJumpFraction = 0.0; ///< share of rays at a depth jump
  double halfVoxelSmooth = 0.0; ///< halfVoxelFraction over the rays without a depth jump
  double centerGap = 0.0;       ///< greatest mm kept in front of the focus at a pixel centre
};

struct ImageMatch {
  double pixels = 0.0;   ///< pixels examined
  double fraction = 0.0; ///< share of these whose depth is within the surface's range there
};

/// Depth of a clipping surface, mm from the eye's plane, at a raster position.
using Surface = std::function<double(const Vec2&)>;

/// Focus as seen in a view, independent of any surface.
class FocusView {
public:
  FocusView(const FocusField& field, const View& view);

  BoundaryMeasure measure(const Surface& surface) const;

  /// Compares a picture of depths (renderDepths) with the surface that `measure` queries, on the
  /// context's pixels beside the focus.
  ImageMatch match(const std::vector<float>& depths, const Surface& surface) const;

private:
  struct Point {
    Vec2 raster;
    double depth;
  };
  /// Last point of the focus, and the raster position just outside.
  struct Edge {
    Point inner;
    Vec2 outer;
  };

  double focusDepth(const Vec2& raster) const;
  Vec2 rasterPosition(std::size_t ray) const;
  void traceRays();
  void traceOutline();
  Edge findEdge(std::size_t in, std::size_t out) const;
  bool isAtJump(const Point& point) const;
  bool isAtOutlineJump(const Point& point) const;
  std::size_t nearestRay(const Vec2& raster) const;

  const FocusField& m_field;
  View m_view;
  std::size_t m_across;          ///< rays in a row
  std::vector<double> m_centers; ///< depth of the focus at pixel centres; infinity: ray misses
  std::vector<double> m_rays;    ///< depth of the focus on the rays; infinity: ray misses
  std::vector<Edge> m_outline;
  struct DepthRange {
    double least, greatest;
  };
  std::vector<DepthRange> m_outlineDepths; ///< of the outline near each ray; least > greatest: none
};

} // namespace fenestra::accuracy
