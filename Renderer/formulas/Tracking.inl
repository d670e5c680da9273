// Rays through the volume: its box, its majorant cells, and transmittance. t is in mm.

/// Parts of rays, one per lane; t in mm.
struct LaneIntervals {
  Float begin, end;
};
/// Intersects with a slab. A ray that lies in a face counts as inside.
FORMULA LaneIntervals clipToSlab(LaneIntervals t, Real low, Real high, Float origin,
                                 Float direction) {
  const LaneMask isParallel = direction == 0.0F;
  const LaneMask isBackward = direction < 0.0F;
  const LaneMask inside = both(low <= origin, origin <= high);
  const Float near = (select(isBackward, high, low) - origin) / direction;
  const Float far = (select(isBackward, low, high) - origin) / direction;
  t.begin = max(t.begin, select(isParallel, select(inside, -infiniteReal, infiniteReal), near));
  t.end = min(t.end, select(isParallel, infiniteReal, far));
  return t;
}

/// One axis of a ray's traversal of majorant cells (3D-DDA), in units of a cell's edge. No cell
/// index is stored: a ray's cell follows from its position.
struct DdaAxis {
  Float start, speed; ///< cells, cells per mm
  Float inverse;      ///< 1 / speed; 0: the ray does not move along this axis
  Float toMiddle;     ///< t at the center of cell 0; infinity if the ray does not move
};
/// Axis of a ray in index space; insideCells: largest float below the number of cells.
FORMULA DdaAxis makeDdaAxis(Real cellsPerVoxel, Real insideCells, Float origin, Float direction) {
  DdaAxis axis;
  axis.speed = direction * cellsPerVoxel;
  // Clamped below the last face, so that a ray in that face starts inside the last cell.
  const Float inside = fma(origin, cellsPerVoxel, 0.5F * cellsPerVoxel);
  axis.start = max(min(inside, insideCells), 0.0F);
  const LaneMask isMoving = abs(axis.speed) >= 1e-30F;
  axis.inverse = zeroUnless(isMoving, 1.0F / axis.speed);
  axis.toMiddle = select(isMoving, (0.5F - axis.start) * axis.inverse, infiniteReal);
  return axis;
}
/// Position at t mm, in cells.
FORMULA Float positionAt(STRUCT(DdaAxis) axis, Float t) {
  return fma(axis.speed, t, axis.start);
}
/// t at which a ray has left all cells within `reach` edges of the center of cell `cell`. Rounding
/// errors are some last places of the largest t.
FORMULA Float exitDistance(STRUCT(DdaAxis) axis, Float cell, Float reach) {
  return fma(cell, axis.inverse, fma(reach, abs(axis.inverse), axis.toMiddle));
}

/// Ratio tracking (Novák et al. 2014): transmittance after a tentative collision.
FORMULA Float attenuate(Float ratio, Float extinction, Float majorant) {
  return ratio * clampZero(1.0F - extinction / majorant);
}
/// Transmittance below which Russian roulette applies, and what a ray has that survives it.
CONSTANT Real leastRatio = Real(0.4);
FORMULA Float playRatioRoulette(Float ratio, Float u) {
  return zeroUnless(u * leastRatio < ratio, leastRatio);
}
