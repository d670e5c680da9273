#pragma once
// How a clipping surface meets the focus: on jittered rays, four by four to a pixel.
//
// The surface is asked for its depth wherever a ray goes; what the focus is there, the check finds
// by itself (FocusField.h, Views.h).
// - A ray on the focus is unoccluded where nothing, to a tolerance, is kept in front of it: where
//   the surface is not nearer to the eye than the focus.
// - The gap is measured on the outline, found between each ray that meets the focus and a neighbour
//   that does not, by bisection: how far the surface just outside stands in front of, or behind,
//   the focus's last point. Where it stands in front by more than it does just inside there is a
//   cliff up to the context.
// - A depth jump is a difference of over 2 mm among the focus's depths at the four pixel centres
//   around and at the ray itself, or among the outline's own in the parts of pixels around: where
//   one part of the focus ends before another, its outline has two depths. Shares with and without
//   are told.

#include "FocusField.h"
#include "Views.h"

#include <functional>

namespace fenestra::accuracy {

constexpr double jumpDepth = 2.0;       ///< mm
constexpr double wideGap = 0.2;         ///< mm
constexpr double strictTolerance = 0.2; ///< mm of what may be kept in front of an unoccluded focus

struct Distances {
  double mean = 0.0, p95 = 0.0, max = 0.0; ///< mm
  double wide = 0.0;                       ///< share over wideGap
};

struct BoundaryMeasure {
  double outlinePoints = 0.0;
  double jumpShare = 0.0; ///< of the outline's points, left out of `gap` and `cut`
  Distances gap;          ///< of the surface just outside, either way
  Distances cut;          ///< of the focus's last point in front of the surface
  double rays = 0.0;      ///< on the focus
  double strict = 0.0;    ///< share unoccluded, to strictTolerance
  double halfVoxel = 0.0; ///< to half of the labelmap's longest voxel edge, as it knows no better
  double rayJumpShare = 0.0;    ///< of the rays
  double halfVoxelSmooth = 0.0; ///< as halfVoxel, of rays without a depth jump
  double centreGap = 0.0; ///< mm, at most, of the surface in front of the focus at pixel centres
};

struct PictureMatch {
  double pixels = 0.0; ///< looked at
  double share = 0.0;  ///< of them whose depth is one that the surface has within them
};

/// Depth of a clipping surface, mm from the eye's plane, at a raster position.
using Surface = std::function<double(const Vec2&)>;

/// What is known of a view before any surface is.
class FocusView {
public:
  FocusView(const FocusField& field, const View& view);

  BoundaryMeasure measure(const Surface& surface) const;

  /// Whether a picture of depths, as depthsInPicture makes it, shows the surface that `measure`
  /// asks: on the context's pixels beside the focus.
  PictureMatch match(const std::vector<float>& depths, const Surface& surface) const;

private:
  struct Point {
    Vec2 raster;
    double depth;
  };
  /// The last of the focus, and just outside.
  struct Edge {
    Point inner;
    Vec2 outer;
  };

  double depthThrough(const Vec2& raster) const;
  Vec2 rayAt(std::size_t ray) const;
  void traceRays();
  void traceOutline();
  Edge edgeBetween(std::size_t in, std::size_t out) const;
  bool isAtJump(const Point& point) const;
  bool isAtOutlineJump(const Point& point) const;
  std::size_t rayNear(const Vec2& raster) const;

  const FocusField& m_field;
  View m_view;
  std::size_t m_across;          ///< rays in a row
  std::vector<double> m_centres; ///< depth of the focus at pixel centres, infinite where it is not
  std::vector<double> m_rays;    ///< the same of the rays
  std::vector<Edge> m_outline;
  struct DepthRange {
    double least, greatest;
  };
  std::vector<DepthRange> m_outlineDepths; ///< in each ray's part of a pixel
};

} // namespace fenestra::accuracy
