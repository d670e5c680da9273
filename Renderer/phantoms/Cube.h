#pragma once
// Simulated model of the clipping method's publication (its section 4): a cube whose scalar is its
// z index, around a cuboid focus.

#include "phantoms/Phantom.h"

namespace fenestra {

struct CubeOptions {
  double edge = 1.0;       ///< mm; the published model is a unit cube
  std::int64_t size = 512; ///< voxels along each edge
};

/// Voxel axes are R, A, S; the cube is centred at the origin. Slice k of n holds
/// 255 (2 k - (n - 1)) / (n - 1), rounded: -255 in the first slice, 255 in the last. Of 512 slices
/// the middle two hold 0 and each other slice one more than the slice below: the z index, counted
/// from the middle. The segment "focus" has 255 x 255 x 391 voxels of 512, its long edge along z;
/// of other sizes the same shares, rounded. Along an axis where n and the focus differ by an odd
/// number, the focus lies half a voxel below the middle. Labels cover the focus only. Throws Error
/// (usage) unless 16 <= size <= 1024 and edge > 0.
Phantom makeCubePhantom(const CubeOptions& options = {});

/// Opaque within edge / 100, blue at -255 through purple to red at 255; no shading, since the only
/// gradients are between the cube's slices. A .vp has no unit distance and cannot express this for
/// an edge far below 100 mm: there Fenestra's cap on opacity leaves 9.2 per mm.
VolumeProperty cubeProperty(double edge);

} // namespace fenestra
