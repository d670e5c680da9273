#pragma once
// Fill with an exact boundary: the surface leaves the focus with the depth and slope of the focus.
//
// Outside the focus the surface is the u that minimizes
//     ∫ (Δu)² + |∇u|² / length²,
// a plate under tension. It is smooth at the boundary of the focus, and level a few lengths away,
// where a thin plate spline would keep its slope. (Smith and Wessel 1990, "Gridding with continuous
// curvature splines in tension", without their interpolation error: the data are the boundary
// itself.) The boundary conditions are the depths of all samples of the focus and its halo
// (SilhouetteCells.h), and the slope across the boundary, limited to maxBoundarySlope, since the
// slope of a rounded silhouette is unbounded. Where the boundary's depth jumps, between components
// or where the focus occludes itself, u changes from one depth to the other within about a sample
// at the boundary, and more gradually away from it. Tension prevents ringing.
//
// Solved by multigrid, from coarse to fine. The coarsest level that resolves the bending, with
// samples a quarter to half of `length` apart, is solved directly. Each finer level is interpolated
// from the coarser one and relaxed near the boundary by Chebyshev iteration, with more steps on
// coarser levels. If a coarse sample lies across the boundary, its depth is the boundary
// extrapolated to its center, and only its part outside the focus bends. The method is linear in
// the samples. Compared with the closed-form solution along a straight edge, its error is at most 8
// % of slope * length at any resolution (Testing/Unit). The error affects only where the surface
// levels off; depth and slope at the boundary come from the finest level.

#include "clip/focus/FocusDepth.h"

namespace fenestra::core {

/// Largest slope of u across the boundary: mm of depth per mm on the plane through the target.
constexpr double maxBoundarySlope = 1.0;

/// Fills the samples of `buffer` outside the focus. At least one sample must be focus. `length`:
/// mm, over which the surface levels off.
void fillSmoothly(DepthBuffer& buffer, const std::vector<Region>& regions, double length);

} // namespace fenestra::core
