#pragma once
// The outline of the focus region, and the control points on it.

#include "clip/focus/FocusDepth.h"

#include <cstdint>
#include <vector>

namespace fenestra {

/// Where a contour passes between a focus sample and a neighbour outside the focus.
struct Crossing {
  std::int32_t column, row; ///< the focus sample
  std::uint8_t side; ///< of the neighbour: 0 next column, 1 next row, 2 last column, 3 last row

  bool operator==(const Crossing&) const = default;
};

/// From a sample to one beside it.
struct SampleStep {
  std::int32_t column, row;
};

/// Toward the neighbour on a crossing's side.
SampleStep outward(const Crossing& crossing);

/// A closed loop: each crossing is followed by its neighbour on the contour, the last by the first.
using Contour = std::vector<Crossing>;

/// All contours of the focus region, outer ones and holes, by marching squares on the samples. What
/// lies beyond the buffer is not focus. Focus samples that touch only diagonally are joined.
std::vector<Contour> traceContours(const FocusDepth& focus);

/// The middle between the crossing's samples, mm on the plane through the target.
Vec2 position(const DepthBuffer& buffer, const Crossing& crossing);

/// A focus sample on the contour: (x, y) in mm on the plane through the target, and its own depth.
struct ControlPoint {
  Vec2 site;
  double depth;
};

/// The focus samples at `count` crossings, spaced uniformly in arc length (mm) over the loops one
/// after the other; a sample that is met twice counts once.
std::vector<ControlPoint> placeControlPoints(const FocusDepth& focus,
                                             const std::vector<Contour>& contours, int count);

/// All focus samples that a contour touches, each once.
std::vector<ControlPoint> boundarySamples(const FocusDepth& focus,
                                          const std::vector<Contour>& contours);

} // namespace fenestra
