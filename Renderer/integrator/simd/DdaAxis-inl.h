// Traversal of majorant cells, axis by axis (3D-DDA). No cell index is stored: a ray's cell follows
// from its position.

/// One axis of a ray's traversal, in units of a cell's edge.
struct DdaAxis {
  Float start, speed; ///< cells, cells per mm
  Float inverse;      ///< 1 / speed; 0: the ray does not move along this axis
  Float toMiddle;     ///< t at the center of cell 0; infinity if the ray does not move

  HWY_INLINE Float at(Float t) const { return fma(speed, t, start); }
  /// t at which a ray has left all cells within `half` edges of the center of cell `cell`. Rounding
  /// errors are some last places of the largest t.
  HWY_INLINE Float exitDistance(Float cell, Float half) const {
    return fma(cell, inverse, fma(half, abs(inverse), toMiddle));
  }

  /// Axis of a ray given in index space.
  static HWY_INLINE DdaAxis fromRay(const SimdMedium::Axis& axis, Float origin, Float direction) {
    DdaAxis result;
    result.speed = direction * axis.cellsPerVoxel;
    // Clamped below the last face, so that a ray in that face starts inside the last cell.
    const Float inside = fma(origin, axis.cellsPerVoxel, 0.5F * axis.cellsPerVoxel);
    result.start = max(min(inside, axis.insideCells), 0.0F);
    const LaneMask isMoving = abs(result.speed) >= 1e-30F;
    result.inverse = zeroUnless(isMoving, 1.0F / result.speed);
    result.toMiddle = select(isMoving, (0.5F - result.start) * result.inverse,
                             std::numeric_limits<float>::infinity());
    return result;
  }

  HWY_INLINE void setIf(LaneMask which, const DdaAxis& other) {
    start.setIf(which, other.start);
    speed.setIf(which, other.speed);
    inverse.setIf(which, other.inverse);
    toMiddle.setIf(which, other.toMiddle);
  }
};

/// t at which rays leave their cell and all cells within its skip radius. `cell` receives the cell.
HWY_INLINE Float findCellExit(const SimdMedium& scene, const DdaAxis (&axes)[3], Float t,
                              LaneCells& cell) {
  const Float x = floor(axes[0].at(t));
  const Float y = floor(axes[1].at(t));
  const Float z = floor(axes[2].at(t));
  cell = loadCells(scene, x, y, z);
  const Float half = cell.skipRadius + 0.5F;
  return min(min(axes[0].exitDistance(x, half), axes[1].exitDistance(y, half)),
             axes[2].exitDistance(z, half));
}
