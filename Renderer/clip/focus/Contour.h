#pragma once
// Outline of the focus region, and the control points on the outline.

#include "clip/focus/FocusDepth.h"

#include <cstdint>
#include <vector>

namespace fenestra {

/// Place where a contour passes between a focus sample and a neighbour outside the focus.
struct Crossing {
  std::int32_t column, row; ///< the focus sample
  std::uint8_t side; ///< of the neighbour: 0 next column, 1 next row, 2 last column, 3 last row

  bool operator==(const Crossing&) const = default;
};

/// Step from a sample to an adjacent one.
struct SampleStep {
  std::int32_t column, row;
};

/// Step toward the neighbour on a crossing's side.
SampleStep outwardStep(const Crossing& crossing);

/// Closed loop: each crossing is followed by its neighbour on the contour, the last by the first.
using Contour = std::vector<Crossing>;

/// All contours of the focus region, outer ones and holes, by marching squares on the samples.
/// Places beyond the buffer are not focus. Focus samples that touch only diagonally are joined.
std::vector<Contour> traceContours(const FocusDepth& focus);

/// Midpoint of the crossing's two samples, mm on the plane through the target.
Vec2 position(const DepthBuffer& buffer, const Crossing& crossing);

/// Focus sample on a contour: (x, y) in mm on the plane through the target, and its depth, mm.
struct ControlPoint {
  Vec2 site;
  double depth;
};

/// Focus samples at `count` crossings, spaced uniformly in arc length (mm) over the loops one after
/// the other. A sample of two of the crossings is returned once.
std::vector<ControlPoint> placeControlPoints(const FocusDepth& focus,
                                             const std::vector<Contour>& contours, int count);

/// All focus samples that a contour touches, each once.
std::vector<ControlPoint> findBoundarySamples(const FocusDepth& focus,
                                              const std::vector<Contour>& contours);

} // namespace fenestra
