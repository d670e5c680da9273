// The exact surface in silhouette cells (clip/field/SilhouetteCells.h): camera rays through the
// focus's cells (clip/focus/FocusCells.h), in float. `t` is the depth relative to the camera's
// target, mm.

/// Equal indicators, and equal depths, mm: above the rounding errors of float.
CONSTANT Real equalIndicator = Real(1e-6);
CONSTANT Real equalDepth = Real(1e-4);
/// Of FocusTraversal.cxx, FocusCells and SilhouetteCells.
CONSTANT Real ridgeTolerance = Real(1e-4);
CONSTANT Real replaceRatio = Real(0.015625);
CONSTANT Real captureThreshold = Real(0.25);
CONSTANT Real blendStart = Real(0.45);
CONSTANT Real rootRounding = Real(1e-7);

/// Direction of a camera ray per mm of depth, view space.
FORMULA Float3 viewDirection(Float x, Float y) {
  if (scene.clip.isPerspective != 0)
    return Float3(x / scene.clip.targetDepth, y / scene.clip.targetDepth, 1.0F);
  return Float3(0.0F, 0.0F, 1.0F);
}
/// A camera ray in the cell space of the focus.
struct FocusRay {
  Float3 origin, direction;
};
FORMULA FocusRay makeFocusRay(Float x, Float y) {
  FocusRay ray;
  ray.origin = mapPoint(scene.viewToCells, Float3(x, y, 0.0F));
  ray.direction = mapDirection(scene.viewToCells, viewDirection(x, y));
  return ray;
}
/// Part of a camera ray inside the domain, for a focus that is partly outside.
FORMULA LaneIntervals clipFocusRay(LaneIntervals t, Float x, Float y) {
  if (scene.isFocusInside != 0)
    return t;
  return clipToDomain(t, mapPoint(scene.viewToIndex, Float3(x, y, 0.0F)),
                      mapDirection(scene.viewToIndex, viewDirection(x, y)));
}

/// Traversal along one axis (FocusAxis-inl.h). Rays of negative direction are mirrored.
struct FocusAxis {
  Float origin, direction; ///< direction >= 0
  Float inverse;           ///< 1 / direction; infinity: no motion along this axis
  Float cell, face;        ///< current cell, and next face
  Float last;              ///< number of cells - 1, of complete blocks
  LaneMask isMirrored;
};
FORMULA FocusAxis makeFocusAxis(Float origin, Float direction, Float t, Int blocks) {
  FocusAxis axis;
  axis.last = toFloat(blocks * 4 - 1);
  axis.isMirrored = direction < 0.0F;
  axis.direction = abs(direction);
  axis.inverse = axis.direction > 0.0F ? 1.0F / axis.direction : infiniteReal;
  axis.origin = axis.isMirrored ? axis.last + 1.0F - origin : origin;
  axis.cell = max(min(floor(axis.origin + t * axis.direction), axis.last), 0.0F);
  axis.face = 0.0F;
  return axis;
}
FORMULA Int cellIndex(STRUCT(FocusAxis) axis) {
  return toInt(axis.isMirrored ? axis.last - axis.cell : axis.cell);
}
/// t of the next face: of the cell, or of the block if that is empty; infinity for the last face.
FORMULA Float findFace(INOUT(FocusAxis) axis, LaneMask isEmpty) {
  axis.face = isEmpty ? floor(axis.cell * 0.25F) * 4.0F + 4.0F : axis.cell + 1.0F;
  if (axis.face > axis.last || !(axis.inverse < infiniteReal))
    return infiniteReal;
  return (axis.face - axis.origin) * axis.inverse;
}
FORMULA void advanceAxis(INOUT(FocusAxis) axis, LaneMask crosses, Float t) {
  const Float here = floor(axis.origin + t * axis.direction);
  axis.cell = crosses ? axis.face : min(max(here, axis.cell), axis.face - 1.0F);
}
/// Position in the cell at t, 0 to 1, not mirrored.
FORMULA Float fractionAt(STRUCT(FocusAxis) axis, Float t) {
  const Float f = axis.origin + t * axis.direction - axis.cell;
  return axis.isMirrored ? 1.0F - f : f;
}

/// Indicator - 1/2 at a corner of a cell; `value`: byte of its lowest corner's value.
FORMULA Float loadCorner(Int corners, Int value, Int i) {
  if (scene.focusValues < 0)
    return (corners & (1 << i)) != 0 ? 0.5F : -0.5F;
  const Int at =
      value + (i & 1) + ((i >> 1) & 1) * brickVoxels + (i >> 2) * brickVoxels * brickVoxels;
  return fms(toFloat(loadByte(at)), scene.focusScale, 0.5F);
}
/// The cubic along a ray from (x, y, z) in a cell, which moves by (u, v, w) while s rises to 1.
FORMULA Cubic makeCubic(Int corners, Int value, Float3 at, Float3 move) {
  const Float v0 = loadCorner(corners, value, 0);
  const Float v1 = loadCorner(corners, value, 1);
  const Float v2 = loadCorner(corners, value, 2);
  const Float v3 = loadCorner(corners, value, 3);
  const Float v4 = loadCorner(corners, value, 4);
  const Float v5 = loadCorner(corners, value, 5);
  const Float v6 = loadCorner(corners, value, 6);
  const Float v7 = loadCorner(corners, value, 7);
  const Float bx = v1 - v0;
  const Float by = v2 - v0;
  const Float bz = v4 - v0;
  const Float cxy = v3 - v2 - bx;
  const Float cxz = v5 - v4 - bx;
  const Float cyz = v6 - v4 - by;
  const Float d = v7 - v6 - v5 + v4 - cxy;
  Cubic c;
  c.c0 = v0 + bx * at.x + by * at.y + bz * at.z + cxy * at.x * at.y + cxz * at.x * at.z +
         cyz * at.y * at.z + d * at.x * at.y * at.z;
  c.c1 = bx * move.x + by * move.y + bz * move.z + cxy * (at.x * move.y + at.y * move.x) +
         cxz * (at.x * move.z + at.z * move.x) + cyz * (at.y * move.z + at.z * move.y) +
         d * (at.x * at.y * move.z + at.x * move.y * at.z + move.x * at.y * at.z);
  c.c2 = cxy * move.x * move.y + cxz * move.x * move.z + cyz * move.y * move.z +
         d * (at.x * move.y * move.z + move.x * at.y * move.z + move.x * move.y * at.z);
  c.c3 = d * move.x * move.y * move.z;
  return c;
}

/// A cell of the focus.
struct FocusCell {
  Int block;   ///< 0: empty
  Int corners; ///< FocusCells::BlockCorners; 0: no corner above captureThreshold
  Int value;   ///< byte of the value at its lowest corner
};
FORMULA FocusCell findFocusCell(Int i, Int j, Int k) {
  FocusCell cell;
  cell.block = loadInt(scene.focusBlocks + (i >> 2) +
                       scene.focusBlocksX * ((j >> 2) + scene.focusBlocksY * (k >> 2)));
  const Int x = i & 3;
  const Int y = j & 3;
  const Int z = k & 3;
  cell.corners = 0;
  if (cell.block != 0)
    cell.corners = loadByte(scene.focusCorners * 4 + cell.block * 64 + x + 4 * (y + 4 * z));
  cell.value =
      scene.focusValues * 4 + cell.block * planeBytes + x + brickVoxels * (y + brickVoxels * z);
  return cell;
}

/// The ray maximum so far: indicator - 1/2, its t, and the t at which its ridge ends.
struct RayMaximum {
  Float height, t, ridgeEnd;
};
FORMULA void considerMaximum(INOUT(RayMaximum) best, INOUT(LaneMask) isOnRidge, Float height,
                             Float t) {
  LaneMask isNew = noLanes();
  if (isOnRidge)
    isNew = height > best.height + max(equalIndicator, min(ridgeTolerance, -height / replaceRatio));
  else if (best.t == -infiniteReal)
    isNew = height > best.height + equalIndicator;
  else
    isNew = height > replaceRatio * best.height;
  if (isNew) {
    best.height = height;
    best.t = t;
    isOnRidge = allLanes();
  }
  isOnRidge = isOnRidge && height >= best.height - ridgeTolerance;
  if (isOnRidge)
    best.ridgeEnd = t;
}
FORMULA void updateMaximum(INOUT(RayMaximum) best, STRUCT(Cubic) cubic, Float begin, Float length) {
  const TurningPoints turns = findTurningPoints(cubic); // monotonic in between
  LaneMask isOnRidge = begin - best.ridgeEnd < equalDepth;
  considerMaximum(best, isOnRidge, cubic.c0, begin);
  considerMaximum(best, isOnRidge, evalCubic(cubic, turns.first), begin + turns.first * length);
  considerMaximum(best, isOnRidge, evalCubic(cubic, turns.second), begin + turns.second * length);
  considerMaximum(best, isOnRidge, evalCubic(cubic, 1.0F), begin + length);
}

/// Hit of a ray, or its maximum: DepthHit (clip/focus/FocusDepth.h); indicator 0: neither.
struct FocusHit {
  Float t, indicator;
};
FORMULA FocusHit traceFocus(STRUCT(FocusRay) ray, LaneIntervals range, bool wantMaximum) {
  FocusHit hit;
  hit.t = infiniteReal;
  hit.indicator = 0.0F;
  range = clipToSlab(range, 0.0F, scene.focusCellsX, ray.origin.x, ray.direction.x);
  range = clipToSlab(range, 0.0F, scene.focusCellsY, ray.origin.y, ray.direction.y);
  range = clipToSlab(range, 0.0F, scene.focusCellsZ, ray.origin.z, ray.direction.z);
  if (!(range.begin < range.end))
    return hit;
  FocusAxis x = makeFocusAxis(ray.origin.x, ray.direction.x, range.begin, scene.focusBlocksX);
  FocusAxis y = makeFocusAxis(ray.origin.y, ray.direction.y, range.begin, scene.focusBlocksY);
  FocusAxis z = makeFocusAxis(ray.origin.z, ray.direction.z, range.begin, scene.focusBlocksZ);
  RayMaximum best;
  best.height = captureThreshold - 0.5F;
  best.t = -infiniteReal;
  best.ridgeEnd = -infiniteReal;
  Float t = range.begin;
  for (;;) { // each step leaves a cell along one axis, so it ends
    const FocusCell cell = findFocusCell(cellIndex(x), cellIndex(y), cellIndex(z));
    const Float toX = findFace(x, cell.block == 0);
    const Float toY = findFace(y, cell.block == 0);
    const Float toZ = findFace(z, cell.block == 0);
    const Float leave = min(min(toX, toY), toZ);
    const Float exit = min(range.end, max(t, leave));
    if (cell.corners != 0) {
      const Float length = exit - t;
      const Float3 at = Float3(fractionAt(x, t), fractionAt(y, t), fractionAt(z, t));
      const Cubic cubic = makeCubic(cell.corners, cell.value, at, length * ray.direction);
      const Float s = findFirstNonNegative(cubic, rootRounding);
      if (s < infiniteReal) {
        hit.t = t + s * length;
        hit.indicator = 0.5F;
        return hit;
      }
      if (wantMaximum)
        updateMaximum(best, cubic, t, length);
    }
    if (!(leave < range.end))
      break;
    const LaneMask throughX = toX == leave;
    const LaneMask throughY = !throughX && toY == leave;
    advanceAxis(x, throughX, exit);
    advanceAxis(y, throughY, exit);
    advanceAxis(z, !throughX && !throughY, exit);
    t = exit;
  }
  if (wantMaximum && best.height + 0.5F > captureThreshold) {
    hit.t = best.t;
    hit.indicator = best.height + 0.5F;
  }
  return hit;
}

/// True if the point at depth t of a ray lies inside the focus: its indicator is >= 1/2.
FORMULA bool isInFocus(STRUCT(FocusRay) ray, Float x, Float y, Float t) {
  LaneIntervals here;
  here.begin = t;
  here.end = t;
  here = clipFocusRay(here, x, y);
  const Float3 p = ray.origin + t * ray.direction;
  if (here.begin > t || here.end < t ||
      !(p.x >= 0.0F && p.y >= 0.0F && p.z >= 0.0F && p.x < scene.focusCellsX &&
        p.y < scene.focusCellsY && p.z < scene.focusCellsZ))
    return false;
  const Int i = toInt(p.x);
  const Int j = toInt(p.y);
  const Int k = toInt(p.z);
  const FocusCell cell = findFocusCell(i, j, k);
  if (cell.block == 0)
    return false;
  const Float3 at = Float3(p.x - toFloat(i), p.y - toFloat(j), p.z - toFloat(k));
  return makeCubic(cell.corners, cell.value, at, Float3(0.0F, 0.0F, 0.0F)).c0 >= 0.0F;
}

/// Depth of the surface at (x, y) in a silhouette cell (SilhouetteCells::evaluate). `depth`:
/// interpolated; nearLimit: if the surface is at or before this depth, any such depth is returned.
FORMULA Float querySilhouette(Int cell, Float x, Float y, Float depth, Float nearLimit) {
  const Int bounds = scene.silhouettes + cell * silhouetteWords;
  LaneIntervals range;
  range.begin = loadFloat(bounds) - scene.surfaceOffset;
  range.end = loadFloat(bounds + 1) - scene.surfaceOffset;
  const LaneMask isInner = loadInt(bounds + 2) != 0;
  const FocusRay ray = makeFocusRay(x, y);
  const Float near = nearLimit - scene.surfaceOffset;
  if ((isInner || near <= range.end) && isInFocus(ray, x, y, near))
    return loadFloat(bounds); // the hit is at or before nearLimit
  FocusHit hit;
  hit.t = infiniteReal;
  hit.indicator = 0.0F;
  LaneIntervals searched = range;
  // Inner cells are searched within their bounds first. In a loop: shaders copy each call.
  for (Int search = isInner ? 0 : 1; search < 2 && hit.indicator == 0.0F; ++search) {
    hit = traceFocus(ray, clipFocusRay(searched, x, y), search == 1);
    if (search == 0 && hit.indicator > 0.0F)
      return hit.t + scene.surfaceOffset;
    searched.end = infiniteReal;
  }
  if (!(hit.indicator > blendStart))
    return depth;
  const Float exact = min(hit.t, range.end) + scene.surfaceOffset;
  return depth + (hit.indicator - blendStart) / (0.5F - blendStart) * (exact - depth);
}
