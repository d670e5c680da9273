#pragma once
// Fill with an exact boundary: the surface leaves the focus with the depth and slope of the focus.
//
// It is the sum of two parts:
//
// - The far surface (FarSurface.h) is smooth and level a few lengths away from the focus. It is
//   fitted to the depths along the boundary, and has nearly the same shape at any image size: a
//   preview shows the context of the final image, and the surface moves little while the camera
//   turns.
//   (Smith and Wessel 1990, "Gridding with continuous curvature splines in tension", without their
//   interpolation error: the data are the boundary itself.)
// - The near surface v makes the boundary exact: it has there the remaining depth and slope.
//   Elsewhere it minimizes
//       ∫ (Δv)² + 2 |∇v|² / d² + v² / d⁴,   d = nearFraction * length,
//   so that it falls off as (1 + x / d) exp(-x / d) with the distance x.
//
// The boundary is that of the focus and its halo (clip/field/SilhouetteCells.h). The
// slope of the near surface across it is limited to maxNearSlope, since the slope of a rounded
// silhouette is unbounded. Where the boundary's depth jumps, between components or where the focus
// occludes itself, the surface changes from one depth to the other within about a sample at the
// boundary, and more gradually away from it.
//
// The near surface is solved by multigrid, from coarse to fine. Each finer level is interpolated
// from the coarser one and relaxed near the boundary by Chebyshev iteration. If a coarse sample
// lies across the boundary, its depth is the boundary extrapolated to its center, and only its part
// outside the focus bends.

#include "clip/portable/FarSurface.h"
#include "clip/portable/ParallelLoop.h"

#include <cstdint>
#include <vector>

namespace fenestra::core {

/// Largest slope of the near surface across the boundary: depth per mm on the plane through the
/// target.
constexpr double maxNearSlope = 1.0;

/// Reach of the near surface, as a fraction of the length.
constexpr double nearFraction = 0.25;

/// Length over which the surface levels off, mm, in a volume whose box has this diagonal, mm: it
/// keeps the surface inside the volume's depth range.
constexpr double levelingLength(double diagonal) {
  return 0.05 * diagonal;
}

/// Depths over a grid of samples.
struct FillGrid {
  std::vector<double> x, y;  ///< of the columns and rows, mm; in ascending or descending order
  std::vector<float> depths; ///< mm, row by row
  std::vector<std::uint8_t> isKnown; ///< 1: focus or halo, with its depth; 0: to be filled
};

/// Fills the samples that are not known. At least one must be. `far`: of the same grid, with
/// `length`; its halo may have other depths. `length`: mm, over which the surface levels off.
void fillSmoothly(FillGrid& grid, const FarSurface& far, double length, const ParallelLoop& loop);

} // namespace fenestra::core
