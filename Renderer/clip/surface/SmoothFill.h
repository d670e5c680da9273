#pragma once
// Exact boundary: a surface that leaves the focus with the focus's own depth and slope.
//
// Outside the focus the surface is the u that minimises
//     ∫ (Δu)² + |∇u|² / length²,
// a plate under tension: smooth at the focus's boundary, and level a few lengths away, where a thin
// plate spline would run on. (Smith and Wessel 1990, "Gridding with continuous curvature splines in
// tension", without their interpolation error: the data are the boundary itself.) Boundary values:
// the depth of every sample of the focus and its rim (Seams.h), and the slope across the boundary,
// limited to maxBoundarySlope, for the slope of a rounded silhouette is unbounded. Where the
// boundary's depth jumps, between components or where the focus hides a part of itself, u falls
// from one depth to the other within about a sample at the boundary and ever more gently away from
// the boundary; tension keeps u from ringing.
//
// Solved from coarse to fine. The coarsest samples that still see the plate bend, a quarter to half
// a length apart, are solved directly. Each finer level starts from the coarser surface and relaxes
// the detail near the boundary by Chebyshev's iteration, with more steps on coarser levels. A
// coarse sample may lie across the boundary: its data are the boundary continued to its centre, and
// only its part outside the focus is bent. The method is linear in the samples. Against the
// solution in closed form, along a straight edge, its error is at most 8 % of slope * length at any
// resolution (Testing/Unit). The error is in the distance at which the surface levels off: value
// and slope at the boundary come from the finest level.

#include "clip/focus/FocusDepth.h"

namespace fenestra {

/// Greatest slope of u across the boundary: mm of depth per mm on the plane through the target.
constexpr double maxBoundarySlope = 1.0;

/// Fills the samples of `buffer` that are not focus. At least one sample has to be focus. `length`:
/// distance of levelling, mm.
void fillSmoothly(DepthBuffer& buffer, const std::vector<Region>& regions, double length);

} // namespace fenestra
