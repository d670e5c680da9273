#pragma once
// The simulated model of the clipping method's publication (its section 4): a cube whose scalar is
// its z index, around a cuboid focus.

#include "phantoms/Phantom.h"

namespace fenestra {

struct CubeOptions {
  double edge = 1.0;       ///< mm: the published model is a unit cube
  std::int64_t size = 512; ///< voxels along each edge
};

/// Voxel axes are R, A, S; the cube is centred at the origin. Slice k of n holds
/// 255 (2 k - (n - 1)) / (n - 1), rounded: -255 in the first slice, 255 in the last. Of 512 slices
/// the two in the middle hold 0 and all others one more than the slice below: the z index, counted
/// from the middle. The segment "focus" has 255 x 255 x 391 voxels of 512, its long edge along z,
/// and the same shares of other sizes, rounded; where n and they differ by an odd number it lies
/// half a voxel below the middle. Labels cover the focus alone. Throws Error (usage) where a size
/// is less than 16 or more than 1024, or the edge is not a positive number.
Phantom makeCubePhantom(const CubeOptions& options = {});

/// Opaque within a hundredth of the edge, blue at -255 through purple to red at 255; no shading,
/// for the only gradients are the cube's own slices. A .vp, which knows no unit distance, cannot
/// say so of an edge far below 100 mm: there Fenestra's cap on opacity leaves 9.2 per mm.
VolumeProperty cubeProperty(double edge);

} // namespace fenestra
