#pragma once
// Outline of the focus region, and the control points on the outline.

#include "clip/focus/FocusDepth.h"

#include <cstdint>
#include <vector>

namespace fenestra::core {

/// Point where a contour passes between a focus sample and a neighbor outside the focus.
struct Crossing {
  std::int32_t column, row; ///< the focus sample
  std::uint8_t side; ///< neighbor: 0 next column, 1 next row, 2 previous column, 3 previous row

  bool operator==(const Crossing&) const = default;
};

/// Step from a sample to an adjacent one.
struct SampleStep {
  std::int32_t column, row;
};

/// Step from the focus sample to its neighbor outside.
SampleStep outwardStep(const Crossing& crossing);

/// Closed loop of successive crossings; the last is followed by the first.
using Contour = std::vector<Crossing>;

/// Traces all contours of the focus region, including holes, by marching squares on the samples.
/// Samples beyond the buffer count as outside. Diagonal neighbors count as connected.
std::vector<Contour> traceContours(const FocusDepth& focus);

/// Midpoint of the crossing's two samples, mm on the plane through the target.
Vec2 computeMidpoint(const DepthBuffer& buffer, const Crossing& crossing);

/// Focus sample on a contour: (x, y) in mm on the plane through the target, and its depth, mm.
struct ControlPoint {
  Vec2 site;
  double depth;
};

/// Chooses `count` crossings, spaced uniformly in arc length (mm) over the concatenated contours,
/// and returns their focus samples without duplicates.
std::vector<ControlPoint> placeControlPoints(const FocusDepth& focus,
                                             const std::vector<Contour>& contours, int count);

/// Returns all focus samples on the contours, without duplicates.
std::vector<ControlPoint> findBoundarySamples(const FocusDepth& focus,
                                              const std::vector<Contour>& contours);

} // namespace fenestra::core
