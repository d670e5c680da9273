#pragma once
// The exact boundary: a surface that leaves the focus with its own depth and slope.
//
// Over the samples that are not focus it is the u that minimises
//     ∫ (Δu)² + |∇u|² / length²,
// a plate under tension: smooth where the focus's boundary is, and level a few lengths away from
// it, where a thin plate spline runs on. (Smith and Wessel 1990, "Gridding with continuous
// curvature splines in tension", without their interpolation error: the data are the boundary
// itself.) Along the boundary u is the depth of every sample of the focus and its rim (Seams.h),
// and its slope across is theirs up to a limit, for the slope of a rounded silhouette has none.
// Where the boundary's depth jumps, between components or where the focus hides a part of itself, u
// falls from one depth to the other within about a sample at the boundary and ever more gently away
// from it; it does not ring, for tension takes what would swing.
//
// Solved from coarse to fine. The coarsest samples that still see the plate bend, a quarter to half
// a length apart, are solved directly; each finer level takes the coarser one's surface and relaxes
// near the boundary what that could not hold, by Chebyshev's iteration, the coarser, the longer. A
// coarse sample may lie across the boundary: its data are the boundary continued to its centre, and
// only the part of it that is not focus is bent. That is linear in the samples. Against the
// solution in closed form, along a straight edge, it is right to 8 % of slope * length at any
// resolution (Testing/Unit); what is left is in how far away the surface levels off, for value and
// slope at the boundary are of the finest level.

#include "clip/focus/FocusDepth.h"

namespace fenestra {

/// Depth per distance, both in mm on the plane through the target.
constexpr double steepestBoundary = 1.0;

/// Fills the samples of `buffer` that are not focus. At least one has to be focus.
void fillSmoothly(DepthBuffer& buffer, const std::vector<Region>& regions, double length);

} // namespace fenestra
