#pragma once
// Measures how well a clipping surface meets the focus, on 4 x 4 jittered rays per pixel.
//
// The surface is queried for its depth on every ray. The focus depth is computed by independent
// code (FocusField.h, Views.h).
// - Unoccluded: a ray on the focus with focus depth - surface depth <= tolerance.
// - Gap: |depth of the focus's last point - depth of the surface just outside|, on the outline. The
//   outline is found by bisection between each ray that hits the focus and a neighbor that misses.
//   If the surface is much closer to the camera just outside than just inside, the context rises
//   like a cliff.
// - Depth jump: a difference > jumpDepth among the focus depths at the ray and the four surrounding
//   pixel centers, or among the outline depths at the neighboring rays. There, one part of the
//   focus occludes another, so the outline has two depths. Fractions are reported with and without
//   jumps.
// - Slot: a strip of the focus at its outline that is occluded, although the focus beside it is
//   nearer and unoccluded. It must be narrower than the longest label voxel edge and 2 mm, and is
//   left out of all other measures.

#include "FocusField.h"
#include "Views.h"

#include <functional>

namespace fenestra::core::accuracy {

constexpr double jumpDepth = 2.0;       ///< mm
constexpr double wideGap = 0.2;         ///< mm
constexpr double strictTolerance = 0.2; ///< maximum mm in front of an unoccluded focus

struct Distances {
  double mean = 0.0, p95 = 0.0, max = 0.0; ///< mm
  double wideFraction = 0.0;               ///< fraction of points above wideGap
};

struct BoundaryMeasure {
  double outlinePoints = 0.0;
  double jumpFraction = 0.0; ///< fraction of the outline points; excluded from `gap` and `cut`
  Distances gap;             ///< |surface just outside - focus's last point|
  Distances cut;             ///< depth of the surface behind the focus's last point; 0 if in front
  double rays = 0.0;         ///< rays that hit the focus, outside slots
  double slotFraction = 0.0; ///< rays that hit it in slots, relative to `rays`
  double strictFraction = 0.0; ///< fraction of rays unoccluded within strictTolerance
  double halfVoxelFraction =
      0.0;                      ///< fraction unoccluded within half of the longest label voxel edge
  double rayJumpFraction = 0.0; ///< fraction of rays at a depth jump
  double halfVoxelSmooth = 0.0; ///< like halfVoxelFraction, over the rays without a depth jump
  double centerGap = 0.0;       ///< maximum mm in front of the focus at a pixel center
};

struct ImageMatch {
  double pixels = 0.0; ///< pixels examined
  double fraction =
      0.0; ///< fraction of them whose depth is within the surface's range in the pixel
};

/// Depth of a clipping surface, mm from the camera plane, at a raster position.
using Surface = std::function<double(const Vec2&)>;

/// The focus in a view, independent of any surface.
class FocusView {
public:
  FocusView(const FocusField& field, const View& view);

  BoundaryMeasure measure(const Surface& surface) const;

  /// Compares an image of depths (renderDepths) with the surface that `measure` queries, on context
  /// pixels next to the focus.
  ImageMatch match(const std::vector<float>& depths, const Surface& surface) const;

private:
  struct Point {
    Vec2 raster;
    double depth;
  };
  /// Last point of the focus, and a raster position just outside it.
  struct Edge {
    Point inner;
    Vec2 outer;
  };

  double focusDepth(const Vec2& raster) const;
  Vec2 rasterPosition(std::size_t ray) const;
  void traceRays();
  void traceOutline();
  Edge findEdge(std::size_t in, std::size_t out) const;
  bool isInSlot(const Point& point, const Surface& surface) const;
  bool isAtJump(const Point& point) const;
  bool isAtOutlineJump(const Point& point) const;
  std::size_t findNearestRay(const Vec2& raster) const;

  const FocusField& m_field;
  View m_view;
  std::size_t m_width;           ///< rays per row
  std::vector<double> m_centers; ///< focus depth at pixel centers; infinity: ray misses
  std::vector<double> m_rays;    ///< focus depth on the rays; infinity: ray misses
  std::vector<Edge> m_outline;
  struct DepthRange {
    double least, greatest;
  };
  std::vector<DepthRange> m_outlineDepths; ///< near each ray; least > greatest: no outline
};

} // namespace fenestra::core::accuracy
